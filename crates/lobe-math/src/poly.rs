//! Polynomial evaluation.

use lobe_lane::Lanes;

/// `c[0] + c[1] x + c[2] x^2 + ...` by Horner's rule: one multiply-add per term.
#[inline(always)]
pub(crate) fn horner<L: Lanes, const N: usize>(lanes: L, x: L::F, coefficients: [f32; N]) -> L::F {
    let mut sum = lanes.splat(coefficients[N - 1]);
    let mut k = N - 1;
    while k > 0 {
        k -= 1;
        sum = lanes.mul_add(sum, x, lanes.splat(coefficients[k]));
    }
    sum
}
