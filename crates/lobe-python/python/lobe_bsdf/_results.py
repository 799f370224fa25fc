"""Results of operations."""

from __future__ import annotations

from typing import NamedTuple

Vector = tuple[float, float, float]


class Finding(NamedTuple):
    """A finding of a check."""

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
    """The difference of the second material from the first, over many pairs of directions, all channels together."""

    aspect: str
    """What was compared, such as "reflection front"."""
    channels: tuple[str, ...]
    """The channels that were compared: their own, or X, Y and Z."""
    pairs: int
    """The number of pairs of directions."""
    peak: float
    """The largest value of the first material at these pairs, in 1/sr."""
    max: float
    """The largest difference, in 1/sr."""
    rms: float
    """The root mean square of the difference, in 1/sr."""
    bias: float
    """The mean of the second minus the first, in 1/sr."""
    relative_rms: float
    """``rms`` relative to the root mean square of the first material."""
    worst: tuple[Vector, Vector]
    """``wi`` and ``wo`` of the largest difference, with z > 0."""
    delta_e: float | None
    """The mean CIE delta E 2000 of two spheres, one of each material; None if channels have no colour."""
    delta_e_max: float | None
    """Its largest value."""


class Resampling(NamedTuple):
    """The difference between a table and the material from which it was resampled."""

    probes: int
    """The number of pairs of directions that were compared."""
    peak: float
    """The largest value of the material at these pairs, in 1/sr."""
    max: float
    """The largest difference, in 1/sr."""
    rms: float
    """The root mean square of the difference, in 1/sr."""
    relative_to_peak: float
    """``max`` relative to ``peak``."""
    relative_to_value: float
    """The largest difference relative to the value there, among values above a thousandth of the peak."""
    worst: tuple[Vector, Vector]
    """``wi`` and ``wo`` of the largest difference, with z > 0."""


class Saved(NamedTuple):
    """A file that was written, and its error: how much it differs from the material.

    If there are several measurements, the numbers are the largest of them.
    """

    format: str
    """The short name of its format."""
    exact: bool
    """True if values and nodes were written unchanged, and the file is interpolated as the material is."""
    nodes: str | None
    """The nodes at which the material was resampled, in words; None if they are its own."""
    note: str | None
    """How channels were changed; None if they were not."""
    max: float | None
    """The largest difference, in 1/sr: 0 if ``exact``, None if it is not known."""
    rms: float | None
    """The root mean square of the difference, in 1/sr."""
    relative_rms: float | None
    """``rms`` relative to the root mean square of the material."""
    errors: tuple[str, ...]
    """The error in words, one line per measurement."""
    unknown: str | None
    """Why the error is not known; None if it is."""


class FormatInfo(NamedTuple):
    """A file format."""

    word: str
    """Its short name, as in ``Material.save(path, format)``."""
    name: str
    """Its full name."""
    extensions: tuple[str, ...]
    """The extensions of its files; they are never trusted."""
    is_read: bool
    """True if its files can be opened."""
    is_written: bool
    """True if its files can be written."""
