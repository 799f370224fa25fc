//! The paper's own form: four terms, kept to reproduce its tables and its error curve.

use core::f32::consts::FRAC_PI_2;

use lobe_lane::{Floats, Lanes};

use crate::poly::horner;

/// Abramowitz and Stegun 4.4.45 with pi/2 in place of its first coefficient, as the paper prints it (section 2.1), so
/// that `asin 0` is exactly 0.
const FOUR_TERMS: [f32; 4] = [FRAC_PI_2, -0.212_114_4, 0.074_261, -0.018_729_3];

/// Arc sine in `[-pi/2, pi/2]` of `x` in `[-1, 1]`: `pi/2 - sqrt(1 - x) (pi/2 + a1 x + a2 x^2 + a3 x^3)` for `x >= 0`,
/// odd below.
///
/// Largest error: [`bounds::PAPER_ACOS`](crate::bounds::PAPER_ACOS).
#[inline(always)]
pub fn asin<L: Lanes>(lanes: L, x: L::F) -> L::F {
    let size = x.abs();
    let rest = lanes.splat(1.0) - size;
    (lanes.splat(FRAC_PI_2) - rest.sqrt() * horner(lanes, size, FOUR_TERMS)).mul_sign(x)
}

/// Arc cosine in `[0, pi]` of `x` in `[-1, 1]`: `pi/2 - asin x`.
///
/// Largest error: [`bounds::PAPER_ACOS`](crate::bounds::PAPER_ACOS).
#[inline(always)]
pub fn acos<L: Lanes>(lanes: L, x: L::F) -> L::F {
    lanes.splat(FRAC_PI_2) - asin(lanes, x)
}
