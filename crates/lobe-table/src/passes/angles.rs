//! Inverse trigonometry over a block.

use lobe_lane::{Floats, Lanes};

use super::block::Column;
use super::frame::Frame;

/// Fills sigma, psi (where `anisotropic`), theta and phi, in radians, from the frame of queries `0..n`.
#[inline(always)]
pub(crate) fn run<L: Lanes>(lanes: L, n: usize, anisotropic: bool, frame: &Frame, angles: &mut [Column; 4]) {
    let one = lanes.splat(1.0);
    let [sigma, psi, theta, phi] = angles;

    let mut query = 0;
    while query < n {
        let cos = frame.cos_sigma.load(lanes, query);
        let rest = frame.sin2_sigma.load(lanes, query) / (one + cos.abs());
        sigma.store(lanes, query, lobe_math::acos_from(lanes, cos, rest));

        let [x, y] = [frame.across[0].load(lanes, query), frame.across[1].load(lanes, query)];
        let sin2 = lanes.mul_add(x, x, y * y);
        let cos = one - frame.rest.load(lanes, query);
        let rest = sin2 / (one + cos.abs());
        theta.store(lanes, query, lobe_math::acos_from(lanes, cos, rest));
        query += L::LANES;
    }

    let mut query = 0;
    while query < n {
        let [x, y] = [frame.across[0].load(lanes, query), frame.across[1].load(lanes, query)];
        phi.store(lanes, query, lobe_math::azimuth(lanes, y, x));
        query += L::LANES;
    }

    let mut query = 0;
    while anisotropic && query < n {
        let [x, y] = [frame.psi[0].load(lanes, query), frame.psi[1].load(lanes, query)];
        psi.store(lanes, query, lobe_math::azimuth_from(lanes, y, x, one));
        query += L::LANES;
    }
}
