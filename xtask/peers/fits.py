"""Compares the fits of lobe with SciPy's best of 20 starts, and with the fitter of libbsdf.

    python -m venv venv && venv/bin/pip install numpy scipy
    cargo build --release -p lobe-cli
    venv/bin/python xtask/peers/fits.py target/release/lobe FILE...

Each file is evaluated at pairs of directions, half of them near the mirror direction; `lobe fit` and the others get the
same table of these pairs. SciPy minimises the objective of `lobe fit` for the same model. libbsdf's fitters are its published
formulas (GGX with the Fresnel equations of metals, separable masking and a colour; and the model of Unreal Engine 4),
fitted to differences of the logarithm of 1 + f as it does, but from five starts. The exit code is 1 if residuals of lobe
are more than 1 % larger than those of another.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.optimize import least_squares

STARTS = 20
LIMIT = np.radians(80)
# A residual of lobe may be larger than the others by this share.
SHARE = 0.01
# The floor of logarithms, relative to the median of the values, as in lobe-fit.
FLOOR = 1e-3


def spherical(theta, phi):
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)


def pairs(count, seed=1):
    """Pairs of directions up to 80 degrees from the normal, half of them near the mirror direction."""
    rng = np.random.default_rng(seed)
    spread = lambda n: spherical(np.arcsin(np.sin(LIMIT) * np.sqrt(rng.random(n))), 2 * np.pi * rng.random(n))
    wi, wo = spread(count), spread(count)
    half = count // 2
    mirror = wi[:half] * [-1, -1, 1]
    across = rng.normal(size=(half, 3))
    across -= (across * mirror).sum(axis=1, keepdims=True) * mirror
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angle = np.pi / 2 * rng.random(half) ** 3
    wo[:half] = mirror * np.cos(angle)[:, None] + across * np.sin(angle)[:, None]
    above = wo[:, 2] > np.cos(LIMIT)
    return wi[above], wo[above]


class Geometry:
    """What models need to know about the pairs."""

    def __init__(self, wi, wo):
        self.wi, self.wo = wi, wo
        half = wi + wo
        length = np.linalg.norm(half, axis=1)
        self.half = half / length[:, None]
        self.cos_d = np.minimum(length / 2, 1)
        self.cos_i, self.cos_o = wi[:, 2], wo[:, 2]
        # The distance of the viewer from the mirror direction in direction cosines.
        self.apart = np.hypot(wi[:, 0] + wo[:, 0], wi[:, 1] + wo[:, 1])


def tan2(cosine):
    return 1 / cosine**2 - 1


def distribution(g, alpha):
    scaled = (g.half[:, 0] ** 2 + g.half[:, 1] ** 2) / alpha**2 + g.half[:, 2] ** 2
    return 1 / (np.pi * alpha**2 * scaled**2)


def ggx(g, shape, own):
    """GGX with Schlick's Fresnel, height-correlated masking and a diffuse part."""
    alpha = np.exp(shape[0])
    smith = lambda cosine: 0.5 * (np.sqrt(1 + alpha**2 * tan2(cosine)) - 1)
    lobe = distribution(g, alpha) / (4 * g.cos_i * g.cos_o * (1 + smith(g.cos_i) + smith(g.cos_o)))
    diffuse, f0 = own
    return diffuse / np.pi + (f0 + (1 - f0) * (1 - g.cos_d) ** 5) * lobe


def ggx_fresnel(g, shape, own):
    """The same with the Fresnel equations of a complex refractive index."""
    alpha, n, k = np.exp(shape)
    smith = lambda cosine: 0.5 * (np.sqrt(1 + alpha**2 * tan2(cosine)) - 1)
    lobe = distribution(g, alpha) / (4 * g.cos_i * g.cos_o * (1 + smith(g.cos_i) + smith(g.cos_o)))
    return own[0] / np.pi + own[1] * fresnel_of_metals(g.cos_d, n, k) * lobe


def abg(g, shape, own):
    return np.exp(own[0]) / (np.exp(shape[0]) + g.apart ** shape[1])


def harvey_shack(g, shape, own):
    return np.exp(own[0]) * (1 + (g.apart / np.exp(shape[0])) ** 2) ** (shape[1] / 2)


class Model:
    """A model for SciPy: the bounds of its parameters, and how they are named in the JSON of `lobe fit`."""

    def __init__(self, f, shape, own, names, read):
        self.f, self.shape, self.own, self.names, self.read = f, shape, own, names, read


MODELS = {
    "ggx": Model(ggx, [(np.log(5e-4), np.log(2))], [(0, 1), (0, 1)], (["alpha"], ["diffuse", "f0"]), "log first"),
    "ggx-fresnel": Model(
        ggx_fresnel,
        [(np.log(5e-4), np.log(2)), (np.log(0.02), np.log(100)), (np.log(1e-4), np.log(100))],
        [(0, 1), (0, 1)],
        (["alpha", "n", "k"], ["diffuse", "tint"]),
        "log shapes",
    ),
    "abg": Model(
        abg, [(np.log(1e-16), np.log(1e2)), (0.05, 8)], [(np.log(1e-16), np.log(1e6))], (["B", "g"], ["A"]), "log own"
    ),
    "harvey-shack": Model(
        harvey_shack,
        [(np.log(1e-6), np.log(10)), (-8, -0.05)],
        [(np.log(1e-12), np.log(1e12))],
        (["l", "s"], ["b0"]),
        "log own",
    ),
}


