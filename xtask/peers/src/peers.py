"""Runs peers of lobe on request: `python peers.py PACKAGE TASKS [wide]`. Answers as described in `serve.py`.

TASKS is a JSON file with an object that maps names to tasks. Arrays come from files of little-endian f32.
"""

import importlib.metadata
import json
import sys

import numpy as np
from serve import choose_lanes, serve


def floats(path, rows):
    return np.fromfile(path, "<f4").reshape(rows, -1)


class Scipy:
    """Linear interpolation on a rectilinear grid by SciPy, all channels at once."""

    def __init__(self, task):
        from scipy.interpolate import RegularGridInterpolator

        kind = task["float"]
        knots = tuple(np.array(axis, kind) for axis in task["knots"])
        values = np.fromfile(task["values"], "<f4").reshape(*map(len, knots), 3).astype(kind)
        self.grid = RegularGridInterpolator(knots, values, bounds_error=False, fill_value=None)
        self.points = np.ascontiguousarray(floats(task["points"], len(knots)).T).astype(kind)

    def run(self):
        self.out = self.grid(self.points)

    def values(self):
        return self.out


class Interpn:
    """Linear interpolation by interpn, one channel per call."""

    def __init__(self, task):
        from interpn import raw

        self.interpolate = raw.interpn_linear_rectilinear_f32
        self.knots = [np.array(axis, "f4") for axis in task["knots"]]
        values = np.fromfile(task["values"], "<f4").reshape(-1, 3)
        self.channels = [np.ascontiguousarray(values[:, k]) for k in range(3)]
        self.points = [np.ascontiguousarray(row) for row in floats(task["points"], len(self.knots))]
        self.out = [np.zeros_like(self.points[0]) for _ in range(3)]

    def run(self):
        for channel, out in zip(self.channels, self.out):
            self.interpolate(self.knots, channel, self.points, out)

    def values(self):
        return np.stack(self.out, axis=1)


class Mitsuba:
    """A BSDF of Mitsuba 3, one wavefront per run."""

    def __init__(self, task):
        import drjit as dr
        import mitsuba as mi

        mi.set_variant("llvm_ad_rgb")
        dr.set_thread_count(1)
        self.dr = dr
        self.context = mi.BSDFContext()
        self.bsdf = mi.load_dict(task["bsdf"])
        pairs = floats(task["pairs"], 6)
        self.si = dr.zeros(mi.SurfaceInteraction3f, pairs.shape[1])
        self.si.wi = mi.Vector3f(*pairs[:3])
        self.wo = mi.Vector3f(*pairs[3:])
        self.compute = getattr(self, task["what"])
        if task["what"] == "sample":
            uniforms = floats(task["uniforms"], 2)
            self.which = mi.Float(0) + dr.zeros(mi.Float, pairs.shape[1])
            self.uniforms = mi.Point2f(*uniforms)
            dr.eval(self.which, self.uniforms)
        dr.eval(self.si, self.wo)
        dr.sync_thread()

    def eval(self):
        return [self.bsdf.eval(self.context, self.si, self.wo)]

    def pdf(self):
        return [self.bsdf.pdf(self.context, self.si, self.wo)]

    def sample(self):
        drawn, weight = self.bsdf.sample(self.context, self.si, self.which, self.uniforms)
        return [drawn.wo, drawn.pdf, weight]

    def run(self):
        self.out = self.compute()
        self.dr.eval(self.out)
        self.dr.sync_thread()

    def values(self):
        parts = [np.atleast_2d(np.array(part)) for part in self.out]
        if len(parts) > 1:
            # In Mitsuba a sample below the surface keeps its direction and density; in lobe it has neither.
            (_, _, z), pdf, weight = parts
            leads = (z > 0) & np.any(weight != 0, axis=0)
            parts = [part * leads for part in parts]
        return np.concatenate([np.ravel(part, order="F") for part in parts])


class MitsubaArrays:
    """A BSDF of Mitsuba 3 from NumPy arrays to a NumPy array, as a program in Python has them."""

    def __init__(self, task):
        import drjit as dr
        import mitsuba as mi

        mi.set_variant("llvm_ad_rgb")
        dr.set_thread_count(1)
        self.dr, self.mi = dr, mi
        self.context = mi.BSDFContext()
        self.bsdf = mi.load_dict(task["bsdf"])
        self.wi, self.wo = directions(task)

    def run(self):
        si = self.dr.zeros(self.mi.SurfaceInteraction3f, len(self.wi))
        si.wi = self.mi.Vector3f(self.wi.T)
        self.out = np.array(self.bsdf.eval(self.context, si, self.mi.Vector3f(self.wo.T)))

    def values(self):
        return self.out.T / self.wo[:, 2:]


class Lobe:
    """A material of this library from NumPy arrays to a NumPy array."""

    def __init__(self, task):
        import lobe_bsdf

        self.material = lobe_bsdf.open(task["file"], backend=task["backend"])
        self.wi, self.wo = directions(task)
        self.given = np.zeros((len(self.wi), 3), "f4") if task["out"] else None

    def run(self):
        self.out = self.material.eval(self.wi, self.wo, out=self.given)

    def values(self):
        return self.out


def directions(task):
    """wi and wo, of shape (n, 3), in the memory layout of the task."""
    pairs = floats(task["pairs"], 6)
    columns = pairs[:3], pairs[3:]
    return [w.T if task["layout"] == "columns" else np.ascontiguousarray(w.T) for w in columns]


def mitsuba(task):
    return MitsubaArrays(task) if task["what"] == "arrays" else Mitsuba(task)


KINDS = {"scipy": Scipy, "interpn": Interpn, "mitsuba": mitsuba, "lobe-bsdf": Lobe}


def main():
    package, tasks = sys.argv[1], json.load(open(sys.argv[2]))
    if package == "mitsuba":
        # Without a usable LLVM this ends the process, so it comes before reporting that the peer is ready.
        import mitsuba as mi

        mi.set_variant("llvm_ad_rgb")
        str(mi.Float([1, 2]) + 1)
        choose_lanes("wide" in sys.argv[3:])
    # The first run compiles kernels, the second one finds them in the cache.
    serve(importlib.metadata.version(package), lambda name: KINDS[package](tasks[name]), warm_runs=2)


main()
