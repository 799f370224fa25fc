"""Evaluates files written by lobe with the programs for which they are written.

    python -m venv venv && venv/bin/pip install -r xtask/peers/requirements.txt
    cargo build --release -p lobe-cli
    venv/bin/python xtask/peers/roundtrip.py target/release/lobe

RGL files are evaluated in Mitsuba's `measured` plugin, Klems matrices in pyradiance, arrays and columns in NumPy, all
at the same directions as `lobe eval` on the same file, which must agree, and on the file's source, which shows the
error of resampling. The exit code is 1 if a peer disagrees.
"""

import argparse
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

FIXTURES = pathlib.Path(__file__).parents[2] / "fixtures"

# The largest difference between lobe and a peer for a file, relative to the value or to a hundredth of the mean value.
MITSUBA = 1e-3
# Radiance changes its values by up to 3.5e-4 on purpose, to break ties in sampling.
RADIANCE = 4e-4
# Radiance keeps the colour of a patch as u' and v' in steps of 1/410, randomly rounded: at most two steps.
RADIANCE_COLOUR = 2 / 410

# dctimestep multiplies in single precision, and prints seven digits; colours of patches are kept in steps.
DAYLIGHT = 1e-5
DAYLIGHT_COLOUR = 2e-3

PAIRS = 5000


