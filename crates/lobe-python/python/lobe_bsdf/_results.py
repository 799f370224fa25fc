"""What operations answer."""

from __future__ import annotations

from typing import NamedTuple

Vector = tuple[float, float, float]


class Finding(NamedTuple):
    """One thing that a check found."""

    status: str
    """"pass", "note", "warn" or "fail"."""
    check: str
    """The check that found it."""
    part: str
    """The part of the file; empty if there is only one."""
    text: str
    """The finding in words."""
    numbers: dict[str, float]
    """The numbers in it, by name."""


class Difference(NamedTuple):
    """How far the second material is from the first, over many pairs of directions, all channels together."""

    aspect: str
    """What was compared, such as "reflection front"."""
    channels: tuple[str, ...]
    """The channels that were compared: their own, or X, Y and Z."""
    pairs: int
    """The number of pairs of directions."""
    peak: float
    """The largest value of the first material among them, in 1/sr."""
    max: float
    """The largest difference, in 1/sr."""
    rms: float
    """The root of the mean squared difference, in 1/sr."""
    bias: float
    """The mean of the second less the first, in 1/sr."""
    relative_rms: float
    """``rms`` relative to the root of the mean squared value of the first."""
    worst: tuple[Vector, Vector]
    """``wi`` and ``wo`` of the largest difference, with z > 0."""
    delta_e: float | None
    """The mean CIE delta E 2000 of two spheres, one of each material; None if channels have no colour."""
    delta_e_max: float | None
    """Its largest value."""


class Resampling(NamedTuple):
    """How far a table is from the material that it was made from."""

    probes: int
    """The number of pairs of directions that were compared."""
    peak: float
    """The largest value of the material among them, in 1/sr."""
    max: float
    """The largest difference, in 1/sr."""
    rms: float
    """The root of the mean squared difference, in 1/sr."""
    relative_to_peak: float
    """``max`` relative to ``peak``."""
    relative_to_value: float
    """The largest difference relative to the value there, among values above a thousandth of the peak."""
    worst: tuple[Vector, Vector]
    """``wi`` and ``wo`` of the largest difference, with z > 0."""


class FormatInfo(NamedTuple):
    """A format of files."""

    word: str
    """The word for it, as in ``Material.save(path, format)``."""
    name: str
    """What it is called."""
    extensions: tuple[str, ...]
    """Extensions that its files have; they are never trusted."""
    is_read: bool
    """Whether files of it can be opened."""
    is_written: bool
    """Whether files of it can be written."""
