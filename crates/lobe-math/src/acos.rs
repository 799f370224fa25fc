//! The default arc cosine and arc sine: eight terms.

use core::f32::consts::{FRAC_PI_2, PI};

use lobe_lane::{Floats, Lanes};

use crate::poly::horner;

/// Abramowitz and Stegun 4.4.46: `acos x = sqrt(1 - x) P(x)` on `[0, 1]`, within 2e-8 in exact arithmetic. Its first
/// coefficient, 1.5707963050, is between two floats; the upper one makes `acos 0` the float nearest to pi/2.
const EIGHT_TERMS: [f32; 8] = [
    FRAC_PI_2,
    -0.214_598_8,
    0.088_978_99,
    -0.050_174_303,
    0.030_891_88,
    -0.017_088_126,
    0.006_670_09,
    -0.001_262_491_1,
];

/// `asin x = x + x^3 Q(x^2)` on `[0, 1/2]`: minimax for the relative error, 9e-8.
const ODD_TERMS: [f32; 4] = [0.166_655_8, 0.075_405_315, 0.040_034_983, 0.049_953_12];

/// Arc cosine in `[0, pi]`. Arguments outside `[-1, 1]` are clamped to it; NaN stays NaN.
///
/// Largest error: [`bounds::ACOS`](crate::bounds::ACOS).
#[inline(always)]
pub fn acos<L: Lanes>(lanes: L, x: L::F) -> L::F {
    let one = lanes.splat(1.0);
    let size = x.abs();
    let size = one.min(size);
    let angle = acos_positive(lanes, size, one - size);
    lanes.select(x.lt(lanes.splat(0.0)), lanes.splat(PI) - angle, angle)
}

/// Arc cosine of `c`, for a caller that knows `rest = 1 - |c|` more accurately than the subtraction would give it.
///
/// Near the poles the arc cosine depends on `rest` alone: an error of 6e-8 in a cosine near 1 is an error of 3e-4 rad
/// in the angle. From the sine, `rest = s^2 / (1 + |c|)` keeps full precision. `c` only needs to be near its true
/// value; `rest` must be in `[0, 1]`.
///
/// Largest error against the angle that `rest` and the sign of `c` define: that of [`acos`].
#[inline(always)]
pub fn acos_from<L: Lanes>(lanes: L, c: L::F, rest: L::F) -> L::F {
    let angle = acos_positive(lanes, c.abs(), rest);
    lanes.select(c.lt(lanes.splat(0.0)), lanes.splat(PI) - angle, angle)
}

#[inline(always)]
fn acos_positive<L: Lanes>(lanes: L, size: L::F, rest: L::F) -> L::F {
    rest.sqrt() * horner(lanes, size, EIGHT_TERMS)
}

/// Arc sine in `[-pi/2, pi/2]`. Arguments outside `[-1, 1]` are clamped to it; NaN stays NaN.
///
/// Largest error: [`bounds::ASIN`](crate::bounds::ASIN), also relative: near zero it is an odd polynomial.
#[inline(always)]
pub fn asin<L: Lanes>(lanes: L, x: L::F) -> L::F {
    let one = lanes.splat(1.0);
    let size = x.abs();
    let size = one.min(size);
    let square = size * size;
    let near_zero = lanes.mul_add(size * square, horner(lanes, square, ODD_TERMS), size);
    let elsewhere = lanes.splat(FRAC_PI_2) - acos_positive(lanes, size, one - size);
    lanes.select(size.lt(lanes.splat(0.5)), near_zero, elsewhere).mul_sign(x)
}
