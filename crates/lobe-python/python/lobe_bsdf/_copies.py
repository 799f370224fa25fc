"""Functions that read pickles. Their names must not change."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

from . import _lobe
from ._errors import GuessWarning


def remade(function: str, keywords: dict[str, Any]) -> _lobe.Material:
    """A material from its content."""
    functions: dict[str, Callable[..., _lobe.Material]] = {
        "from_bytes": _lobe.from_bytes,
        "from_samples": _lobe.from_samples,
    }
    make = functions[function]
    with warnings.catch_warnings():
        # The warning was given when the original was opened.
        warnings.simplefilter("ignore", GuessWarning)
        return make(**keywords)


def sampler_of(material: _lobe.Material, defensive: float, luminance: Sequence[float] | None) -> _lobe.Sampler:
    """A sampler from its material."""
    return material.sampler(defensive=defensive, luminance=luminance)
