"""The native module."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._results import Difference, Finding, FormatInfo, Resampling, Saved

Path = str | PathLike[str]
Floats = NDArray[np.float32]
Doubles = NDArray[np.float64]
Integers = NDArray[np.uint32]
Edges = Literal["clamp", "extrapolate", "zero"]
Lookup = Literal["nearest", "linear"]
Given = Literal["light", "viewer"]
Decode = Literal["raw", "srgb"]
Scatter = Literal["reflection", "transmission"]
Side = Literal["front", "back"]

class Material:
    @property
    def channels(self) -> tuple[str, ...]: ...
    @property
    def wavelengths(self) -> Doubles | None: ...
    @property
    def kind(self) -> str: ...
    @property
    def format(self) -> str | None: ...
    @property
    def facts(self) -> tuple[tuple[str, str], ...]: ...
    @property
    def notes(self) -> tuple[str, ...]: ...
    @property
    def aspects(self) -> tuple[str, ...]: ...
    @property
    def is_isotropic(self) -> bool: ...
    @property
    def backend(self) -> str: ...
    @property
    def strict(self) -> bool: ...
    @property
    def nbytes(self) -> int: ...
    @property
    def resampling(self) -> Resampling | None: ...
    def arrays(self) -> dict[str, Any]: ...
    def eval(self, wi: ArrayLike, wo: ArrayLike, *, out: Floats | None = None) -> Floats: ...
    @overload
    def mueller(self, wi: ArrayLike, wo: ArrayLike, wavelength: None = None, *, out: Floats | None = None) -> Floats: ...
    @overload
    def mueller(self, wi: ArrayLike, wo: ArrayLike, wavelength: float) -> Doubles: ...
    def sampler(self, *, defensive: float = 0.05, luminance: Sequence[float] | None = None) -> Sampler: ...
    def incidences(self, *, scatter: Scatter | None = None, side: Side | None = None) -> Doubles: ...
    @overload
    def albedo(
        self,
        theta: ArrayLike,
        phi: ArrayLike | None = None,
        *,
        scatter: Scatter | None = None,
        side: Side | None = None,
        tolerance: float = 1e-4,
        errors: Literal[False] = False,
    ) -> Doubles: ...
    @overload
    def albedo(
        self,
        theta: ArrayLike,
        phi: ArrayLike | None = None,
        *,
        scatter: Scatter | None = None,
        side: Side | None = None,
        tolerance: float = 1e-4,
        errors: Literal[True],
    ) -> tuple[Doubles, Doubles]: ...
    def check(self) -> list[Finding]: ...
    def compare(
        self,
        other: Material,
        *,
        scatter: Scatter | None = None,
        side: Side | None = None,
        pairs: int = 100_000,
        limit: float = ...,
    ) -> Difference: ...
    def resample(
        self,
        error: float | None = None,
        *,
        sigma: Sequence[float] | Doubles | None = None,
        psi: Sequence[float] | Doubles | None = None,
        theta: Sequence[float] | Doubles | None = None,
        phi: Sequence[float] | Doubles | None = None,
        per_value: bool = False,
        limit: float = ...,
        scatter: Scatter | None = None,
        side: Side | None = None,
    ) -> Material: ...
    def save(
        self,
        path: Path,
        format: str | None = None,
        *,
        channel: str | None = None,
        resample: bool = False,
        error: float | None = None,
        scatter: Scatter | None = None,
    ) -> Saved: ...

class Sampler:
    @property
    def material(self) -> Material: ...
    @property
    def nbytes(self) -> int: ...
    def sample(self, w: ArrayLike, u: ArrayLike, *, given: Given = "light") -> tuple[Floats, Floats, Floats]: ...
    def pdf(self, wi: ArrayLike, wo: ArrayLike, *, given: Given = "light") -> Floats: ...

class Picture:
    @property
    def color(self) -> Floats: ...
    @property
    def albedo(self) -> Floats: ...
    @property
    def normal(self) -> Floats: ...
    @property
    def depth(self) -> Floats: ...
    @property
    def material(self) -> Integers: ...
    @property
    def samples(self) -> Integers: ...
    @property
    def window(self) -> tuple[int, int, int, int]: ...
    @property
    def size(self) -> tuple[int, int]: ...
    @property
    def is_finished(self) -> bool: ...
    def save(self, path: Path, *, partial: bool = False, exposure: float | None = None) -> None: ...

def open(
    path: Path,
    *,
    backend: str | None = None,
    strict: bool = False,
    edges: Edges = "clamp",
    lookup: Lookup = "nearest",
    indexed_by: Given = "light",
    decode: Decode = "raw",
    columns: str | None = None,
    unit: str | None = None,
    values: str | None = None,
    scale: float | str | None = None,
    holds: str | None = None,
    in_plane: str | None = None,
    azimuth_from: str | None = None,
    decimal_comma: bool | None = None,
) -> Material: ...
def from_bytes(
    data: bytes | bytearray | memoryview,
    name: Path = "memory",
    *,
    backend: str | None = None,
    strict: bool = False,
    edges: Edges = "clamp",
    lookup: Lookup = "nearest",
    indexed_by: Given = "light",
    decode: Decode = "raw",
    columns: str | None = None,
    unit: str | None = None,
    values: str | None = None,
    scale: float | str | None = None,
    holds: str | None = None,
    in_plane: str | None = None,
    azimuth_from: str | None = None,
    decimal_comma: bool | None = None,
) -> Material: ...
def from_samples(
    values: ArrayLike,
    *,
    sigma: ArrayLike | None = None,
    psi: ArrayLike | None = None,
    theta: ArrayLike | None = None,
    phi: ArrayLike | None = None,
    theta_i: ArrayLike | None = None,
    phi_i: ArrayLike | None = None,
    theta_o: ArrayLike | None = None,
    phi_o: ArrayLike | None = None,
    channels: str | Sequence[str] | None = None,
    wavelengths: Sequence[float] | Doubles | None = None,
    scatter: Scatter = "reflection",
    refraction: Sequence[float] | Doubles | None = None,
    degrees: bool = False,
    facts: Sequence[tuple[str, str]] = (),
    backend: str | None = None,
    strict: bool = False,
    edges: Edges = "clamp",
    lookup: Lookup = "nearest",
    indexed_by: Given = "light",
    decode: Decode = "raw",
) -> Material: ...
def normalize(v: ArrayLike) -> Floats: ...
def backends() -> list[str]: ...
def formats() -> list[FormatInfo]: ...
def render(
    scene: Path,
    *,
    samples: int | None = None,
    crop: tuple[int, int, int, int] | None = None,
    integrator: str | None = None,
    time: float | None = None,
    tile: tuple[int, int] | None = None,
    samples_range: tuple[int, int] | None = None,
    threads: int | None = None,
    backend: str | None = None,
    strict: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> Picture: ...
def merge(parts: Sequence[Path], *, allow_gaps: bool = False) -> Picture: ...
def finished_parts(
    paths: Sequence[Path],
    scene: Path,
    *,
    samples: int | None = None,
    integrator: str | None = None,
    backend: str | None = None,
    strict: bool = False,
) -> list[bool]: ...
