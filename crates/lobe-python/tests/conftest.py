"""Shared by the tests: files of the repository, measured files that are not part of it, and the program."""

from __future__ import annotations

import os
import pathlib
import shutil

import numpy as np
import pytest

import lobe_bsdf

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
SHARED = pathlib.Path(os.environ.get("LOBE_SHARED", REPOSITORY.parent / "shared"))


@pytest.fixture(scope="session")
def fixtures() -> pathlib.Path:
    return REPOSITORY / "fixtures"


@pytest.fixture(scope="session")
def conductor(fixtures):
    return lobe_bsdf.open(fixtures / "conductor-7x8x13.ddr")


@pytest.fixture(scope="session")
def cloth(fixtures):
    return lobe_bsdf.open(fixtures / "cloth-17x7x17x13.ddr")


@pytest.fixture(scope="session")
def shared():
    def find(name: str) -> pathlib.Path:
        path = SHARED / name
        if not path.exists():
            pytest.skip(f"{path} is missing; set LOBE_SHARED to the folder with `golden` and `data`")
        return path

    return find


@pytest.fixture(scope="session")
def program() -> str:
    """The program `lobe`: the one named by LOBE_PROGRAM, or a build of it."""
    builds = [REPOSITORY / "target" / profile / "lobe" for profile in ("release", "debug")]
    builds = sorted((build for build in builds if build.exists()), key=lambda build: -build.stat().st_mtime)
    found = os.environ.get("LOBE_PROGRAM") or (str(builds[0]) if builds else shutil.which("lobe"))
    if not found:
        pytest.skip("the program lobe is missing; build it, or set LOBE_PROGRAM")
    return found


def directions(count: int, seed: int = 0, up: bool = True) -> np.ndarray:
    """Unit vectors, distributed evenly over the sphere or over its upper half."""
    v = np.random.default_rng(seed).normal(size=(count, 3))
    if up:
        v[:, 2] = np.abs(v[:, 2]) + 1e-3
    return lobe_bsdf.normalize(v)
