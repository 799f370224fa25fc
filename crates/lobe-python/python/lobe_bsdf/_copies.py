"""How pickles are read. What is named here must stay."""

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
        # That was said when the original was made.
        warnings.simplefilter("ignore", GuessWarning)
        return make(**keywords)


def sampler_of(material: _lobe.Material, defensive: float, luminance: Sequence[float] | None) -> _lobe.Sampler:
    """A sampler from its material."""
    return material.sampler(defensive=defensive, luminance=luminance)
