"""Compares values with the answers of other programs."""

import numpy as np
import pytest

import lobe_bsdf


def answers(path):
    """The directions wi and wo of each line, and the first numbers of the answer of another program."""
    lines = [line for line in path.read_text().splitlines() if line.strip() and not line.startswith("#")]
    asked, answered = zip(*(line.split("|")[0].split("->") for line in lines))
    asked = np.array([line.split() for line in asked], float)
    answered = np.array([line.split() for line in answered], float)
    return lobe_bsdf.normalize(asked[:, :3]), lobe_bsdf.normalize(asked[:, 3:6]), answered


@pytest.mark.parametrize("name", ["p3.ddr", "a3.ddr"])
def test_tables_agree_with_libbsdf(shared, name):
    wi, wo, expected = answers(shared(f"golden/{name}.libbsdf.txt"))
    material = lobe_bsdf.open(shared(f"golden/{name}"), edges="extrapolate")
    scale = np.abs(material.arrays()["values"]).max()
    assert np.abs(material.eval(wi, wo) - expected).max() < 2e-5 * scale


@pytest.mark.parametrize("name", ["colodur_napoli_4f_rgb", "cc_iris_purple_gem_rgb"])
def test_the_epfl_database_agrees_with_its_reader(shared, name):
    wi, wo, expected = answers(shared(f"golden/real_{name}.bsdf.powitacq.txt"))
    material = lobe_bsdf.open(shared(f"data/rgl_bsdf/{name}.bsdf"))
    # The reader returns 0 if the table is negative between its nodes.
    found = np.maximum(material.eval(wi, wo), 0) * wo[:, 2:]
    expected = expected[:, :3]
    relative = np.abs(found - expected) / np.maximum(np.abs(expected), 1e-3)
    assert np.median(relative) < 1e-5 and np.quantile(relative, 0.95) < 1e-3


@pytest.mark.filterwarnings("ignore::lobe_bsdf.GuessWarning")
def test_klems_matrices_agree_with_radiance(shared):
    wi, wo, expected = answers(shared("golden/real_2011-SA1.XML.radiance.txt"))
    material = lobe_bsdf.open(shared("data/klems_xml/2011-SA1.XML"))
    found = material.eval(wi, wo)[:, material.channels.index("Visible")]
    relative = np.abs(found - expected[:, 0]) / np.maximum(expected[:, 0], 1e-4)
    assert len(expected) > 50 and np.median(relative) < 1e-3


def test_polarised_matrices_have_the_unpolarised_value(shared):
    material = lobe_bsdf.open(shared("data/kaist_pbsdf/spectralon_lowres.pbsdf"))
    wi, wo = lobe_bsdf.normalize([0.3, 0.1, 0.8]), lobe_bsdf.normalize([[-0.2, 0.4, 0.7], [0.0, 0.1, 0.9]])
    matrices = material.mueller(wi, wo, material.wavelengths[2])
    assert matrices.shape == (2, 4, 4) and matrices.dtype == np.float64
    np.testing.assert_allclose(matrices[:, 0, 0], material.eval(wi, wo)[:, 2], rtol=1e-4)


def test_matrices_of_all_wavelengths_are_those_of_each(fixtures):
    material = lobe_bsdf.open(fixtures / "standard-7x9x13.mueller")
    count = len(material.wavelengths)
    wi = lobe_bsdf.normalize([[0.3, 0.1, 0.8], [0.1, -0.5, 0.6]])
    wo = lobe_bsdf.normalize([[[-0.2, 0.4, 0.7]], [[0.0, 0.1, 0.9]], [[0.6, 0.0, 0.5]]])
    matrices = material.mueller(wi, wo)
    assert matrices.shape == (3, 2, count, 4, 4) and matrices.dtype == np.float32
    for at, wavelength in enumerate(material.wavelengths):
        one = material.mueller(wi, wo, wavelength)
        np.testing.assert_allclose(matrices[:, :, at], one, rtol=1e-4, atol=2e-6 * one.max())
    np.testing.assert_allclose(matrices[..., 0, 0], material.eval(wi, wo), rtol=1e-4)
    room = np.zeros_like(matrices)
    assert material.mueller(wi, wo, out=room) is room and np.array_equal(room, matrices)
    with pytest.raises(ValueError, match="out: found with a wavelength"):
        material.mueller(wi, wo, 550.0, out=room)


def test_polarisation_is_not_made_up(conductor):
    with pytest.raises(ValueError, match="found specular table; expected a material with polarisation"):
        conductor.mueller([0, 0, 1], [0, 0, 1], 550.0)
    with pytest.raises(ValueError, match="found specular table; expected a material with polarisation"):
        conductor.mueller([0, 0, 1], [0, 0, 1])
