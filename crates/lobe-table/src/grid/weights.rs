//! From fractions to the weights of the corners.

use lobe_lane::{Floats, Ints, Lanes};

use crate::passes::block::Column;

/// The largest number of corners: both ends of four axes.
pub(crate) const MAX_CORNERS: usize = 16;

/// The error due to rounding the weights and a sum of up to 16 corners, relative to the largest value.
pub(crate) const SUM: f64 = 4e-6;

/// The weight of each corner over the axes with the given fractions, the last axis fastest, for queries `0..n`: the
/// first `2^AXES` columns of `weights`. They add up to `scale`, or to 0 for queries that are not valid.
#[inline(always)]
pub(crate) fn run<L: Lanes, const AXES: usize, const B: usize>(
    lanes: L,
    n: usize,
    fractions: [&Column<f32, B>; AXES],
    valid: &Column<i32, B>,
    scale: f32,
    weights: &mut [Column<f32, B>; MAX_CORNERS],
) {
    let (zero, one, scale) = (lanes.splat_int(0), lanes.splat(1.0), lanes.splat(scale));
    let mut query = 0;
    while query < n {
        let mut products = [scale; MAX_CORNERS];
        let mut axis = 0;
        while axis < AXES {
            let upper = fractions[axis].load(lanes, query);
            let lower = one - upper;
            // Backwards, so that each product is read before it is overwritten.
            let mut corner = 1 << axis;
            while corner > 0 {
                corner -= 1;
                let product = products[corner];
                products[2 * corner] = product * lower;
                products[2 * corner + 1] = product * upper;
            }
            axis += 1;
        }
        let valid = valid.load(lanes, query).lt(zero);
        let mut corner = 0;
        while corner < 1 << AXES {
            weights[corner].store(lanes, query, products[corner].masked(valid));
            corner += 1;
        }
        query += L::LANES;
    }
}
