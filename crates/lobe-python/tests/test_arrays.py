"""Shapes, types and layouts of arrays."""

import array

import numpy as np
import pytest
from conftest import directions

import lobe_bsdf


class WithDlpack:
    def __init__(self, values):
        self.values = values

    def __dlpack__(self, **options):
        return self.values.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.values.__dlpack_device__()


class WithInterface:
    def __init__(self, values):
        self.values = values
        self.__array_interface__ = values.__array_interface__


def test_a_pair_has_a_value_per_channel(conductor):
    f = conductor.eval((0.6, 0.0, 0.8), (-0.6, 0.0, 0.8))
    assert f.shape == (3,) and f.dtype == np.float32 and (f > 0).all()


@pytest.mark.parametrize(
    "wi, wo, expected",
    [
        ((3,), (5, 3), (5, 3)),
        ((5, 3), (3,), (5, 3)),
        ((4, 1, 3), (5, 3), (4, 5, 3)),
        ((4, 1, 1, 3), (1, 6, 2, 3), (4, 6, 2, 3)),
        ((0, 3), (3,), (0, 3)),
        ((2, 0, 3), (1, 3), (2, 0, 3)),
    ],
)
def test_shapes_broadcast_as_in_numpy(conductor, wi, wo, expected):
    wi = directions(int(np.prod(wi[:-1])), 1).reshape(wi)
    wo = directions(int(np.prod(wo[:-1])), 2).reshape(wo)
    f = conductor.eval(wi, wo)
    assert f.shape == expected
    wide_i, wide_o = (np.broadcast_to(w, (*expected[:-1], 3)) for w in (wi, wo))
    one_by_one = [conductor.eval(i, o) for i, o in zip(wide_i.reshape(-1, 3), wide_o.reshape(-1, 3))]
    assert f.tobytes() == np.array(one_by_one, np.float32).reshape(expected).tobytes()


def test_every_layout_gives_the_same_bits(conductor):
    wi, wo = directions(300, 1), directions(300, 2)
    expected = conductor.eval(wi, wo).tobytes()
    padded = np.zeros((300, 5), np.float32)
    padded[:, 1:4] = wi
    backward = np.ascontiguousarray(wi[::-1])[::-1]
    unaligned = np.frombuffer(b"x" + wi.tobytes(), np.uint8)[1:].view(np.float32).reshape(300, 3)
    assert not unaligned.flags.aligned
    layouts = {
        "columns": np.asfortranarray(wi),
        "a transpose": np.ascontiguousarray(wi.T).T,
        "a slice": padded[:, 1:4],
        "backward": backward,
        "unaligned": unaligned,
        "big-endian": wi.astype(">f4"),
        "float64": wi.astype(np.float64),
        "lists": wi.tolist(),
        "read-only": np.frombuffer(wi.tobytes(), np.float32).reshape(300, 3),
        "dlpack": WithDlpack(wi),
        "array interface": WithInterface(wi),
        "a buffer": memoryview(array.array("f", wi.ravel())).cast("B").cast("f", (300, 3)),
    }
    for name, layout in layouts.items():
        assert conductor.eval(layout, wo).tobytes() == expected, name
        assert conductor.eval(layout, np.asfortranarray(wo)).tobytes() == expected, name
    cube = np.asfortranarray(wi.reshape(10, 30, 3))
    assert conductor.eval(cube, wo.reshape(10, 30, 3)).tobytes() == expected


def test_columns_of_several_axes_are_in_the_order_of_rows(conductor):
    x, y, z = np.ascontiguousarray(directions(60, 1).reshape(4, 15, 3).transpose(2, 0, 1))
    columns = np.stack([x, y, z])
    wi = np.moveaxis(columns, 0, -1)
    assert not wi.flags.c_contiguous
    wo = directions(60, 2).reshape(4, 15, 3)
    assert conductor.eval(wi, wo).tobytes() == conductor.eval(np.ascontiguousarray(wi), wo).tobytes()


def test_out_is_written_and_returned(conductor):
    wi, wo = directions(20, 1), directions(20, 2)
    out = np.full((20, 3), np.nan, np.float32)
    assert conductor.eval(wi, wo, out=out) is out
    assert out.tobytes() == conductor.eval(wi, wo).tobytes()


def test_out_must_fit(conductor):
    wi, wo = directions(20, 1), directions(20, 2)
    read_only = np.zeros((20, 3), np.float32)
    read_only.flags.writeable = False
    wrong = [np.zeros((20, 2), np.float32), np.zeros((20, 3)), np.zeros((40, 3), np.float32)[::2], read_only, [1.0], None]
    for out in wrong[:-1]:
        with pytest.raises(ValueError, match="out"):
            conductor.eval(wi, wo, out=out)
    both = np.zeros((20, 3), np.float32)
    both[:] = wi
    with pytest.raises(ValueError, match="borrowed"):
        conductor.eval(both, wo, out=both)


@pytest.mark.parametrize(
    "value, error, words",
    [
        (np.zeros((4, 2), np.float32), ValueError, r"wi: found an array of shape \(4, 2\); expected \(\.\.\., 3\)"),
        (1.0, ValueError, r"wi: found an array of shape \(\)"),
        (np.zeros((4, 3), complex), TypeError, "complex128"),
        (np.zeros((4, 3), bool), TypeError, "bool"),
        (["a", "b", "c"], TypeError, "real numbers"),
        (np.ma.masked_array(np.zeros((4, 3), np.float32), mask=True), TypeError, "mask"),
        (object(), TypeError, "real numbers"),
        ([[0, 0, 1], [0, 0]], ValueError, "inhomogeneous"),
        ([0, 0, 2], ValueError, "of length 2; expected unit vectors"),
    ],
)
def test_arrays_that_are_not_directions_are_refused(conductor, value, error, words):
    with pytest.raises(error, match=words):
        conductor.eval(value, [0, 0, 1])


def test_shapes_that_do_not_broadcast_are_named(conductor):
    with pytest.raises(ValueError, match=r"found wi of shape \(4,\) and wo of shape \(5,\)"):
        conductor.eval(directions(4), directions(5))


def test_lengths_are_checked_far_into_a_batch(conductor):
    wi = directions(50_000)
    conductor.eval(wi, wi)
    with pytest.raises(ValueError, match="wo: found vector"):
        conductor.eval(wi, wi * np.float32(1.1))


def test_zero_vectors_and_nan_are_accepted(conductor):
    wi = np.array([[0, 0, 0], [np.nan, 0, 1], [0, 0, 1]], np.float32)
    f = conductor.eval(wi, [0, 0, 1])
    assert (f[0] == 0).all() and (f[2] > 0).all()


def test_integers_are_accepted(conductor):
    assert (conductor.eval([0, 0, 1], np.array([0, 0, 1], np.int8)) > 0).all()


def test_normalize():
    v = [[3, 0, 4], [1e-300, 0, 0], [1e300, 1e300, 0], [-0.0, -2, 0]]
    expected = np.array([[0.6, 0, 0.8], [1, 0, 0], [0.5**0.5, 0.5**0.5, 0], [0, -1, 0]], np.float32)
    found = lobe_bsdf.normalize(v)
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, expected)
    assert lobe_bsdf.normalize([0, 0, 5]).shape == (3,)
    for bad in ([0, 0, 0], [np.nan, 0, 1], [np.inf, 0, 0]):
        with pytest.raises(ValueError, match="vector 0"):
            lobe_bsdf.normalize(bad)
    with pytest.raises(ValueError, match="shape"):
        lobe_bsdf.normalize([1, 2])
