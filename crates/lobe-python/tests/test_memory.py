"""The memory of large batches: inputs that are copied piece by piece, and results whose memory is reused."""

import gc
import itertools

import numpy as np
import pytest
from conftest import directions

import lobe_bsdf

# More than one task per thread, and not a whole number of tasks.
COUNT = 20_011


@pytest.fixture(scope="module")
def pairs():
    return directions(COUNT, 1), directions(COUNT, 2)


def outer(rows: int, columns: int):
    return directions(rows, 3)[:, None, :], directions(columns, 4)[None, :, :]


def laid_out(vectors: np.ndarray) -> dict[str, np.ndarray]:
    """The same vectors in layouts that are not read in place."""
    padded = np.zeros((len(vectors), 5), np.float32)
    padded[:, 1:4] = vectors
    every_second = np.repeat(vectors, 2, axis=0)[::2]
    return {
        "float64": vectors.astype(np.float64),
        "columns of float64": np.asfortranarray(vectors, np.float64),
        "padded": padded[:, 1:4],
        "backward": np.ascontiguousarray(vectors[::-1])[::-1],
        "components backward": np.ascontiguousarray(vectors[:, ::-1])[:, ::-1],
        "every second": every_second,
        "columns": np.asfortranarray(vectors),
    }


def test_large_batches_of_every_layout_have_the_same_bits(conductor, pairs):
    wi, wo = pairs
    expected = conductor.eval(wi, wo).tobytes()
    sampler = conductor.sampler()
    densities = sampler.pdf(wi, wo).tobytes()
    of_i, of_o = laid_out(wi), laid_out(wo)
    for name in of_i:
        assert conductor.eval(of_i[name], wo).tobytes() == expected, name
        assert conductor.eval(wi, of_o[name]).tobytes() == expected, name
        assert conductor.eval(of_i[name], of_o[name]).tobytes() == expected, name
        assert sampler.pdf(of_i[name], of_o[name]).tobytes() == densities, name


@pytest.mark.parametrize(
    "wi, wo",
    [
        ((3,), (COUNT, 3)),
        ((COUNT, 3), (1, 3)),
        ((150, 1, 3), (150, 3)),
        ((7, 1, 3), (1, 3001, 3)),
        ((3001, 1, 3), (1, 7, 3)),
        ((1, 13, 1, 41, 3), (37, 1, 2, 41, 3)),
        ((13, 1, 1, 3), (1, 41, 37, 3)),
    ],
)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_large_batches_broadcast_as_in_numpy(conductor, wi, wo, dtype):
    shape = np.broadcast_shapes(wi[:-1], wo[:-1])
    wi, wo = (directions(int(np.prod(s[:-1])), seed).reshape(s) for seed, s in ((1, wi), (2, wo)))
    whole = [np.ascontiguousarray(np.broadcast_to(w, (*shape, 3))) for w in (wi, wo)]
    found = conductor.eval(wi.astype(dtype), wo.astype(dtype))
    assert found.shape == (*shape, 3)
    assert found.tobytes() == conductor.eval(*whole).tobytes()


def test_swapped_and_reversed_axes_are_in_their_order(conductor):
    grid = directions(160 * 150, 5).reshape(160, 150, 3)
    wo = directions(150 * 160, 6).reshape(150, 160, 3)
    for view in (grid.swapaxes(0, 1), grid[::-1].swapaxes(0, 1), grid[:, ::-1].swapaxes(0, 1)):
        assert conductor.eval(view, wo).tobytes() == conductor.eval(np.ascontiguousarray(view), wo).tobytes()


def test_samples_of_one_direction_are_those_of_many(cloth):
    sampler = cloth.sampler()
    u = np.random.default_rng(0).random((COUNT, 2)) * 0.999
    w = lobe_bsdf.normalize([0.3, 0.2, 0.9])
    one = sampler.sample(w, u)
    many = sampler.sample(np.tile(w, (COUNT, 1)), u.astype(np.float32))
    assert [a.tobytes() for a in one] == [a.tobytes() for a in many]


