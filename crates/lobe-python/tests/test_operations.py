"""Albedo, checks, comparison, resampling and saving."""

import numpy as np
import pytest
from conftest import REPOSITORY, directions

import lobe_bsdf

FIXTURES = REPOSITORY / "fixtures"


def test_albedo_shapes_and_limits(conductor):
    assert conductor.albedo(0.3).shape == (3,)
    assert conductor.albedo([[0.1], [0.2]], [0.0, 1.0, 2.0]).shape == (2, 3, 3)
    values, errors = conductor.albedo([0.1, 0.2], errors=True)
    assert values.shape == (2, 3) and errors.shape == (2,) and (values > 0).all() and (errors < 1e-3).all()
    for bad in (-0.1, np.pi / 2, np.nan):
        with pytest.raises(ValueError, match="light at"):
            conductor.albedo(bad)
    with pytest.raises(ValueError, match="tolerance"):
        conductor.albedo(0.1, tolerance=0)
    with pytest.raises(ValueError, match="found reflection front; expected the requested scatter"):
        conductor.albedo(0.1, scatter="transmission")


def test_incidences_equal_those_of_the_table(conductor):
    sigma = conductor.arrays()["sigma"]
    np.testing.assert_allclose(conductor.incidences()[:, 0], sigma[sigma < 1.56])


def test_checks(cloth):
    findings = cloth.check()
    assert findings and {finding.status for finding in findings} <= {"pass", "note", "warn", "fail"}
    assert any("energy" in finding.check or "albedo" in finding.text for finding in findings)
    assert all(isinstance(finding.numbers, dict) for finding in findings)


def test_comparison(conductor, fixtures):
    same = conductor.compare(conductor, pairs=2000)
    assert same.max == same.rms == same.bias == 0 and same.delta_e == 0 and same.aspect == "reflection front"
    brighter = conductor.arrays()
    brighter["values"] = brighter["values"] * np.float32(1.1)
    other = conductor.compare(lobe_bsdf.from_samples(**brighter), pairs=2000)
    assert other.relative_rms == pytest.approx(0.1, rel=1e-3) and other.bias > 0 and other.delta_e > 0
    with pytest.raises(ValueError, match="limit"):
        conductor.compare(conductor, limit=2.0)


def test_resampling(conductor):
    coarse = conductor.resample(
        sigma=np.radians([0, 30, 60, 80]), psi=[0.0], theta=np.radians([0, 5, 20, 90, 180]), phi=np.radians([0, 180, 360])
    )
    assert coarse.kind == "specular table" and coarse.arrays()["values"].shape == (4, 1, 5, 3, 3)
    assert coarse.resampling.max > 0 and coarse.resampling.probes > 1000
    assert coarse.compare(conductor).max == pytest.approx(coarse.resampling.max, rel=1)
    with pytest.raises(ValueError, match="smallest one reached"):
        conductor.resample(1e-6, theta=[0.0, 1.0, 3.0])
    with pytest.raises(ValueError, match="error"):
        conductor.resample(-1.0)


@pytest.mark.parametrize("name", ["copy.ddr", "copy.ssdd"])
def test_saved_values_are_the_same(conductor, tmp_path, name):
    conductor.save(tmp_path / name)
    wi, wo = directions(300, 1), directions(300, 2)
    assert lobe_bsdf.open(tmp_path / name).eval(wi, wo).tobytes() == conductor.eval(wi, wo).tobytes()


def test_saved_arrays_equal_those_of_numpy(conductor, tmp_path):
    conductor.save(tmp_path / "table.npz")
    saved, arrays = np.load(tmp_path / "table.npz"), conductor.arrays()
    for name in ("sigma", "psi", "theta", "phi", "values"):
        np.testing.assert_array_equal(saved[name], arrays[name])


