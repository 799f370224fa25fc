//! From a sampled half vector to the direction into which it reflects `wi`.

use std::f32::consts::{FRAC_PI_2, PI};

use lobe_lane::{Floats, Ints, Lanes};

use super::angles;
use super::frame::{Frame, Oriented, Symmetry};
use crate::directions::DirectionBlock;
use crate::passes::block::Column;
use crate::passes::unit::FARTHEST;

/// `wi` of queries `0..n`: the part of the frame that does not need `wo`.
#[inline(always)]
pub(super) fn incident<L: Lanes>(lanes: L, n: usize, wi: DirectionBlock<'_>, symmetry: Symmetry, frame: &mut Frame) {
    let zero = lanes.splat(0.0);
    let mut query = 0;
    while query < n {
        let Oriented { wi: [x, y, z], sin2, .. } = symmetry.orient(lanes, wi.load(lanes, query));
        frame.wi[0].store(lanes, query, x);
        frame.wi[1].store(lanes, query, y);
        frame.cos_i.store(lanes, query, z);
        frame.sin2_i.store(lanes, query, sin2);
        let valid = zero.lt(z) & lanes.mul_add(z, z, sin2).lt(lanes.splat(FARTHEST));
        frame.valid.store(lanes, query, lanes.select_int(valid, lanes.splat_int(-1), lanes.splat_int(0)));
        query += L::LANES;
    }
}

/// The directions of a block, and their densities.
pub(super) struct Reflected<'a> {
    pub(super) wo: &'a mut [Column; 3],
    pub(super) density: &'a mut Column,
}

/// Directions and densities from the half vectors at `u_m`, replacing the density on the unit square; 0 if a direction
/// is not above the surface. The factor becomes the inverse of the density.
#[inline(always)]
pub(super) fn run<L: Lanes>(
    lanes: L,
    n: usize,
    wi: DirectionBlock<'_>,
    symmetry: Symmetry,
    u_m: &[Column; 2],
    frame: &mut Frame,
    Reflected { wo, density }: Reflected<'_>,
) {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let mut query = 0;
    while query < n {
        let Oriented { signs, wi: [ix, iy, iz], turn: [cos_turn, sin_turn], .. } =
            symmetry.orient(lanes, wi.load(lanes, query));
        let (x, y) = (u_m[0].load(lanes, query), u_m[1].load(lanes, query));
        let (sin_m, cos_m) = lobe_math::sin_cos(lanes, x * x * lanes.splat(FRAC_PI_2));
        let (sin_phi, cos_phi) = lobe_math::sin_cos(lanes, (y + y - one) * lanes.splat(PI));
        let mx = sin_m * lanes.mul_add(cos_phi, cos_turn, -(sin_phi * sin_turn));
        let my = sin_m * lanes.mul_add(sin_phi, cos_turn, cos_phi * sin_turn);

        let cos_d = lanes.mul_add(ix, mx, lanes.mul_add(iy, my, iz * cos_m));
        let twice = cos_d + cos_d;
        let (ox, oy, oz) = (twice * mx - ix, twice * my - iy, twice * cos_m - iz);
        let pdf = density.load(lanes, query) / angles::jacobian(lanes, cos_d, x, sin_m);
        let known = frame.valid.load(lanes, query).lt(lanes.splat_int(0));
        let valid = known & zero.lt(cos_d) & zero.lt(oz) & zero.lt(pdf);

        wo[0].store(lanes, query, ox.mul_sign(signs[0]).masked(valid));
        wo[1].store(lanes, query, oy.mul_sign(signs[1]).masked(valid));
        wo[2].store(lanes, query, oz.masked(valid));
        density.store(lanes, query, pdf.masked(valid));
        frame.factor.store(lanes, query, (one / pdf.max(lanes.splat(LEAST))).masked(valid));
        query += L::LANES;
    }
}

/// The smallest density to divide by: the inverse of a smaller one would overflow in products.
const LEAST: f32 = 1e-20;
