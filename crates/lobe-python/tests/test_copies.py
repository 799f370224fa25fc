"""Pickles, and the processes to which they are sent."""

import copy
import multiprocessing
import pickle
import warnings

import numpy as np
import pytest
from conftest import directions

import lobe_bsdf


def same(a, b):
    wi, wo = directions(400, 1), directions(400, 2)
    return a.eval(wi, wo).tobytes() == b.eval(wi, wo).tobytes() and (a.channels, a.kind, a.facts, a.strict) == (
        b.channels,
        b.kind,
        b.facts,
        b.strict,
    )


def test_a_pickle_has_the_content_of_the_file(fixtures, tmp_path):
    file = tmp_path / "paint.ddr"
    file.write_bytes((fixtures / "paint-12x21x13.ddr").read_bytes())
    material = lobe_bsdf.open(file, strict=True, edges="zero", backend="scalar")
    pickled = pickle.dumps(material)
    file.unlink()
    again = pickle.loads(pickled)
    assert same(material, again) and again.backend == "scalar" and again.format == material.format
    # A material from memory can be pickled again.
    assert same(pickle.loads(pickle.dumps(again)), material)
    with pytest.raises(ValueError, match="expected the file from which the material was read"):
        pickle.dumps(material)


def test_a_file_that_has_changed_is_not_pickled(fixtures, tmp_path):
    file = tmp_path / "paint.ddr"
    file.write_bytes((fixtures / "paint-12x21x13.ddr").read_bytes())
    material = lobe_bsdf.open(file)
    file.write_bytes((fixtures / "conductor-7x8x13.ddr").read_bytes())
    with pytest.raises(ValueError, match="changed since"):
        pickle.dumps(material)


def test_a_sidecar_is_pickled(tmp_path):
    file = tmp_path / "own.csv"
    file.write_text("theta_i,theta_o,phi_o,value\n" + "\n".join(
        f"{i},{o},{p},{0.3 + 0.001 * o}" for i in (0, 30, 60) for o in (0, 30, 60, 80) for p in range(0, 360, 45)
    ))
    (tmp_path / "own.csv.lobe.toml").write_text('values = "luminance-factor"\n')
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        material = lobe_bsdf.open(file)
    assert material.eval([0, 0, 1], [0, 0, 1])[0] == pytest.approx(0.3 / np.pi, rel=1e-5)
    assert same(pickle.loads(pickle.dumps(material)), material)


def test_samples_are_pickled(conductor):
    table = lobe_bsdf.from_samples(**conductor.arrays(), facts=[("sample", "a"), ("comment", "b")])
    assert same(pickle.loads(pickle.dumps(table)), table)
    rng = np.random.default_rng(3)
    angles = {name: rng.random(200) * 1.5 for name in ("theta_i", "phi_i", "theta_o", "phi_o")}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        scattered = lobe_bsdf.from_samples(rng.random((200, 3)), **angles, channels="rgb")
    assert same(pickle.loads(pickle.dumps(scattered)), scattered)
    assert copy.deepcopy(scattered) is copy.copy(scattered) is scattered


def test_samplers_are_pickled(conductor):
    sampler = conductor.sampler(defensive=0.1, luminance=[1, 0, 0])
    again = pickle.loads(pickle.dumps(sampler))
    wi, wo = directions(100, 1), directions(100, 2)
    assert again.pdf(wi, wo).tobytes() == sampler.pdf(wi, wo).tobytes()


def evaluated(material):
    w = directions(40_000, 5)
    return material.eval(w, w[::-1]).tobytes()


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_other_processes_evaluate_large_batches(conductor, method):
    # This process has threads by now, which forked processes do not get.
    expected = evaluated(conductor)
    with warnings.catch_warnings():
        # Newer versions of Python warn of forks in processes with threads.
        warnings.simplefilter("ignore", DeprecationWarning)
        with multiprocessing.get_context(method).Pool(2) as pool:
            found = pool.map_async(evaluated, [conductor] * 3).get(timeout=60)
    assert all(values == expected for values in found)
