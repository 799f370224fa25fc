"""Properties of materials, and their sources."""

import gc
import inspect
import sys
import warnings

import numpy as np
import pytest
from conftest import directions

import lobe_bsdf


def test_a_file_says_what_it_is(conductor, cloth):
    assert conductor.channels == ("R", "G", "B")
    assert conductor.wavelengths is None
    assert conductor.is_isotropic and not cloth.is_isotropic
    assert conductor.kind == cloth.kind == "specular table"
    assert conductor.format == "Integra DDR/DDT"
    assert conductor.aspects == ("reflection front",)
    assert conductor.backend in lobe_bsdf.backends()
    assert not conductor.strict
    assert conductor.resampling is None
    assert conductor.nbytes > 1000
    assert all(len(fact) == 2 for fact in conductor.facts)
    assert repr(conductor).startswith("<lobe_bsdf.Material: specular table from Integra DDR/DDT, R G B; ")


def test_backends_agree(fixtures):
    wi, wo = directions(1000, 1), directions(1000, 2)
    names = lobe_bsdf.backends()
    assert names[0] == "scalar"
    strict = [
        lobe_bsdf.open(fixtures / "cloth-17x7x17x13.ddr", backend=name, strict=True).eval(wi, wo) for name in names
    ]
    assert all(f.tobytes() == strict[0].tobytes() for f in strict)
    fused = lobe_bsdf.open(fixtures / "cloth-17x7x17x13.ddr", backend=names[-1])
    np.testing.assert_allclose(fused.eval(wi, wo), strict[0], rtol=1e-3, atol=1e-5)
    with pytest.raises(ValueError, match="backend `mmx` is unknown; this machine has: scalar"):
        lobe_bsdf.open(fixtures / "cloth-17x7x17x13.ddr", backend="mmx")


def test_formats_are_listed():
    formats = {format.word: format for format in lobe_bsdf.formats()}
    assert formats["merl"].is_read and formats["merl"].is_written
    assert formats["npz"].is_written and not formats["npz"].is_read
    assert "ddr" in formats["ddr"].extensions


def test_edges(fixtures):
    file = fixtures / "conductor-7x8x13.ddr"
    last = max(lobe_bsdf.open(file).arrays()["sigma"])
    wi = lobe_bsdf.normalize([np.sin(last + 0.05), 0, np.cos(last + 0.05)])
    wo = lobe_bsdf.normalize([-wi[0], 0.05, wi[2]])
    clamp, zero, line = (lobe_bsdf.open(file, edges=edges).eval(wi, wo) for edges in ("clamp", "zero", "extrapolate"))
    assert (zero == 0).all() and (clamp > 0).all() and (line != clamp).any()


@pytest.mark.parametrize("option", [{"lookup": "linear"}, {"indexed_by": "viewer"}, {"decode": "srgb"}])
def test_options_that_change_nothing_are_refused(fixtures, option):
    (name,) = option
    with pytest.raises(ValueError, match=f"{name}: found specular table; expected"):
        lobe_bsdf.open(fixtures / "conductor-7x8x13.ddr", **option)


def test_words_are_checked(fixtures):
    with pytest.raises(ValueError, match='edges: found "wrap"; expected "clamp" or "extrapolate" or "zero"'):
        lobe_bsdf.open(fixtures / "conductor-7x8x13.ddr", edges="wrap")
    with pytest.raises(TypeError, match="edge"):
        lobe_bsdf.open(fixtures / "conductor-7x8x13.ddr", edge="zero")


def test_bytes_are_a_file(fixtures, conductor):
    data = (fixtures / "conductor-7x8x13.ddr").read_bytes()
    wi, wo = directions(50, 1), directions(50, 2)
    expected = conductor.eval(wi, wo).tobytes()
    for bytes_like in (data, bytearray(data), memoryview(data), np.frombuffer(data, np.uint8)):
        found = lobe_bsdf.from_bytes(bytes_like, "conductor.ddr")
        assert found.eval(wi, wo).tobytes() == expected
    with pytest.raises(TypeError):
        lobe_bsdf.from_bytes("text")


def test_arrays_make_the_same_material(conductor, cloth):
    for material in (conductor, cloth):
        again = lobe_bsdf.from_samples(**material.arrays())
        wi, wo = directions(500, 1), directions(500, 2)
        assert again.eval(wi, wo).tobytes() == material.eval(wi, wo).tobytes()
        assert again.format is None and again.channels == material.channels


def lambert(**options):
    axes = {
        "sigma": np.linspace(0, 80, 5),
        "theta": np.linspace(0, 180, 7),
        "phi": np.linspace(0, 360, 9),
        "degrees": True,
    }
    return lobe_bsdf.from_samples(np.full((5, 7, 9), 0.5 / np.pi), **axes, **options)


def test_a_table_of_one_value_is_lambertian():
    material = lambert(facts=[("sample", "tile 3")])
    np.testing.assert_allclose(material.eval(directions(100, 1), directions(100, 2)), 0.5 / np.pi, rtol=1e-6)
    assert material.facts == (("sample", "tile 3"),)
    assert material.channels == ("Y",)
    np.testing.assert_allclose(material.albedo(np.radians([0, 30])), 0.5, atol=1e-3)


