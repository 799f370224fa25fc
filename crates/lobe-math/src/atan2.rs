//! The angle of a vector in the plane.

use core::f32::consts::{FRAC_PI_2, PI, TAU};

use lobe_lane::{Floats, Lanes};

use crate::poly::horner;

/// `atan t = t + t^3 A(t^2)` on `[0, 1]`: minimax for the relative error, 1.1e-7.
const ODD_TERMS: [f32; 7] =
    [-0.333_323_93, 0.199_742_14, -0.140_413_28, 0.099_684_73, -0.060_203_13, 0.024_734_063, -0.004_822_534];

/// The angle of `(x, y)` from the positive x axis, in `[0, 2 pi]` (the upper end only by rounding); 0 where both are 0.
///
/// Largest error: [`bounds::AZIMUTH`](crate::bounds::AZIMUTH), for finite arguments of which one is a normal number.
#[inline(always)]
pub fn azimuth<L: Lanes>(lanes: L, y: L::F, x: L::F) -> L::F {
    let half_turn = upper_half(lanes, y.abs(), x);
    lanes.select(y.lt(lanes.splat(0.0)), lanes.splat(TAU) - half_turn, half_turn)
}

/// The angle of `(x, y)` from the positive x axis, in `[-pi, pi]`, with the sign of `y`; 0 where both are 0.
///
/// Largest error: [`bounds::ATAN2`](crate::bounds::ATAN2), for finite arguments of which one is a normal number.
#[inline(always)]
pub fn atan2<L: Lanes>(lanes: L, y: L::F, x: L::F) -> L::F {
    upper_half(lanes, y.abs(), x).mul_sign(y)
}

/// The angle in `[0, pi]` for `y >= 0`.
#[inline(always)]
fn upper_half<L: Lanes>(lanes: L, y: L::F, x: L::F) -> L::F {
    let across = x.abs();
    let steep = across.lt(y);
    let longer = lanes.splat(f32::MIN_POSITIVE).max(across.max(y));
    let t = across.min(y) / longer;
    let square = t * t;
    let octant = lanes.mul_add(t * square, horner(lanes, square, ODD_TERMS), t);
    let quadrant = lanes.select(steep, lanes.splat(FRAC_PI_2) - octant, octant);
    lanes.select(x.lt(lanes.splat(0.0)), lanes.splat(PI) - quadrant, quadrant)
}
