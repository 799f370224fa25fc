"""Rendering."""

import hashlib
import subprocess

import numpy as np
import pytest

import lobe_bsdf


@pytest.fixture(scope="module")
def scene(fixtures, tmp_path_factory):
    """A small version of a scene, next to the files that it refers to."""
    text = (fixtures / "scenes" / "cloth-metal-paint.toml").read_text()
    for key, value in (("width", 96), ("height", 54), ("samples", 4)):
        lines = [f"{key} = {value}" if line.startswith(f"{key} = ") else line for line in text.splitlines()]
        text = "\n".join(lines)
    folder = tmp_path_factory.mktemp("scene")
    for name in ("scenes", *(file.name for file in fixtures.glob("*.ddr"))):
        (folder / name).symlink_to(fixtures / name)
    (folder / "small").mkdir()
    for file in (fixtures / "scenes").iterdir():
        (folder / "small" / file.name).symlink_to(file)
    (folder / "small" / "small.toml").write_text(text)
    return folder / "small" / "small.toml"


PLAIN = """
[camera]
position = [0, 1.2, 4]
target = [0, 0.5, 0]
[film]
width = 96
height = 54
[integrator]
samples = 4
[material.grey]
model = "lambert"
albedo = 0.5
[[object]]
shape = "sphere"
material = "grey"
[[light]]
kind = "environment"
radiance = 1
"""


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """A scene that is read at once."""
    file = tmp_path_factory.mktemp("plain") / "plain.toml"
    file.write_text(PLAIN)
    return file


@pytest.fixture(scope="module")
def picture(scene):
    return lobe_bsdf.render(scene)


def test_pictures_are_arrays(picture):
    assert picture.size == (96, 54) and picture.window == (0, 0, 96, 54) and picture.is_finished
    assert picture.color.shape == picture.albedo.shape == picture.normal.shape == (54, 96, 3)
    assert picture.depth.shape == picture.material.shape == picture.samples.shape == (54, 96)
    assert picture.color.dtype == np.float32 and (picture.samples == 4).all()
    assert np.isfinite(picture.color).all() and picture.color.mean() > 0
    # The upper row comes first: more is visible further down.
    assert np.isfinite(picture.depth[-1]).mean() >= np.isfinite(picture.depth[0]).mean()


def test_files_equal_those_of_the_program(picture, scene, program, tmp_path):
    picture.save(tmp_path / "here.exr")
    picture.save(tmp_path / "here.png")
    for name in ("there.exr", "there.png"):
        subprocess.run([program, "render", scene, "-o", tmp_path / name, "--quiet"], check=True)
    sums = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in tmp_path.iterdir()}
    assert sums["here.exr"] == sums["there.exr"] and sums["here.png"] == sums["there.png"]


def test_parts_are_merged_to_the_same_bits(picture, scene, tmp_path):
    for part in (1, 2, 3):
        lobe_bsdf.render(scene, tile=(part, 3), threads=1).save(tmp_path / f"{part}.exr", partial=True)
    parts = [tmp_path / f"{part}.exr" for part in (1, 2, 3)]
    merged = lobe_bsdf.merge(parts)
    assert merged.color.tobytes() == picture.color.tobytes()
    assert lobe_bsdf.finished_parts(parts, scene) == [True] * 3
    assert lobe_bsdf.finished_parts([parts[1], parts[1], tmp_path / "none.exr"], scene) == [False, True, False]
    assert lobe_bsdf.finished_parts(parts, scene, samples=5) == [False] * 3
    assert lobe_bsdf.finished_parts(parts[:2], scene) == [False] * 2
    begun = lobe_bsdf.render(scene, tile=(1, 3), samples=5000, threads=1, progress=lambda done, total: False)
    begun.save(tmp_path / "begun.exr", partial=True)
    assert lobe_bsdf.finished_parts([tmp_path / "begun.exr", *parts[1:]], scene, samples=5000)[0] is False
    with pytest.raises(ValueError, match="these are missing: samples 0..4 of rows 18..36"):
        lobe_bsdf.merge([parts[0], parts[2]])
    with pytest.raises(ValueError, match="expected every sample once"):
        lobe_bsdf.merge([*parts, parts[0]])
    assert (lobe_bsdf.merge([parts[0], parts[2]], allow_gaps=True).samples[20] == 0).all()


def test_progress_can_end_a_rendering(plain):
    seen = []

    def progress(done, total):
        seen.append((done, total))
        return len(seen) < 2

    picture = lobe_bsdf.render(plain, samples=5000, threads=1, progress=progress)
    assert not picture.is_finished and len(seen) >= 2 and seen[-1][1] == 96 * 54 * 5000


def test_exceptions_of_progress_are_raised(plain):
    class Enough(Exception):
        pass

    def progress(done, total):
        raise Enough

    with pytest.raises(Enough):
        lobe_bsdf.render(plain, samples=5000, progress=progress)


def test_crops_and_ranges(picture, scene):
    crop = lobe_bsdf.render(scene, crop=(10, 20, 40, 30))
    assert crop.color.tobytes() == picture.color[20:30, 10:40].tobytes()
    assert (lobe_bsdf.render(scene, samples_range=(1, 3)).samples == 2).all()


@pytest.mark.parametrize(
    "options",
    [
        {"tile": (4, 3)},
        {"tile": (1, 55)},
        {"crop": (0, 0, 97, 1)},
        {"crop": (5, 5, 5, 6)},
        {"samples": 0},
        {"samples_range": (3, 3)},
        {"samples": 2, "samples_range": (0, 3)},
        {"tile": (1, 2), "crop": (0, 0, 1, 1)},
        {"integrator": "magic"},
        {"time": -1.0},
        {"threads": 0},
    ],
)
def test_options_are_checked(plain, options):
    with pytest.raises(ValueError, match="found|seconds"):
        lobe_bsdf.render(plain, **options)


def test_mistakes_in_scenes_are_named(scene, tmp_path):
    with pytest.raises(FileNotFoundError):
        lobe_bsdf.render(tmp_path / "none.toml")
    file = tmp_path / "wrong.toml"
    file.write_text("[camera]\nheigth = 3\n")
    with pytest.raises(lobe_bsdf.SceneError) as caught:
        lobe_bsdf.render(file)
    assert caught.value.file == str(file) and caught.value.line >= 1


def test_names_of_pictures_are_checked(picture, tmp_path):
    for name, options in (("a.jpg", {}), ("a.png", {"partial": True}), ("a.exr", {"exposure": 1.0})):
        with pytest.raises(ValueError, match="expected"):
            picture.save(tmp_path / name, **options)
    with pytest.raises((OSError, ValueError)):
        picture.save(tmp_path / "none" / "a.exr")