def test_grids_in_spherical_coordinates_and_wavelengths():
    theta_i, phi_o = np.radians([0, 30, 60]), np.radians(np.arange(0, 361, 30))
    theta_o = np.radians(np.arange(0, 91, 10))
    shape = (3, 10, 13)
    values = np.stack([np.full(shape, 0.1), np.full(shape, 0.2)], -1)
    material = lobe_bsdf.from_samples(
        values, theta_i=theta_i, theta_o=theta_o, phi_o=phi_o, wavelengths=[450.0, 650.0]
    )
    np.testing.assert_allclose(material.eval(directions(9, 1), directions(9, 2)), [[0.1, 0.2]] * 9, rtol=1e-6)
    assert material.channels == ("450nm", "650nm")
    np.testing.assert_array_equal(material.wavelengths, [450, 650])


def test_scattered_samples():
    theta_o = np.radians(np.tile([0, 20, 40, 60, 80], 12))
    phi_o = np.radians(np.repeat(np.arange(0, 360, 30), 5))
    f = 0.1 + np.exp(-theta_o)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        material = lobe_bsdf.from_samples(f, theta_i=np.zeros(60), theta_o=theta_o, phi_o=phi_o)
    assert any(issubclass(warning.category, lobe_bsdf.GuessWarning) for warning in said)
    assert material.kind == "scattered samples"
    wo = [np.sin(np.radians(40)), 0, np.cos(np.radians(40))]
    np.testing.assert_allclose(material.eval([0, 0, 1], wo), [0.1 + np.exp(-np.radians(40))], rtol=1e-5)


@pytest.mark.parametrize(
    "arguments, error, words",
    [
        ({"values": np.zeros((2, 2, 2))}, TypeError, "no axes"),
        ({"values": np.zeros((2, 2, 2)), "sigma": [0, 1], "theta": [0, 1]}, TypeError, "found no phi"),
        (
            {"values": np.zeros((2, 2, 2)), "sigma": [0, 1], "theta": [0, 1], "phi": [0, 1], "theta_i": [0]},
            TypeError,
            "both",
        ),
        (
            {"values": np.zeros((2, 3, 2)), "sigma": [0, 1], "theta": [0, 1], "phi": [0, 1]},
            ValueError,
            r"values: found an array of shape \(2, 3, 2\); expected \(2, 2, 2\) for \(sigma, theta, phi\)",
        ),
        ({"values": np.zeros((2, 2, 2, 3)), "sigma": [0, 1], "theta": [0, 1], "phi": [0, 1]}, TypeError, "3 channels"),
        (
            {"values": np.zeros((2, 2, 2, 3)), "sigma": [0, 1], "theta": [0, 1], "phi": [0, 1], "channels": ["a", "b"]},
            ValueError,
            "found 3 channels; expected 2",
        ),
        ({"values": np.zeros((2, 2, 2)), "sigma": [1, 0], "theta": [0, 1], "phi": [0, 1]}, ValueError, "sigma"),
        ({"values": np.zeros((2, 2, 2)), "sigma": [0, 2], "theta": [0, 1], "phi": [0, 1]}, ValueError, "sigma"),
        (
            {"values": np.full((2, 2, 2), np.nan), "sigma": [0, 1], "theta": [0, 1], "phi": [0, 1]},
            ValueError,
            "finite|NaN",
        ),
        ({"values": np.zeros(2), "theta_i": [0, 1], "theta_o": [0], "phi_o": [0, 1]}, ValueError, "theta_o: found 1"),
        (
            {"values": np.zeros(2), "theta_i": [0, 1], "theta_o": [0, 1], "phi_o": [0, 1], "channels": "lab"},
            ValueError,
            "channels",
        ),
    ],
)
def test_samples_that_do_not_fit_are_refused(arguments, error, words):
    with pytest.raises(error, match=words):
        lobe_bsdf.from_samples(**arguments)


def test_no_references_are_lost_or_kept(fixtures):
    conductor = lobe_bsdf.open(fixtures / "conductor-7x8x13.ddr")
    wi, wo = directions(200, 1), directions(200, 2)
    out = np.zeros((200, 3), np.float32)
    for _ in range(3):
        conductor.eval(wi, wo, out=out)
    gc.collect()
    before = [sys.getrefcount(thing) for thing in (wi, wo, out, conductor)]
    for _ in range(100):
        conductor.eval(wi, wo, out=out)
        conductor.eval(wi[:, ::-1], wo)
        with pytest.raises(ValueError):
            conductor.eval(wi, wo, out=out[:5])
    gc.collect()
    assert [sys.getrefcount(thing) for thing in (wi, wo, out, conductor)] == before


def test_everything_public_is_documented():
    for name in lobe_bsdf.__all__:
        thing = getattr(lobe_bsdf, name)
        assert thing.__doc__, name
        if inspect.isclass(thing) and thing.__module__ == "lobe_bsdf":
            for member, value in vars(thing).items():
                if not member.startswith("_"):
                    assert value.__doc__, f"{name}.{member}"


def test_the_stubs_match_the_module():
    import ast
    import pathlib

    stubs = pathlib.Path(lobe_bsdf.__file__).with_name("_lobe.pyi")
    tree = ast.parse(stubs.read_text())
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    native = lobe_bsdf._lobe
    assert {name for name in dir(native) if not name.startswith("_")} == functions.keys() | {
        node.name for node in tree.body if isinstance(node, ast.ClassDef)
    }

    def parameters(node):
        return [argument.arg for argument in node.args.args + node.args.kwonlyargs]

    for name, node in functions.items():
        assert parameters(node) == list(inspect.signature(getattr(native, name)).parameters), name
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            cls = getattr(native, node.name)
            members = {member.name: member for member in node.body if isinstance(member, ast.FunctionDef)}
            assert members.keys() == {name for name in vars(cls) if not name.startswith("_")}, node.name
            for name, member in members.items():
                if not member.decorator_list:
                    assert parameters(member) == list(inspect.signature(getattr(cls, name)).parameters), name
