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

/// The angle of `(x, y)` from the positive x axis, in `[0, 2 pi]` (the upper end only by rounding); 0 where both are 0.
///
/// Largest error: [`bounds::AZIMUTH`](crate::bounds::AZIMUTH), for vectors of lengths from 1e-18 to 1e18.
#[inline(always)]
pub fn azimuth<L: Lanes>(lanes: L, y: L::F, x: L::F) -> L::F {
    azimuth_from(lanes, y, x, lanes.mul_add(x, x, y * y).sqrt())
}

/// [`azimuth`] of a vector whose length is known.
#[inline(always)]
pub fn azimuth_from<L: Lanes>(lanes: L, y: L::F, x: L::F, length: L::F) -> L::F {
    let angle = half_plane(lanes, y, x, length);
    angle + lanes.splat(TAU).masked(angle.lt(lanes.splat(0.0)))
}

/// The angle of `(x, y)` from the positive x axis, in `[-pi, pi]`, with the sign of `y`; 0 where both are 0.
///
/// Largest error: [`bounds::ATAN2`](crate::bounds::ATAN2), for vectors of lengths from 1e-18 to 1e18.
#[inline(always)]
pub fn atan2<L: Lanes>(lanes: L, y: L::F, x: L::F) -> L::F {
    half_plane(lanes, y, x, lanes.mul_add(x, x, y * y).sqrt())
}

/// The signed angle in `[-pi, pi]`.
///
/// Half the angle to the nearer end of the x axis has the tangent `y / (length + |x|)`, which is within `[-1, 1]`: no
/// octants to tell apart.
#[inline(always)]
fn half_plane<L: Lanes>(lanes: L, y: L::F, x: L::F, length: L::F) -> L::F {
    let t = y / lanes.splat(f32::MIN_POSITIVE).max(length + x.abs());
    let square = t * t;
    let half = lanes.mul_add(t * square, horner(lanes, square, ODD_TERMS), t);
    let angle = half + half;
    let beyond = lanes.splat(PI).mul_sign(y) - angle;
    lanes.select(x.lt(lanes.splat(0.0)), beyond, angle)
}