def objective(kind, g, values):
    """The function from modelled values [pair][channel] to residuals."""
    if kind == "cosine":
        weight = np.sqrt(g.cos_i * g.cos_o)[:, None]
        scale = np.sqrt(np.mean((weight * values) ** 2))
        return lambda f: (weight * (f - values) / scale).ravel()
    floor = FLOOR * np.sort(values[values > 0])[np.count_nonzero(values > 0) // 2]
    measured = np.log(np.maximum(values, 0) + floor)
    return lambda f: (np.log(np.maximum(f, 0) + floor) - measured).ravel()


def modelled(model, g, x, channels):
    shapes, own = len(model.shape), len(model.own)
    columns = [model.f(g, x[:shapes], x[shapes + own * c : shapes + own * (c + 1)]) for c in range(channels)]
    return np.stack(columns, axis=1)


def rms(residuals):
    return float(np.sqrt(np.mean(residuals**2)))


def by_scipy(model, g, residuals, channels, values):
    """The smallest residual of 20 starts."""
    rng = np.random.default_rng(2)
    bounds = np.array(model.shape + model.own * channels, dtype=float)
    low, high = bounds[:, 0], bounds[:, 1]
    best = np.inf
    for _ in range(STARTS):
        start = low + (high - low) * (0.05 + 0.9 * rng.random(len(low)))
        if model.read == "log own":
            # Amplitudes that fit the values, as otherwise most starts are hopeless.
            shapes = len(model.shape)
            for channel in range(channels):
                unit = model.f(g, start[:shapes], [0.0])
                lit = values[:, channel] > 0
                start[shapes + channel] = np.clip(
                    np.mean(np.log(values[lit, channel]) - np.log(unit[lit])), low[shapes + channel], high[shapes + channel]
                )
        fun = lambda x: residuals(modelled(model, g, x, channels))
        found = least_squares(fun, start, bounds=(low, high), max_nfev=150, x_scale="jac")
        best = min(best, rms(found.fun))
    return best


def fresnel_of_metals(cosine, n, k):
    """Unpolarised reflectance of a complex refractive index."""
    sin2 = 1 - cosine**2
    t0 = n**2 - k**2 - sin2
    both = np.sqrt(t0**2 + 4 * n**2 * k**2)
    a = np.sqrt(np.maximum(0.5 * (both + t0), 0))
    s = (both + cosine**2 - 2 * a * cosine) / (both + cosine**2 + 2 * a * cosine)
    p = s * (both * cosine**2 + sin2**2 - 2 * a * cosine * sin2) / (both * cosine**2 + sin2**2 + 2 * a * cosine * sin2)
    return 0.5 * (s + p)


def libbsdf_ggx(g, x):
    """libbsdf's GGX [pair][channel]: a colour, a roughness whose square is alpha, and a refractive index."""
    color, (roughness, n, k) = x[:-3], x[-3:]
    alpha = roughness**2
    masking = lambda cosine: 2 / (1 + np.sqrt(1 + alpha**2 * tan2(cosine)))
    lobe = distribution(g, alpha) * masking(g.cos_i) * masking(g.cos_o) / (4 * g.cos_i * g.cos_o)
    return (fresnel_of_metals(g.cos_d, n, k) * lobe)[:, None] * color[None, :]


def libbsdf_ue4(g, x):
    """libbsdf's model of Unreal Engine 4: a base colour, metallic, specular and roughness."""
    color, (metallic, specular, roughness) = x[:-3], x[-3:]
    alpha = roughness**2
    f0 = (0.08 * specular * (1 - metallic) + color * metallic)[None, :]
    far = ((1 - g.cos_d) ** 5)[:, None]
    green = f0[:, f0.shape[1] // 2][:, None]
    fresnel = np.minimum(50 * green, 1) * far + (1 - far) * f0
    visible = lambda a, b: a * (b * (1 - alpha) + alpha)
    lobe = distribution(g, alpha) * 0.5 / (visible(g.cos_i, g.cos_o) + visible(g.cos_o, g.cos_i))
    return (color * (1 - metallic) / np.pi)[None, :] + fresnel * lobe[:, None]


# Its models: the function, and the start and the bounds of the parameters after the colour.
LIBBSDF = {
    "libbsdf GGX": (libbsdf_ggx, [1.5, 0.01], [0.01, 0.0], [100, 100], "after"),
    "libbsdf UE4": (libbsdf_ue4, [0.5, 0.5], [0.0, 0.0], [1, 1], "before"),
}
# Its result depends on the start, so it gets several.
ROUGHNESSES = [0.01, 0.1, 0.3, 0.5, 0.8]


def by_libbsdf(g, values, channels, name):
    """The values of its model, fitted to the differences that it minimises."""
    f, start, low, high, place = LIBBSDF[name]
    scale = lambda f: np.log10(1 + np.maximum(f, 0))
    order = lambda others, roughness: [roughness, *others] if place == "after" else [*others, roughness]
    bounds = (np.r_[np.zeros(channels), order(low, 0.01)], np.r_[np.ones(channels), order(high, 1.0)])
    residuals = lambda x: (scale(f(g, x)) - scale(values)).ravel()
    best = None
    for roughness in ROUGHNESSES:
        first = np.clip(np.r_[np.full(channels, 0.5), order(start, roughness)], bounds[0] + 1e-9, bounds[1] - 1e-9)
        found = least_squares(residuals, first, bounds=bounds, max_nfev=150)
        best = found if best is None or found.cost < best.cost else best
    return f(g, best.x)


def run(lobe, *arguments, stdin=None):
    done = subprocess.run([lobe, *map(str, arguments)], input=stdin, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"lobe {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def evaluated(lobe, file, wi, wo):
    rows = "\n".join(",".join(f"{x:.9g}" for x in pair) for pair in np.hstack([wi, wo]))
    out = run(lobe, "eval", file, "--pairs", "-", stdin=rows)
    return np.array([[float(x) for x in line.split(",")] for line in out.splitlines()])


def table(path, wi, wo, values):
    """The pairs as a file for lobe."""
    angles = [
        np.degrees(column)
        for w in (wi, wo)
        for column in (np.arctan2(np.hypot(w[:, 0], w[:, 1]), w[:, 2]), np.arctan2(w[:, 1], w[:, 0]))
    ]
    channels = ["R", "G", "B"] if values.shape[1] == 3 else ["brdf"]
    header = ",".join(["theta_i_deg", "phi_i_deg", "theta_o_deg", "phi_o_deg", *channels])
    np.savetxt(path, np.column_stack([*angles, values]), delimiter=",", header=header, comments="", fmt="%.12g")


def by_lobe(lobe, file, name, weights, model, channels):
    """The parameters of `lobe fit` as a vector for SciPy, and the seconds that it took."""
    begun = time.perf_counter()
    found = json.loads(run(lobe, "fit", file, "--model", name, "--weights", weights, "--json"))["parameters"]
    seconds = time.perf_counter() - begun
    shape_names, own_names = model.names
    shape = [found[name] for name in shape_names]
    logs = len(shape) if model.read == "log shapes" else 1
    shape[:logs] = np.log(shape[:logs])
    own = []
    for channel in range(channels):
        for name in own_names:
            value = found[name][channel] if isinstance(found[name], list) else found[name]
            own.append(np.log(value) if model.read == "log own" else value)
    return np.r_[shape, own], seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lobe", help="the lobe program")
    parser.add_argument("files", nargs="+", type=pathlib.Path, help="measured materials")
    parser.add_argument("--pairs", type=int, default=3000)
    parser.add_argument("--models", nargs="+", default=["ggx", "ggx-fresnel", "abg", "harvey-shack"], choices=MODELS)
    arguments = parser.parse_args()
    lobe = str(pathlib.Path(arguments.lobe).resolve())
    wi, wo = pairs(arguments.pairs)
    worse = False
    print("| file | model | weights | lobe | other | residual | ratio | s |\n|---|---|---|--:|---|--:|--:|--:|")

    def show(file, name, weights, ours, other, theirs, seconds):
        nonlocal worse
        ratio = ours / theirs
        worse |= ratio > 1 + SHARE
        mark = " WORSE" if ratio > 1 + SHARE else ""
        print(
            f"| {file.name} | {name} | {weights} | {ours:.5f} | {other} | {theirs:.5f} | {ratio:.4f}{mark} | {seconds:.1f} |",
            flush=True,
        )

    for file in arguments.files:
        values = evaluated(lobe, file, wi, wo)
        if values.shape[1] != 3:
            values = values[:, :1]
        lit = (values > 0).any(axis=1)
        g = Geometry(wi[lit], wo[lit])
        values = values[lit]
        channels = values.shape[1]
        with tempfile.TemporaryDirectory() as folder:
            shared = pathlib.Path(folder) / "pairs.csv"
            table(shared, g.wi, g.wo, values)
            for name in arguments.models:
                for weights in ("cosine", "log"):
                    model, residuals = MODELS[name], objective(weights, g, values)
                    x, seconds = by_lobe(lobe, shared, name, weights, model, channels)
                    ours = rms(residuals(modelled(model, g, x, channels)))
                    theirs = by_scipy(model, g, residuals, channels, values)
                    show(file, name, weights, ours, "SciPy", theirs, seconds)
                    for fitter, of in {"libbsdf GGX": "ggx-fresnel", "libbsdf UE4": "ggx"}.items():
                        if name == of:
                            other = by_libbsdf(g, values, channels, fitter)
                            show(file, name, weights, ours, fitter, rms(residuals(other)), seconds)
    sys.exit(1 if worse else 0)


if __name__ == "__main__":
    main()
