//! Roots that have no instruction.

use lobe_lane::{Floats, Ints, Lanes};

/// Four fifths of the bits of the exponent of 1, minus a shift that centres the error of treating the logarithm as
/// linear.
const OFFSET: i32 = 851_981_000;

/// The fifth root of a positive normal number.
///
/// The bits of a float, read as an integer, are nearly its logarithm, so a fifth of them gives the root to within 4 %,
/// and each of three steps of Newton's method doubles the digits.
///
/// Largest error: [`bounds::FIFTH_ROOT`](crate::bounds::FIFTH_ROOT), relative.
#[inline(always)]
pub fn fifth_root<L: Lanes>(lanes: L, x: L::F) -> L::F {
    let (most, rest) = (lanes.splat(0.8), lanes.splat(0.2));
    let mut root = ((x.bits().to_float() * rest).to_int() + lanes.splat_int(OFFSET)).as_float();
    let scaled = x * rest;
    let mut step = 0;
    while step < 3 {
        let square = root * root;
        root = lanes.mul_add(most, root, scaled / (square * square));
        step += 1;
    }
    root
}
