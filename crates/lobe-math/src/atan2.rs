//! The angle of a vector in the plane.

use core::f32::consts::{PI, TAU};

use lobe_lane::{Floats, Lanes};

use crate::poly::horner;

/// `atan t = t + t^3 A(t^2)` on `[0, 1]`: minimax for the relative error, 1.7e-8.
const ODD_TERMS: [f32; 8] = [
    -0.333_331_53,
    0.199_937_73,
    -0.142_110_56,
    0.106_660_046,
    -0.075_522_15,
    0.043_211_862,
    -0.016_367_93,
    0.002_920_692_6,
];

/// Twice the arc tangent of `t` in `[-1, 1]`: the angle, in `[-pi/2, pi/2]`, whose half has the tangent `t`.
///
/// The tangent of half an angle is `sin / (1 + cos)`: one division, no root, and no octants to distinguish. It keeps
/// the digits of small angles, which an arc cosine loses.
///
/// Largest error: [`bounds::DOUBLE_ATAN`](crate::bounds::DOUBLE_ATAN).
#[inline(always)]
pub fn double_atan<L: Lanes>(lanes: L, t: L::F) -> L::F {
    let square = t * t;
    let half = lanes.mul_add(t * square, horner(lanes, square, ODD_TERMS), t);
    half + half
}

/// The polar angle, in `[0, pi]`, of a direction whose cosine is `cos` and whose `t` is `sin / (1 + |cos|)`. Only the
/// sign of `cos` matters.
#[inline(always)]
pub fn polar_from<L: Lanes>(lanes: L, t: L::F, cos: L::F) -> L::F {
    let angle = double_atan(lanes, t);
    lanes.select(cos.lt(lanes.splat(0.0)), lanes.splat(PI) - angle, angle)
}

/// The azimuth, in `[0, 2 pi]` (the upper end only by rounding), of a vector `(x, y)` whose `t` is
/// `y / (length + |x|)`. Only the sign of `x` matters.
#[inline(always)]
pub fn azimuth_from<L: Lanes>(lanes: L, t: L::F, x: L::F) -> L::F {
    let angle = half_plane(lanes, t, x);
    angle + lanes.splat(TAU).masked(angle.lt(lanes.splat(0.0)))
}

/// The angle of `(x, y)` from the positive x axis, in `[0, 2 pi]` (the upper end only by rounding); 0 if both are 0.
///
/// Largest error: [`bounds::AZIMUTH`](crate::bounds::AZIMUTH), for vectors of lengths from 1e-18 to 1e18.
#[inline(always)]
pub fn azimuth<L: Lanes>(lanes: L, y: L::F, x: L::F) -> L::F {
    azimuth_from(lanes, half_tangent(lanes, y, x), x)
}

/// The angle of `(x, y)` from the positive x axis, in `[-pi, pi]`, with the sign of `y`; 0 if both are 0.
///
/// Largest error: [`bounds::ATAN2`](crate::bounds::ATAN2), for vectors of lengths from 1e-18 to 1e18.
#[inline(always)]
pub fn atan2<L: Lanes>(lanes: L, y: L::F, x: L::F) -> L::F {
    half_plane(lanes, half_tangent(lanes, y, x), x)
}

/// `y / (length + |x|)`: the tangent of half the angle to the nearer end of the x axis.
#[inline(always)]
fn half_tangent<L: Lanes>(lanes: L, y: L::F, x: L::F) -> L::F {
    let length = lanes.mul_add(x, x, y * y).sqrt();
    y / lanes.splat(f32::MIN_POSITIVE).max(length + x.abs())
}

/// The signed angle in `[-pi, pi]`.
#[inline(always)]
fn half_plane<L: Lanes>(lanes: L, t: L::F, x: L::F) -> L::F {
    let angle = double_atan(lanes, t);
    let beyond = lanes.splat(PI).mul_sign(t) - angle;
    lanes.select(x.lt(lanes.splat(0.0)), beyond, angle)
}
