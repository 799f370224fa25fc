//! From directions of any length to unit vectors, and to the angles of spherical coordinates.

use lobe_lane::{Floats, Lanes};

/// Vectors shorter than this have no direction, because their squares lose digits.
const SHORTEST: f32 = 1e-15;
/// Vectors longer than this have no direction, because their squares overflow.
const LONGEST: f32 = 1e15;

/// Closer to the normal than this sine, the azimuth is 0, because the squares of the components lose digits.
pub(crate) const POLE: f32 = 1e-15;

/// The squared distance of two unit vectors is at most 4, and the squared length of one is 1; a much larger sum, or
/// NaN, means that a component is not finite. The length of `wi` is included because a computed zenith may hide it.
pub(crate) const FARTHEST: f32 = 16.0;

/// The largest error of the angles of [`spherical`], in radians: from rounding a unit vector, and from
/// [`lobe_math::bounds`].
pub(crate) const SPHERICAL: f64 = 1.2e-6;

/// The unit vectors along `x`, `y`, `z`, and the lanes that have one: those whose vectors are finite and have a length.
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

/// The length of the projection of a vector onto the surface.
#[inline(always)]
pub(crate) fn across<L: Lanes>(lanes: L, x: L::F, y: L::F) -> L::F {
    lanes.mul_add(x, x, y * y).sqrt()
}

/// The polar angle of a unit vector above the horizon.
///
/// It is computed from the tangent of its half, so that it does not lose digits near the pole; so is [`azimuth`].
#[inline(always)]
pub(crate) fn polar<L: Lanes>(lanes: L, across: L::F, z: L::F) -> L::F {
    lobe_math::double_atan(lanes, across / (lanes.splat(1.0) + z))
}

/// The azimuth of `x` and `y` in `[0, 2 pi]`, 0 if both are 0; `across` is the length of the vector that they form.
#[inline(always)]
pub(crate) fn azimuth<L: Lanes>(lanes: L, x: L::F, y: L::F, across: L::F) -> L::F {
    let span = lanes.splat(f32::MIN_POSITIVE).max(across + x.abs());
    lobe_math::azimuth_from(lanes, y / span, x)
}
