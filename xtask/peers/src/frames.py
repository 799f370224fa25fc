"""Renders frames with Mitsuba 3 on request: `python frames.py VARIANT TASKS [wide]`.

Answers as described in `serve.py`, with path-traced frames of scenes: `values` writes the linear RGB of two frames with
different random numbers, rows from the top.
"""

import importlib.metadata
import json
import os
import sys

# One core for all threads of Mitsuba, which counts cores when it is imported.
os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})

import drjit as dr
import mitsuba as mi
import numpy as np
from serve import choose_lanes, serve


class Frame:
    """A scene, ready to be rendered."""

    def __init__(self, task):
        self.samples = task["samples"]
        sky, camera = task["sky"], task["camera"]
        texels = np.fromfile(sky["file"], "<f4").reshape(sky["rows"], sky["columns"], 3)
        view = mi.ScalarTransform4f().look_at(camera["position"], camera["target"], camera["up"])
        width, height = task["size"]
        scene = {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": task["max_depth"], "rr_depth": task["rr_depth"]},
            "sky": {"type": "envmap", "bitmap": mi.Bitmap(texels)},
            "sensor": {
                "type": "perspective",
                "fov_axis": "y",
                "fov": camera["degrees"],
                "to_world": view,
                "sampler": {"type": "independent", "sample_count": self.samples},
                "film": {
                    "type": "hdrfilm",
                    "width": width,
                    "height": height,
                    "pixel_format": "rgb",
                    "component_format": "float32",
                    "rfilter": {"type": "box"},
                },
            },
        }
        for number, surface in enumerate(task["surfaces"]):
            scene[f"surface{number}"] = surface | {"id": f"surface{number}"}
        for number, mesh in enumerate(task["meshes"]):
            shape = {
                "type": "ply",
                "filename": mesh["filename"],
                "bsdf": {"type": "ref", "id": f"surface{mesh['surface']}"},
            }
            if mesh["radiance"]:
                shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": mesh["radiance"]}}
            scene[f"mesh{number}"] = shape
        self.scene = mi.load_dict(scene)
        self.seed = 0

    def run(self):
        self.seed += 1
        self.image = mi.render(self.scene, spp=self.samples, seed=self.seed)
        dr.eval(self.image)
        dr.sync_thread()

    def values(self):
        frames = []
        for _ in range(2):
            self.run()
            frames.append(np.array(self.image, "<f4"))
        return np.stack(frames)


def main():
    variant, tasks = sys.argv[1], json.load(open(sys.argv[2]))
    mi.set_variant(variant)
    # Negative measured values come from the files; warnings about them must not be printed among the answers.
    mi.set_log_level(mi.LogLevel.Error)
    # Without a usable LLVM this ends the process, so it comes before reporting that the peer is ready.
    str(mi.Float(1) + 1)
    if variant.startswith("llvm"):
        choose_lanes("wide" in sys.argv[3:])
    # The first run compiles kernels.
    serve(importlib.metadata.version("mitsuba"), lambda name: Frame(tasks[name]), warm_runs=1)


main()