@pytest.mark.parametrize("where", [(3,), (COUNT - 1,), (17_000, 9_000)])
def test_the_first_number_that_cannot_be_drawn_with_is_named(conductor, where):
    u = np.full((COUNT, 2), 0.5, np.float32)
    u[list(where), 1] = (1.5, np.nan)[: len(where)]
    with pytest.raises(ValueError, match=rf"u: found .* at {min(where)}; expected numbers in \[0, 1\)"):
        conductor.sampler().sample([0, 0, 1], u)


@pytest.mark.parametrize("count", [1, COUNT])
def test_numbers_just_below_one_are_drawn_with(conductor, count):
    u = np.full((count, 2), np.nextafter(1, 0))
    sampler = conductor.sampler()
    w, pdf, _ = sampler.sample([0, 0, 1], u)
    expected = sampler.sample([0, 0, 1], np.nextafter(np.float32(1), np.float32(0), dtype=np.float32) * np.ones(2, np.float32))
    assert (w == expected[0]).all() and (pdf == expected[1]).all()
    with pytest.raises(ValueError, match="expected numbers"):
        sampler.sample([0, 0, 1], u + 1e-9)


def test_results_have_memory_of_their_own_while_anything_uses_them(conductor, pairs):
    wi, wo = pairs
    first = conductor.eval(wi, wo)
    expected = first.tobytes()
    # Views of views, and views that other libraries make of arrays.
    kept = [first[7:9], memoryview(first), np.from_dlpack(first[:2]), first.T.reshape(-1, order="F")[:5]]
    contents = [np.array(view).tobytes() for view in kept]
    del first
    others = [conductor.eval(wo, wi) for _ in range(4)]
    for one, other in itertools.combinations(others, 2):
        assert not np.shares_memory(one, other)
    assert [np.array(view).tobytes() for view in kept] == contents
    assert conductor.eval(wi, wo).tobytes() == expected


def test_memory_of_results_is_reused(conductor, pairs):
    def address():
        return conductor.eval(*pairs).__array_interface__["data"][0]

    gc.collect()
    addresses = [address() for _ in range(8)]
    assert len(set(addresses)) == 1
    assert addresses[0] % 64 == 0


def test_memory_kept_of_results_is_bounded(conductor):
    count = 3_000_000
    wi, wo = directions(count, 1), directions(count, 2)
    results = [conductor.eval(wi, wo) for _ in range(6)]
    before = memory()
    del results
    # 216 MB, of which 128 are kept.
    assert before - memory() > 70e6


def memory() -> float:
    """The resident memory of this process in bytes."""
    try:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * 4096
    except OSError:
        pytest.skip("the system does not say how much memory a process has")


@pytest.fixture(scope="module")
def of_every_format(conductor, fixtures, tmp_path_factory):
    """Materials in every format in which they can be written."""
    folder = tmp_path_factory.mktemp("formats")
    found = sorted(fixtures.glob("*.ddr"))
    for format in lobe_bsdf.formats():
        if format.is_written and format.is_read:
            # Some formats have no extension of their own.
            path = folder / ".".join((format.word, *format.extensions[:1]))
            try:
                conductor.save(path, format.word, resample=True, channel="G")
            except ValueError:
                try:
                    conductor.save(path, format.word, resample=True)
                except ValueError:
                    continue
            found.append(path)
    return [lobe_bsdf.open(path) for path in found]


@pytest.mark.filterwarnings("ignore::lobe_bsdf.GuessWarning")
def test_every_number_of_a_result_is_written(of_every_format, pairs):
    assert len({material.kind for material in of_every_format}) >= 4
    wi, wo = pairs
    # Directions on both sides, and missing ones.
    wi, wo = wi.copy(), wo.copy()
    wi[::7] *= -1
    wo[::5] *= -1
    wi[::91] = 0
    wo[::97] = 0
    u = np.random.default_rng(0).random((COUNT, 2), np.float32)
    for material in of_every_format:
        sampler = material.sampler()
        results = [lambda: (material.eval(wi, wo),), lambda: (sampler.pdf(wi, wo),), lambda: sampler.sample(wi, u)]
        for result in results:
            arrays = result()
            expected = [array.tobytes() for array in arrays]
            for array in arrays:
                array.fill(np.nan)
            del array, arrays
            assert [array.tobytes() for array in result()] == expected, material
