//! Inverse trigonometry over a block, and the map of the hemisphere to the unit square: `u.x = sqrt(2 theta / pi)`,
//! `u.y = (phi + pi) / (2 pi)`.

use std::f32::consts::{FRAC_1_PI, FRAC_2_PI, PI};

use lobe_lane::{Floats, Lanes};

use super::frame::Frame;
use crate::passes::block::Column;
use crate::rgl::data::LEAST_AREA;

/// `1 / (2 pi)`.
const TURNS_PER_RADIAN: f32 = 0.5 * FRAC_1_PI;

/// The angles and the position of `wi`.
pub(super) struct Incident {
    /// Zenith angle and azimuth in radians.
    pub(super) theta: Column,
    pub(super) phi: Column,
    /// The position on the unit square.
    pub(super) u: [Column; 2],
}

impl Incident {
    pub(super) const ZERO: Self =
        Incident { theta: Column::<f32>::ZERO, phi: Column::<f32>::ZERO, u: [Column::<f32>::ZERO; 2] };
}

/// Zenith angle and azimuth of `wi` in radians, and its position on the unit square, from the frame of queries `0..n`.
///
/// If not `azimuthal`, the azimuth is not computed, and nothing may depend on it.
#[inline(always)]
pub(super) fn incident<L: Lanes>(lanes: L, n: usize, azimuthal: bool, frame: &Frame, incident: &mut Incident) {
    let mut query = 0;
    while query < n {
        let theta = zenith(lanes, frame.cos_i.load(lanes, query), frame.sin2_i.load(lanes, query));
        incident.theta.store(lanes, query, theta);
        incident.u[0].store(lanes, query, (theta * lanes.splat(FRAC_2_PI)).sqrt());
        query += L::LANES;
    }
    let mut query = 0;
    while azimuthal && query < n {
        let phi = lobe_math::atan2(lanes, frame.wi[1].load(lanes, query), frame.wi[0].load(lanes, query));
        incident.phi.store(lanes, query, phi);
        incident.u[1].store(lanes, query, lanes.mul_add(phi, lanes.splat(TURNS_PER_RADIAN), lanes.splat(0.5)));
        query += L::LANES;
    }
}

/// The position of the half vector on the unit square.
#[inline(always)]
pub(super) fn half<L: Lanes>(lanes: L, n: usize, frame: &Frame, u_m: &mut [Column; 2]) {
    let one = lanes.splat(1.0);
    let mut query = 0;
    while query < n {
        let theta = zenith(lanes, frame.cos_m.load(lanes, query), frame.sin2_m.load(lanes, query));
        u_m[0].store(lanes, query, (theta * lanes.splat(FRAC_2_PI)).sqrt());
        query += L::LANES;
    }
    let mut query = 0;
    while query < n {
        let phi = lobe_math::atan2(lanes, frame.across[1].load(lanes, query), frame.across[0].load(lanes, query));
        let u = lanes.mul_add(phi, lanes.splat(TURNS_PER_RADIAN), lanes.splat(0.5));
        u_m[1].store(lanes, query, u - one.masked(one.le(u)));
        query += L::LANES;
    }
}

/// The zenith angle in radians, with full precision near the pole: `1 - cos = sin^2 / (1 + cos)`.
#[inline(always)]
fn zenith<L: Lanes>(lanes: L, cos: L::F, sin2: L::F) -> L::F {
    lobe_math::acos_from(lanes, cos, sin2 / (lanes.splat(1.0) + cos))
}

/// The divisor from the density of the half vector on the unit square to that of `wo` over solid angle, with the lower
/// bound [`LEAST_AREA`] at the pole of the half vector.
#[inline(always)]
pub(super) fn jacobian<L: Lanes>(lanes: L, cos_d: L::F, u_x: L::F, sin_m: L::F) -> L::F {
    let area = (lanes.splat(2.0 * PI * PI) * u_x * sin_m).max(lanes.splat(LEAST_AREA as f32));
    lanes.splat(4.0) * cos_d * area
}