def test_materials_are_resampled_for_other_formats(conductor, tmp_path):
    file = tmp_path / "gold.binary"
    with pytest.raises(ValueError, match="expected resample=True"):
        conductor.save(file, "merl")
    assert not file.exists()
    conductor.save(file, "merl", resample=True)
    merl = lobe_bsdf.open(file, lookup="linear")
    assert merl.format == "MERL"
    assert merl.compare(conductor, limit=1.2).relative_rms < 0.3
    with pytest.raises(ValueError, match="anisotropic"):
        lobe_bsdf.open(FIXTURES / "cloth-17x7x17x13.ddr").save(file, "merl", resample=True)
    with pytest.raises(ValueError, match="found reflection; expected transmission"):
        merl.save(tmp_path / "gold.ddt", resample=True)


def test_the_error_of_a_saved_file_is_the_one_that_compare_finds(conductor, tmp_path):
    exact = conductor.save(tmp_path / "copy.ssdd")
    assert (exact.format, exact.exact, exact.nodes, exact.max, exact.rms) == ("ssdd", True, None, 0, 0)
    assert exact.errors == () and exact.unknown is None
    file = tmp_path / "gold.bsdf"
    saved = conductor.save(file, "rgl", resample=True)
    assert not saved.exact and "theta_i" in saved.nodes and saved.note is None
    found = conductor.compare(lobe_bsdf.open(file))
    assert (saved.max, saved.rms, saved.relative_rms) == (found.max, found.rms, found.relative_rms)
    assert saved.rms > 0 and saved.errors[0].startswith("differs from the source by at most ")
    # A format that lobe does not read.
    unread = [format for format in lobe_bsdf.formats() if format.is_written and not format.is_read]
    for format in unread:
        try:
            saved = conductor.save(tmp_path / "unread", format.word, resample=True, channel="G")
        except ValueError:
            continue
        assert saved.exact or (saved.rms is None and "does not read" in saved.unknown)


def test_one_channel_in_a_format_of_colours_has_an_error(tmp_path):
    theta, phi = np.radians(np.linspace(0, 90, 10)), np.radians(np.linspace(0, 360, 13))
    values = np.random.default_rng(3).uniform(0.1, 0.3, (4, 1, 10, 13, 2)).astype(np.float32)
    values[..., -1, :] = values[..., 0, :]
    sigma = np.radians([0.0, 30.0, 60.0, 85.0])
    spectral = lobe_bsdf.from_samples(values, sigma=sigma, psi=[0.0], theta=2 * theta, phi=phi, wavelengths=[360.0, 550.0])
    saved = spectral.save(tmp_path / "uv.binary", "merl", resample=True, channel="360nm")
    assert saved.note == "360nm only, one channel as equal R, G and B"
    assert 0 < saved.relative_rms < 0.5 and saved.unknown is None


def test_nodes_are_refined_until_the_error_is_small_enough(conductor, tmp_path):
    file = tmp_path / "gold.bsdf"
    coarse = conductor.save(file, "lighttools", resample=True, channel="G")
    bound = 0.6 * coarse.relative_rms
    fine = conductor.save(file, "lighttools", resample=True, channel="G", error=bound)
    assert fine.relative_rms <= bound and fine.nodes != coarse.nodes
    before = file.read_bytes()
    with pytest.raises(ValueError, match="as the smallest error, with .* bins"):
        conductor.save(file, "merl", resample=True, error=1e-9)
    assert file.read_bytes() == before
    with pytest.raises(ValueError, match="error: found"):
        conductor.save(file, "merl", resample=True, error=0.0)


def test_materials_that_cannot_be_saved_are_reported(conductor, tmp_path):
    with pytest.raises(ValueError, match="format: found"):
        conductor.save(tmp_path / "a.ddr", "exr")
    with pytest.raises(ValueError, match="found the extension .tiff"):
        conductor.save(tmp_path / "a.tiff")
    with pytest.raises(lobe_bsdf.FormatError):
        conductor.save(tmp_path / "missing" / "a.ddr")
    assert not list(tmp_path.iterdir())
