//! Directions of any length to unit vectors, and to the angles of spherical coordinates.

use lobe_lane::{Floats, Lanes};

/// Vectors shorter than this point nowhere; squares of shorter ones lose their digits.
const SHORTEST: f32 = 1e-15;
/// Vectors longer than this point nowhere; squares of longer ones overflow.
const LONGEST: f32 = 1e15;

/// What the angles of [`spherical`] may be off, in radians, from those of the direction in exact arithmetic: what is left of
/// the roundings of a unit vector, and [`lobe_math::bounds`].
pub(crate) const SPHERICAL: f64 = 1.2e-6;

/// The unit vectors along `x`, `y`, `z`, and where there are such: not in lanes that are not finite or have no length.
#[inline(always)]
pub(crate) fn unit<L: Lanes>(lanes: L, [x, y, z]: [L::F; 3]) -> ([L::F; 3], L::M) {
    let length2 = lanes.mul_add(x, x, lanes.mul_add(y, y, z * z));
    let points = lanes.splat(SHORTEST * SHORTEST).lt(length2) & length2.lt(lanes.splat(LONGEST * LONGEST));
    let scale = lanes.splat(1.0) / length2.sqrt();
    ([x * scale, y * scale, z * scale], points)
}

/// The polar angle of a unit vector above the horizon, and its azimuth in `[0, 2 pi]`, 0 at the pole.
///
/// Both come from the tangent of their half, so that neither loses its digits near the pole.
#[inline(always)]
pub(crate) fn spherical<L: Lanes>(lanes: L, [x, y, z]: [L::F; 3]) -> [L::F; 2] {
    let across = lanes.mul_add(x, x, y * y).sqrt();
    let theta = lobe_math::double_atan(lanes, across / (lanes.splat(1.0) + z));
    let span = lanes.splat(f32::MIN_POSITIVE).max(across + x.abs());
    [theta, lobe_math::azimuth_from(lanes, y / span, x)]
}
