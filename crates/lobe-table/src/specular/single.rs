//! The coordinates of one query at a time, with SIMD within the query: the arithmetic of the passes, arranged so that
//! the four angles share a register. [`Interpolator::single`](crate::grid::interpolation::Interpolator::single) does
//! the rest.

use lobe_lane::{Kernel, Lanes, MAX_LANES};

use super::Table;
use super::angles::TINY;
use super::frame::{Refracted, Zenith};
use crate::Scatter;
use crate::passes::unit::{FARTHEST, POLE};

/// One query.
pub(crate) struct Single<'a> {
    pub(crate) table: &'a Table,
    pub(crate) wi: [f32; 3],
    pub(crate) wo: [f32; 3],
    pub(crate) out: &'a mut [f32],
}

impl Kernel for Single<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Single { table, wi, wo, out } = self;
        let (angles, above) = angles(lanes, table, wi, wo);
        table.grid.single(lanes, angles, above, out);
    }
}

/// Sigma, psi, theta and phi in radians, and whether both directions are finite and above the horizon: the first two
/// passes for one query.
#[inline(always)]
fn angles<L: Lanes>(lanes: L, table: &Table, wi: [f32; 3], wo: [f32; 3]) -> ([f32; 4], bool) {
    let ([ix, iy, mut iz], [ox, oy, mut oz]) = (wi, wo);
    if table.scatter() == Scatter::Transmission {
        (iz, oz) = (iz.abs(), oz.abs());
    }
    let sin2 = lanes.scalar_mul_add(ix, ix, iy * iy);
    let sin = sin2.sqrt();
    let (tilted, reach) = (POLE < sin, 1.0 + iz);
    let shared = 1.0 / (if tilted { sin } else { POLE } * reach);
    let scale = if tilted { reach * shared } else { 0.0 };
    let (cos_psi, sin_psi) = (if tilted { ix * scale } else { 1.0 }, iy * scale);
    let half_sigma = sin2 * shared;
    let ([ax, ay, cos_zenith], sin_zenith) = match &table.refraction {
        None => ([ix, iy, iz], sin),
        Some(offset) => {
            let (wi, psi) = (lanes.splat_xyz([ix, iy, iz]), [lanes.splat(cos_psi), lanes.splat(sin_psi)]);
            let (opposite, sin) = Refracted(offset).opposite(lanes, wi, lanes.splat(sin), psi);
            (lanes.extract_xyz(opposite, 0), lanes.extract(sin, 0))
        }
    };
    let (dx, dy, dz) = (ox + ax, oy + ay, oz - cos_zenith);
    let toward = lanes.scalar_mul_add(cos_psi, dx, sin_psi * dy);
    let y = lanes.scalar_mul_add(cos_psi, dy, -(sin_psi * dx));
    let x = lanes.scalar_mul_add(cos_zenith, toward, sin_zenith * dz);
    let distance2 = lanes.scalar_mul_add(dx, dx, lanes.scalar_mul_add(dy, dy, dz * dz));
    let valid = 0.0 < iz && 0.0 < oz && distance2 + lanes.scalar_mul_add(iz, iz, sin2) < FARTHEST;

    let along = 1.0 - 0.5 * distance2;
    let across = lanes.scalar_mul_add(x, x, y * y).sqrt();
    let (reach, span) = (1.0 + along.abs(), across + x.abs());
    let span = if TINY > span { TINY } else { span };
    let shared = 1.0 / (reach * span);
    let half_theta = across * span * shared;
    let half_phi = y * reach * shared;
    let half_psi = if table.is_anisotropic() { sin_psi / (1.0 + cos_psi.abs()) } else { 0.0 };

    // One polynomial for all four: a polar angle whose tangent is not negative is an azimuth like any other. Sigma is
    // never beyond pi/2.
    let halves = [half_sigma, half_psi, half_theta, half_phi];
    (azimuths(lanes, halves, [1.0, cos_psi, along, x]), valid)
}

/// Like [`lobe_math::azimuth_from`], for four angles.
#[inline(always)]
fn azimuths<L: Lanes>(lanes: L, t: [f32; 4], x: [f32; 4]) -> [f32; 4] {
    let mut angles = [0.0; MAX_LANES];
    if L::LANES < 4 {
        let mut k = 0;
        while k < 4 {
            let angle = lobe_math::azimuth_from(lanes, lanes.splat(t[k]), lanes.splat(x[k]));
            angles[k] = lanes.extract(angle, 0);
            k += 1;
        }
    } else {
        let packed = lobe_math::azimuth_from(lanes, lanes.first_four(t), lanes.first_four(x));
        lanes.store(&mut angles, packed);
    }
    [angles[0], angles[1], angles[2], angles[3]]
}
