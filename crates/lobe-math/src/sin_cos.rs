//! Sine and cosine at once.

use core::f32::consts::FRAC_2_PI;

use lobe_lane::{Floats, Ints, Lanes};

use crate::poly::horner;

/// `sin r = r + r^3 S(r^2)` and `cos r = 1 - r^2/2 + r^4 C(r^2)` on `[-pi/4, pi/4]`: minimax, 4e-9 and 1e-10.
const SIN_TERMS: [f32; 3] = [-0.166_666_55, 0.008_332_16, -0.000_195_152_84];
const COS_TERMS: [f32; 3] = [0.041_666_646, -0.001_388_736_8, 2.443_845_2e-5];

/// pi/2 in three parts of few bits, so that a small multiple of each of the first two is exact (Cody and Waite).
const HALF_PI: [f32; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];

/// `(sin x, cos x)` of an angle in radians, for `|x|` up to 8192.
///
/// Largest error there: [`bounds::SIN_COS`](crate::bounds::SIN_COS).
#[inline(always)]
pub fn sin_cos<L: Lanes>(lanes: L, x: L::F) -> (L::F, L::F) {
    let half = lanes.splat(0.5).mul_sign(x);
    let quarter = lanes.mul_add(x, lanes.splat(FRAC_2_PI), half).to_int();
    let turns = -quarter.to_float();
    let r = lanes.mul_add(turns, lanes.splat(HALF_PI[0]), x);
    let r = lanes.mul_add(turns, lanes.splat(HALF_PI[1]), r);
    let r = lanes.mul_add(turns, lanes.splat(HALF_PI[2]), r);
    let square = r * r;
    let sin = lanes.mul_add(r * square, horner(lanes, square, SIN_TERMS), r);
    let cos = lanes.mul_add(square, lanes.splat(-0.5), lanes.splat(1.0));
    let cos = lanes.mul_add(square * square, horner(lanes, square, COS_TERMS), cos);

    // Odd quadrants swap the two; quadrants 2 and 3 negate the sine, 1 and 2 the cosine.
    let one = lanes.splat_int(1);
    let swap = (quarter & one).eq(one);
    let sin_sign = quarter.shr::<1>().shl::<31>().as_float();
    let cos_sign = (quarter + one).shr::<1>().shl::<31>().as_float();
    (lanes.select(swap, cos, sin).mul_sign(sin_sign), lanes.select(swap, sin, cos).mul_sign(cos_sign))
}
