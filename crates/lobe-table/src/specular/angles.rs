//! Inverse trigonometry over a block.

use lobe_lane::{Floats, Lanes};

use super::frame::Frame;
use crate::passes::block::Column;

/// Keeps the division of a direction along the zenith finite.
pub(crate) const TINY: f32 = 1e-30;

/// Fills sigma, psi (if `anisotropic`), theta and phi, in radians, from the frame of queries `0..n`.
#[inline(always)]
pub(crate) fn run<L: Lanes, const B: usize>(
    lanes: L,
    n: usize,
    anisotropic: bool,
    frame: &Frame<B>,
    angles: &mut [Column<f32, B>; 4],
) {
    let [sigma, psi, theta, phi] = angles;
    half_tangents(lanes, n, frame, theta, phi);

    let mut query = 0;
    while query < n {
        sigma.store(lanes, query, lobe_math::double_atan(lanes, frame.half_sigma.load(lanes, query)));
        let (t, along) = (theta.load(lanes, query), frame.along.load(lanes, query));
        theta.store(lanes, query, lobe_math::polar_from(lanes, t, along));
        query += L::LANES;
    }

    let mut query = 0;
    while query < n {
        let (t, x) = (phi.load(lanes, query), frame.across[0].load(lanes, query));
        phi.store(lanes, query, lobe_math::azimuth_from(lanes, t, x));
        query += L::LANES;
    }

    let mut query = 0;
    while anisotropic && query < n {
        let [cos, sin] = [frame.psi[0].load(lanes, query), frame.psi[1].load(lanes, query)];
        let t = sin / (lanes.splat(1.0) + cos.abs());
        psi.store(lanes, query, lobe_math::azimuth_from(lanes, t, cos));
        query += L::LANES;
    }
}

/// The tangents of half of theta and half of phi, with one root and one division.
#[inline(always)]
fn half_tangents<L: Lanes, const B: usize>(
    lanes: L,
    n: usize,
    frame: &Frame<B>,
    theta: &mut Column<f32, B>,
    phi: &mut Column<f32, B>,
) {
    let (one, tiny) = (lanes.splat(1.0), lanes.splat(TINY));
    let mut query = 0;
    while query < n {
        let [x, y] = [frame.across[0].load(lanes, query), frame.across[1].load(lanes, query)];
        let across = lanes.mul_add(x, x, y * y).sqrt();
        let (reach, span) = (one + frame.along.load(lanes, query).abs(), tiny.max(across + x.abs()));
        let shared = one / (reach * span);
        theta.store(lanes, query, across * span * shared);
        phi.store(lanes, query, y * reach * shared);
        query += L::LANES;
    }
}
