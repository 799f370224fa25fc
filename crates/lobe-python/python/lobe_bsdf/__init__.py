"""Measured BRDFs and BSDFs, evaluated in batches.

Directions are unit vectors away from the surface, whose normal is +z: ``wi`` points to the light, ``wo`` to the viewer.
Values are ``f`` in 1/sr, without the cosine, one per channel. Angles are in radians, wavelengths in nm.

>>> import lobe_bsdf
>>> material = lobe_bsdf.open("paint.ddr")  # doctest: +SKIP
>>> material.eval([0.6, 0.0, 0.8], [-0.6, 0.0, 0.8])  # doctest: +SKIP
"""

from ._errors import FormatError, GuessWarning, SceneError
from ._lobe import (
    Material,
    Picture,
    Sampler,
    backends,
    finished_parts,
    formats,
    from_bytes,
    from_samples,
    merge,
    normalize,
    open,
    render,
)
from ._results import Difference, Finding, FormatInfo, Resampling, Saved

__all__ = [
    "Difference",
    "Finding",
    "FormatError",
    "FormatInfo",
    "GuessWarning",
    "Material",
    "Picture",
    "Resampling",
    "Sampler",
    "Saved",
    "SceneError",
    "backends",
    "finished_parts",
    "formats",
    "from_bytes",
    "from_samples",
    "merge",
    "normalize",
    "open",
    "render",
]
