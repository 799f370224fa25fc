"""Pictures rendered by job engines: they equal the picture of a single process, bit by bit."""

import hashlib
import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys
import threading
import time

import pytest

import lobe_bsdf
from lobe_bsdf import farm


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.fixture(scope="module")
def scene(fixtures, tmp_path_factory):
    text = (fixtures / "scenes" / "cloth-metal-paint.toml").read_text()
    sizes = {"width": 160, "height": 90, "samples": 8}
    lines = [
        next((f"{key} = {value}" for key, value in sizes.items() if line.startswith(f"{key} = ")), line)
        for line in text.splitlines()
    ]
    folder = tmp_path_factory.mktemp("farm")
    for file in fixtures.iterdir():
        (folder / file.name).symlink_to(file)
    (folder / "small").mkdir()
    for file in (fixtures / "scenes").iterdir():
        (folder / "small" / file.name).symlink_to(file)
    scene = folder / "small" / "small.toml"
    scene.write_text("\n".join(lines))
    return scene


@pytest.fixture(scope="module")
def whole(scene, tmp_path_factory):
    file = tmp_path_factory.mktemp("whole") / "whole.exr"
    lobe_bsdf.render(scene).save(file)
    return digest(file)


def test_openjd_renders_the_picture(scene, whole, program, tmp_path):
    openjd = shutil.which("openjd", path=str(pathlib.Path(sys.executable).parent)) or shutil.which("openjd")
    if openjd is None:
        pytest.skip("openjd-cli is not installed")
    job = tmp_path / "job"
    subprocess.run([program, "farm", "openjd", scene, "-o", job, "--parts", "4"], check=True)
    subprocess.run([openjd, "check", job / "template.json"], check=True)
    given = json.loads((job / "parameter_values.json").read_text())["parameterValues"]
    values = [word for value in given for word in ("-p", f"{value['name']}={value['value']}")]
    run = [openjd, "run", job / "template.json", *values, "--step", "Merge", "--run-dependencies"]
    subprocess.run(run, check=True, capture_output=True)
    assert digest(job / "picture.exr") == whole
    status = subprocess.run([program, "farm", "status", job, "--json"], check=True, capture_output=True)
    assert json.loads(status.stdout)["finished"] == 4


@pytest.mark.skipif(importlib.util.find_spec("ray") is None, reason="ray is not installed")
@pytest.mark.filterwarnings("ignore")
def test_ray_renders_the_picture_though_a_machine_dies(scene, whole, tmp_path):
    import ray
    from ray.cluster_utils import Cluster

    # The head has no processors, so the parts run on the other machines.
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0})
    nodes = [cluster.add_node(num_cpus=1) for _ in range(3)]
    ray.init(address=cluster.address, log_to_driver=False)
    try:
        cluster.wait_for_nodes()
        output = tmp_path / "picture.exr"
        parts = tmp_path / "picture.exr.parts"

        def kill():
            deadline = time.monotonic() + 60
            while not (parts.exists() and any(parts.glob("*.exr"))) and time.monotonic() < deadline:
                time.sleep(0.05)
            cluster.remove_node(nodes[0], allow_graceful=False)

        killer = threading.Thread(target=kill)
        killer.start()
        farm.render(scene, output, 12, quiet=True)
        killer.join()
        assert digest(output) == whole
        # Existing parts are kept.
        files = sorted(parts.iterdir())
        assert len(files) == 12
        files[3].unlink()
        times = {file: file.stat().st_mtime_ns for file in files if file.exists()}
        farm.render(scene, tmp_path / "picture.exr", 12, quiet=True)
        assert all(file.stat().st_mtime_ns == before for file, before in times.items())
        assert digest(output) == whole
    finally:
        ray.shutdown()
        cluster.shutdown()


def test_the_driver_checks_its_arguments(scene, tmp_path, capsys):
    with pytest.raises(SystemExit):
        farm.main([str(scene), "-o", str(tmp_path / "a.exr"), "--parts", "0"])
    if importlib.util.find_spec("ray") is None:
        assert farm.main([str(scene), "-o", str(tmp_path / "a.exr"), "--parts", "2"]) == 2
        assert "pip install" in capsys.readouterr().err
    else:
        assert farm.main([str(scene), "-o", str(tmp_path / "a.jpg"), "--parts", "2"]) == 1
        assert "expected a name" in capsys.readouterr().err
        assert farm.main([str(tmp_path / "none.toml"), "-o", str(tmp_path / "a.exr"), "--parts", "2"]) == 1