class Lobe:
    """The program under test."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, *arguments, stdin=None):
        done = subprocess.run([self.program, *map(str, arguments)], input=stdin, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"lobe {' '.join(map(str, arguments))}: {done.stderr}")
        return done

    def write(self, name, *arguments):
        """Runs a command that writes a file of this name, and prints its output."""
        path = self.folder / name
        command, *rest = arguments
        source = [rest.pop(0)] if command in ("generate", "convert") else []
        print(self.run(command, *source, path, *rest).stderr.replace(str(self.folder) + "/", ""), end="")
        return path

    def eval(self, file, wi, wo, *options):
        """`f` in 1/sr, [pair][channel]."""
        rows = "\n".join(",".join(f"{x:.9g}" for x in pair) for pair in np.hstack([wi, wo]))
        out = self.run("eval", file, "--pairs", "-", *options, stdin=rows).stdout
        return np.array([[float(x) for x in line.split(",")] for line in out.splitlines()])


def directions(count, seed):
    """Cosine-weighted unit vectors above the surface, none within a degree of the horizon."""
    rng = np.random.default_rng(seed)
    radius, turn = np.sqrt(0.9997 * rng.random(count)), 2 * np.pi * rng.random(count)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), np.sqrt(1 - radius**2)], axis=1)


def near_mirror(wi, seed):
    """Directions to the viewer, half of them near the mirror direction."""
    wo = directions(len(wi), seed)
    mirrored = wi * [-1, -1, 1] + 0.15 * np.random.default_rng(seed + 1).standard_normal(wi.shape)
    mirrored /= np.linalg.norm(mirrored, axis=1)[:, None]
    use = (np.arange(len(wi)) % 2 == 0) & (mirrored[:, 2] > 0.02)
    return np.where(use[:, None], mirrored, wo)


def errors(expected, found):
    """Differences relative to the value, or to a hundredth of the mean."""
    scale = np.maximum(np.abs(expected), 0.01 * np.abs(expected).mean())
    return np.abs(found - expected) / scale


class Verdict:
    """The result of all comparisons so far."""

    def __init__(self):
        self.agrees = True

    def compare_steps(self, what, expected, found, tolerance):
        """Prints the largest difference; fails if it is above the tolerance."""
        largest = np.abs(found - expected).max()
        passed = bool(largest <= tolerance)
        self.agrees &= passed
        print(f"  {what}: largest difference {largest:.1e} ({'within' if passed else 'NOT WITHIN'} {tolerance:g})")

    def compare(self, what, expected, found, tolerance=None):
        """Prints the differences; fails if the largest is above the tolerance, if there is one."""
        error = errors(expected, found)
        largest = error.max()
        print(f"  {what}: median {np.median(error):.1e}, 95 % {np.quantile(error, 0.95):.1e}, largest {largest:.1e}", end="")
        if tolerance is not None:
            passed = bool(largest <= tolerance)
            self.agrees &= passed
            print(f" ({'within' if passed else 'NOT WITHIN'} {tolerance:g})", end="")
        print()


def mitsuba_peer(lobe, verdict):
    """RGL files in the `measured` plugin."""
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb" if "llvm_ad_rgb" in mi.variants() else "scalar_rgb")
    import drjit as dr

    generated = [
        ("ggx.bsdf", ["ggx", "--to", "rgl", "--alpha", "0.25"]),
        ("ggx-diffuse.bsdf", ["ggx", "--to", "rgl", "--alpha", "0.15", "--diffuse", "0.35,0.3,0.28"]),
        ("brushed.bsdf", ["ggx", "--to", "rgl", "--alpha", "0.2,0.4"]),
    ]
    converted = ["conductor-7x8x13.ddr", "cloth-17x7x17x13.ddr"]
    files = [(lobe.write(name, "generate", *options), None) for name, options in generated]
    files += [(lobe.write(f"{name}.bsdf", "convert", FIXTURES / name, "--to", "rgl"), FIXTURES / name) for name in converted]
    wi = directions(PAIRS, 1)
    wo = near_mirror(wi, 2)
    for file, source in files:
        print(f"{file.name} in Mitsuba {mi.__version__}")
        bsdf = mi.load_dict({"type": "measured", "filename": str(file)})
        surface = dr.zeros(mi.SurfaceInteraction3f, PAIRS)
        surface.wi = mi.Vector3f(*[mi.Float(column.astype(np.float32)) for column in wi.T])
        viewer = mi.Vector3f(*[mi.Float(column.astype(np.float32)) for column in wo.T])
        values = np.array(bsdf.eval(mi.BSDFContext(), surface, viewer)).reshape(3, PAIRS).T
        verdict.compare("f cos against lobe on the file", lobe.eval(file, wi, wo, "--cosine"), values, MITSUBA)
        if source is not None:
            cosine = wo[:, 2:]
            verdict.compare("f cos against lobe on the source", lobe.eval(source, wi, wo, "--cosine"), values)
        # Sampling: the mean weight must be the albedo of the values.
        rng = np.random.default_rng(3)
        one = dr.zeros(mi.SurfaceInteraction3f, 200_000)
        one.wi = mi.Vector3f(0.5, 0.3, math.sqrt(1 - 0.34))
        uniform = mi.Point2f(*[mi.Float(rng.random(200_000).astype(np.float32)) for _ in range(2)])
        _, weight = bsdf.sample(mi.BSDFContext(), one, mi.Float(0.5), uniform)
        sampled = np.array(weight).reshape(3, -1).mean(axis=1)
        spread = directions(200_000, 4)
        cosines = mi.Vector3f(*[mi.Float(column.astype(np.float32)) for column in spread.T])
        integral = np.array(bsdf.eval(mi.BSDFContext(), one, cosines)).reshape(3, -1) / spread[:, 2]
        print(f"  albedo by its own samples {sampled}, by values {np.pi * integral.mean(axis=1)}")


def chromaticity(xyz):
    """CIE 1976 u' and v'."""
    x, y, z = xyz.T
    return np.stack([4 * x, 9 * y], axis=1) / (x + 15 * y + 3 * z)[:, None]


def radiance_peer(lobe, verdict):
    """Klems matrices in Radiance."""
    from pyradiance import bsdf

    files = [
        lobe.write("ggx.xml", "generate", "ggx", "--alpha", "0.3"),
        lobe.write("cloth.xml", "convert", FIXTURES / "cloth-17x7x17x13.ddr"),
        lobe.write("half.xml", "convert", FIXTURES / "conductor-7x8x13.ddr", "--basis", "half"),
    ]
    wi, wo = directions(PAIRS, 5), directions(PAIRS, 6)
    polar = lambda w: np.degrees([np.arccos(w[:, 2]), np.arctan2(w[:, 1], w[:, 0])]).T
    for file in files:
        print(f"{file.name} in pyradiance")
        data = bsdf.load_file(str(file))
        found = np.array([bsdf.query(data, *a, *b) for a, b in zip(polar(wi), polar(wo))])
        expected = lobe.eval(file, wi, wo, "--channel", "CIE-X", "--channel", "Visible", "--channel", "CIE-Z")
        verdict.compare("Y against lobe on the file", expected[:, 1], found[:, 1], RADIANCE)
        verdict.compare_steps("u' and v' against lobe on the file", chromaticity(expected), chromaticity(found), RADIANCE_COLOUR)
    trees = [
        lobe.write("tree3.xml", "generate", "ggx", "--alpha", "0.3", "--basis", "tree3"),
        lobe.write("tree4.xml", "generate", "ggx", "--alpha", "0.3,0.5", "--basis", "tree4", "--depth", "4"),
        lobe.write("conductor-tree.xml", "convert", FIXTURES / "conductor-7x8x13.ddr", "--basis", "tree3"),
    ]
    for file in trees:
        print(f"{file.name} in pyradiance")
        data = bsdf.load_file(str(file))
        found = np.array([bsdf.query(data, *a, *b) for a, b in zip(polar(wi), polar(wo))])
        expected = lobe.eval(file, wi, wo, "--channel", "Visible")
        error = errors(expected[:, 0], found[:, 1])
        # Where rounding puts a direction into the next cell, the other one has the value of that.
        near = error > RADIANCE
        for pair in np.flatnonzero(near):
            moved = [wi[pair] + shift for shift in 1e-6 * np.random.default_rng(7).standard_normal((40, 3))]
            around = lobe.eval(file, np.array(moved), np.tile(wo[pair], (40, 1)), "--channel", "Visible")[:, 0]
            near[pair] = np.abs(around - found[pair, 1]).min() > RADIANCE * abs(found[pair, 1])
        print(f"  {np.count_nonzero(error > RADIANCE)} pairs on the border of two cells")
        verdict.compare("Y against lobe on the file", expected[~(error > RADIANCE), 0], found[~(error > RADIANCE), 1], RADIANCE)
        verdict.agrees &= not near.any()


def daylight_peer(lobe, verdict):
    """Products of matrices against dctimestep."""
    import pyradiance

    program = pathlib.Path(pyradiance.__file__).parent / "bin" / "dctimestep"
    rng = np.random.default_rng(9)

    def matrix(name, rows, columns, kind="ascii"):
        values = rng.random((rows, columns, 3))
        head = f"#?RADIANCE\nNROWS={rows}\nNCOLS={columns}\nNCOMP=3\n"
        body = {"float": values.astype("<f4").tobytes(), "double": values.astype("<f8").tobytes()}
        ending = "" if kind == "ascii" else "BigEndian=0\n"
        text = "\n".join("\t".join(" ".join(f"{x:.9g}" for x in element) for element in row) for row in values) + "\n"
        path = lobe.folder / name
        path.write_bytes(f"{head}{ending}FORMAT={kind}\n\n".encode() + body.get(kind, text.encode()))
        return path

    def parsed(text):
        return np.array([float(word) for word in text.split("\n\n", 1)[1].split()])

    through = lobe.write("through.bsdf", "generate", "ggx", "--to", "rgl", "--alpha", "0.5")
    grey = lobe.write("grey.xml", "convert", through, "--to", "klems", "--channel", "G")
    coloured = lobe.write("coloured.xml", "convert", through, "--to", "klems")
    for sheet, tolerance in [(grey, DAYLIGHT), (coloured, DAYLIGHT_COLOUR)]:
        sheet = transmitting(sheet)
        for kinds in [("ascii", "float", "double"), ("double", "ascii", "float")]:
            view, daylight, sky = (
                matrix(f"{name}-{kind}.mtx", *shape, kind)
                for name, shape, kind in zip("vds", [(7, 145), (145, 146), (146, 24)], kinds)
            )
            files = [view, sheet, daylight, sky]
            done = subprocess.run([str(program), *map(str, files)], capture_output=True, text=True, check=True)
            found = parsed(lobe.run("matrix", *files).stdout)
            what = f"V T D s of {sheet.name} ({', '.join(kinds)}) against dctimestep"
            verdict.compare(what, parsed(done.stdout), found, tolerance)


def transmitting(sheet):
    """The same matrices as those of transmission from the front: reflection of light from z > 0 is exchanged for it."""
    text = sheet.read_text().replace("Reflection Back", "Transmission Front").replace("BRDF", "BTDF")
    path = sheet.with_name(f"transmitting-{sheet.name}")
    path.write_text(text)
    return path



def numpy_peer(lobe, verdict):
    """Arrays and columns."""
    source = FIXTURES / "cloth-17x7x17x13.ddr"
    arrays = np.load(lobe.write("cloth.npz", "convert", source))
    table = np.loadtxt(lobe.write("cloth.csv", "convert", source), delimiter=",", skiprows=1)
    sizes = [len(arrays[axis]) for axis in ("sigma", "psi", "theta", "phi")]
    print(f"cloth.npz: {', '.join(f'{name} {arrays[name].shape}' for name in arrays)}")
    verdict.compare("CSV against npz", arrays["values"].reshape(-1, 3), table[:, 4:], 1e-6)
    knots = np.stack(np.meshgrid(*[np.degrees(arrays[axis]) for axis in ("sigma", "psi", "theta", "phi")], indexing="ij"))
    verdict.compare("their angles", knots.reshape(4, -1).T, table[:, :4], 1e-6)
    middle = (*(size // 2 for size in sizes[:3]), 0)
    angles = ",".join(f"{knots[axis][middle]:.9g}" for axis in range(4))
    shown = lobe.run("eval", source, "--angles", angles).stdout.split()[1::2]
    verdict.compare(f"the node at {angles} against lobe", arrays["values"][middle], np.array(shown, float), 1e-5)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lobe", help="the lobe program")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder in which the files stay")
    arguments = parser.parse_args()
    verdict = Verdict()
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        lobe = Lobe(str(pathlib.Path(arguments.lobe).resolve()), folder)
        for peer in (numpy_peer, radiance_peer, daylight_peer, mitsuba_peer):
            peer(lobe, verdict)
    sys.exit(0 if verdict.agrees else 1)


if __name__ == "__main__":
    main()
