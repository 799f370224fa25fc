//! Directions of any length to unit vectors, and to the angles of spherical coordinates.

use lobe_lane::{Floats, Lanes};

/// Vectors shorter than this point nowhere; squares of shorter ones lose their digits.
const SHORTEST: f32 = 1e-15;
/// Vectors longer than this point nowhere; squares of longer ones overflow.
const LONGEST: f32 = 1e15;

/// Closer to the normal than this sine, an azimuth is 0: the squares of shorter components lose their digits.
pub(crate) const POLE: f32 = 1e-15;

/// The squared distance of two unit vectors is at most 4, and the squared length of one is 1; a much larger sum, or NaN,
/// means that a component is not finite. The length of `wi` counts because a zenith that is computed may hide it.
pub(crate) const FARTHEST: f32 = 16.0;

/// What the angles of [`spherical`] may be off, in radians, from those of the direction in exact arithmetic: what is
/// left of the roundings of a unit vector, and [`lobe_math::bounds`].
pub(crate) const SPHERICAL: f64 = 1.2e-6;

/// The unit vectors along `x`, `y`, `z`, and the lanes that have one: not those that are not finite or have no length.
#[inline(always)]
pub(crate) fn unit<L: Lanes>(lanes: L, [x, y, z]: [L::F; 3]) -> ([L::F; 3], L::M) {
    let length2 = lanes.mul_add(x, x, lanes.mul_add(y, y, z * z));
    let points = lanes.splat(SHORTEST * SHORTEST).lt(length2) & length2.lt(lanes.splat(LONGEST * LONGEST));
    let scale = lanes.splat(1.0) / length2.sqrt();
    ([x * scale, y * scale, z * scale], points)
}

/// The polar angle of a unit vector above the horizon, and its azimuth in `[0, 2 pi]`, 0 at the pole.
#[inline(always)]
pub(crate) fn spherical<L: Lanes>(lanes: L, [x, y, z]: [L::F; 3]) -> [L::F; 2] {
    let across = across(lanes, x, y);
    [polar(lanes, across, z), azimuth(lanes, x, y, across)]
}

/// How long the projection of a vector on the surface is.
#[inline(always)]
pub(crate) fn across<L: Lanes>(lanes: L, x: L::F, y: L::F) -> L::F {
    lanes.mul_add(x, x, y * y).sqrt()
}

/// The polar angle of a unit vector above the horizon.
///
/// It comes from the tangent of its half, so that it does not lose its digits near the pole; and so does [`azimuth`].
#[inline(always)]
pub(crate) fn polar<L: Lanes>(lanes: L, across: L::F, z: L::F) -> L::F {
    lobe_math::double_atan(lanes, across / (lanes.splat(1.0) + z))
}

/// The azimuth of `x` and `y` in `[0, 2 pi]`, 0 if they are; `across` is their length.
#[inline(always)]
pub(crate) fn azimuth<L: Lanes>(lanes: L, x: L::F, y: L::F, across: L::F) -> L::F {
    let span = lanes.splat(f32::MIN_POSITIVE).max(across + x.abs());
    lobe_math::azimuth_from(lanes, y / span, x)
}
