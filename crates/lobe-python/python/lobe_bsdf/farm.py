"""Renders a picture on the machines of a Ray cluster: ``python -m lobe_bsdf.farm SCENE -o OUT --parts N``.

Each part is a task. A part that fails, or whose machine dies, is rendered again; existing parts in the folder OUT.parts are
kept. The parts are then merged into the picture. It has the same bits as if it had been rendered in one go, if the machines
have the same instruction set, or with ``--strict`` on any machines. All machines must have access to the scene and have this
package.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import sys
import tempfile
import time
from typing import Any

import lobe_bsdf

RETRIES = 5
"""The number of times that a part is rendered again if it fails."""


def rendered(scene: str, part: int, parts: int, options: dict[str, Any]) -> bytes:
    """The task: renders a part and returns its file, with exact sums."""
    picture = lobe_bsdf.render(scene, tile=(part, parts), **options)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "part.exr")
        picture.save(file, partial=True)
        return file.read_bytes()


def write_whole(file: pathlib.Path, content: bytes) -> None:
    """Writes a file completely or not at all."""
    unfinished = file.with_name(file.name + ".tmp")
    unfinished.write_bytes(content)
    unfinished.replace(file)


def render(
    scene: str | os.PathLike[str],
    output: str | os.PathLike[str],
    parts: int,
    *,
    address: str | None = None,
    cpus: int = 1,
    quiet: bool = False,
    **options: Any,
) -> None:
    """Renders a scene into a picture, .exr or .png, in the given number of parts.

    ``address`` is the address of a cluster; without it, the cluster named by the variable RAY_ADDRESS is used, or else one is
    started on this machine. ``cpus`` is the number of processors of a task, and so of its threads. The other options are those
    of lobe_bsdf.render(): samples, integrator, backend, strict.
    """
    import ray

    output = pathlib.Path(output)
    if output.suffix.lower() not in (".exr", ".png"):
        raise ValueError(f"{output}: expected a name that ends in .exr or .png")
    scene = os.path.abspath(scene)
    folder = output.with_name(output.name + ".parts")
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / f"part-{part}-of-{parts}.exr" for part in range(1, parts + 1)]
    # This reads the scene, so mistakes in it are found before any machine starts.
    finished = lobe_bsdf.finished_parts(files, scene, **options)
    missing = [part for part in range(1, parts + 1) if not finished[part - 1]]

    def say(text: str) -> None:
        if not quiet:
            print(text, file=sys.stderr, flush=True)

    say(f"{parts - len(missing)} of {parts} parts exist already")
    if missing:
        started_here = not ray.is_initialized()
        if started_here:
            ray.init(address=address, log_to_driver=False)
        try:
            # A machine that dies does not count as a failure of the part.
            task = ray.remote(num_cpus=cpus, max_retries=RETRIES, retry_exceptions=True)(rendered)
            begun = time.monotonic()
            waiting = {task.remote(scene, part, parts, {"threads": cpus, **options}): part for part in missing}
            done = 0
            while waiting:
                ready, _ = ray.wait(list(waiting), num_returns=1)
                part = waiting.pop(ready[0])
                write_whole(files[part - 1], ray.get(ready[0]))
                done += 1
                left = (time.monotonic() - begun) / done * len(waiting)
                say(f"{parts - len(waiting)} of {parts} parts, {left:.0f} s left")
        finally:
            if started_here:
                ray.shutdown()
    # Refuses missing and duplicate samples.
    lobe_bsdf.merge(files).save(output)
    say(f"{output}: merged")


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m lobe_bsdf.farm",
        description="Render a scene on the machines of a Ray cluster.",
        epilog="Example: python -m lobe_bsdf.farm scene.toml -o picture.exr --parts 16 --address auto",
    )
    parser.add_argument("scene", help="the scene, a TOML file to which all machines have access")
    parser.add_argument("-o", "--output", required=True, help="the picture, .exr or .png")
    parser.add_argument("--parts", type=int, required=True, help="number of parts, which are strips of rows")
    parser.add_argument("--address", help="the cluster, such as auto or ray://host:10001; by default one on this machine")
    parser.add_argument("--cpus", type=int, default=1, help="processors per part (default: 1)")
    parser.add_argument("--samples", type=int, help="samples per pixel, instead of those in the scene")
    parser.add_argument("--integrator", help="the integrator, instead of the one in the scene")
    parser.add_argument("--backend", help="the instruction set, which all machines must have")
    parser.add_argument("--strict", action="store_true", help="get the same bits on machines with different instruction sets")
    parser.add_argument("--quiet", action="store_true", help="show no progress")
    asked = parser.parse_args(arguments)
    if asked.parts < 1 or asked.cpus < 1:
        parser.error("--parts and --cpus: expected at least 1")
    options = {name: getattr(asked, name) for name in ("samples", "integrator", "backend", "strict")}
    try:
        render(
            asked.scene, asked.output, asked.parts, address=asked.address, cpus=asked.cpus, quiet=asked.quiet, **options
        )
    except ImportError as error:
        print(f"error: {error}; pip install 'lobe-bsdf[ray]'", file=sys.stderr)
        return 2
    except (OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
