"""Importance sampling."""

import numpy as np
import pytest
from conftest import directions


@pytest.fixture(scope="module")
def sampler(conductor):
    return conductor.sampler()


def test_samples_have_their_density(conductor, sampler):
    wi = directions(1, 4)[0]
    u = np.random.default_rng(1).random((4000, 2), np.float32)
    w, pdf, weight = sampler.sample(wi, u)
    assert w.shape == (4000, 3) and pdf.shape == (4000,) and weight.shape == (4000, 3)
    drawn = pdf > 0
    assert drawn.mean() > 0.9
    np.testing.assert_allclose(sampler.pdf(wi, w[drawn]), pdf[drawn], rtol=2e-3)
    f = conductor.eval(wi, w)
    np.testing.assert_allclose(f[drawn] * w[drawn, 2:] / pdf[drawn, None], weight[drawn], rtol=2e-3)


def test_the_mean_weight_is_the_albedo(conductor, sampler):
    theta = np.radians(40)
    wi = [np.sin(theta), 0, np.cos(theta)]
    n = 256
    u = (np.stack(np.meshgrid(np.arange(n), np.arange(n)), -1).reshape(-1, 2) + 0.5) / n
    weight = sampler.sample(wi, u)[2]
    albedo, error = conductor.albedo(theta, 0.0, errors=True)
    assert error < 1e-3
    np.testing.assert_allclose(weight.mean(axis=0), albedo, rtol=5e-3)


def test_either_direction_may_be_given(conductor, sampler):
    wo = directions(100, 7)
    u = np.random.default_rng(2).random((100, 2))
    w, pdf, weight = sampler.sample(wo, u, given="viewer")
    drawn = pdf > 0
    np.testing.assert_allclose(sampler.pdf(w, wo, given="viewer")[drawn], pdf[drawn], rtol=2e-3)
    f = conductor.eval(w, wo)[drawn] * w[drawn, 2:] / pdf[drawn, None]
    np.testing.assert_allclose(f, weight[drawn], rtol=2e-3)


def test_shapes_broadcast(sampler):
    w, pdf, weight = sampler.sample(directions(4).reshape(4, 1, 3), np.full((5, 2), 0.25))
    assert (w.shape, pdf.shape, weight.shape) == ((4, 5, 3), (4, 5), (4, 5, 3))
    w, pdf, weight = sampler.sample([0, 0, 1], [0.5, 0.5])
    assert (w.shape, pdf.shape, weight.shape) == ((3,), (), (3,))
    columns = np.asfortranarray(directions(6))
    assert sampler.pdf(columns, columns).shape == (6,)


@pytest.mark.parametrize("u", [[1.0, 0.5], [-0.1, 0.5], [0.5, np.nan]])
def test_numbers_outside_the_square_are_refused(sampler, u):
    with pytest.raises(ValueError, match=r"expected numbers in \[0, 1\)"):
        sampler.sample([0, 0, 1], u)


def test_options(conductor, sampler):
    assert conductor.sampler(defensive=1.0).pdf([0, 0, 1], [0, 0, 1]) == pytest.approx(1 / np.pi, rel=1e-2)
    assert sampler.nbytes > 0 and sampler.material is conductor
    for bad in ({"defensive": 0.0}, {"luminance": [1.0]}, {"luminance": [0.0, 0.0, 0.0]}):
        with pytest.raises(ValueError, match="expected"):
            conductor.sampler(**bad)
    with pytest.raises(ValueError, match="given"):
        sampler.pdf([0, 0, 1], [0, 0, 1], given="camera")
