"""Strict values have the bits of the program, for every representation with a file."""

import subprocess

import numpy as np
import pytest
from conftest import directions

import lobe_bsdf

FILES = [
    "fixtures/cloth-17x7x17x13.ddr",
    "fixtures/conductor-7x8x13.ddr",
    "fixtures/paint-12x21x13.ddr",
    "data/rgl_bsdf/cc_ibiza_sunset_rgb.bsdf",
    "data/zemax_bsdf/IMX455.bsdf",
    "data/klems_xml/2011-SA1.XML",
    "data/tensortree_xml/blindsT3.xml",
    "data/kaist_pbsdf/spectralon_lowres.pbsdf",
    "data/cornell_brdf/garnet_red.brdf",
    "data/mdl_mbsdf/carpaint_red.mbsdf",
]


@pytest.mark.filterwarnings("ignore::lobe_bsdf.GuessWarning")
@pytest.mark.parametrize("name", FILES)
def test_values_agree_with_the_program(fixtures, shared, program, tmp_path, name):
    file = fixtures.parent / name if name.startswith("fixtures") else shared(name)
    v = np.random.default_rng(11).normal(size=(2, 20_000, 3))
    pairs = tmp_path / "pairs.csv"
    np.savetxt(pairs, np.concatenate(v, axis=1), delimiter=",", fmt="%.17g")
    command = [program, "eval", file, "--pairs", pairs, "--strict"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    expected = np.array([line.split(",") for line in text.split()], np.float32)
    material = lobe_bsdf.open(file, strict=True)
    wi, wo = lobe_bsdf.normalize(v[0]), lobe_bsdf.normalize(v[1])
    found = material.eval(wi, wo)
    assert (expected != 0).mean() > 0.1
    assert found.tobytes() == expected.tobytes()
