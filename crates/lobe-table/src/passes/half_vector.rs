//! From directions to half and difference angles: the coordinates of Rusinkiewicz, "A New Change of Variables for
//! Efficient BRDF Representation", 1998.
//!
//! For unit vectors, the half vector lies along the sum `h = wi + wo`, and the difference `d = wi - wo` is
//! perpendicular to it. Near the peak, where products lose their digits, both are exact up to the rounding of the
//! directions; and because `|h| = 2 cos(theta_d)` and `|d| = 2 sin(theta_d)`, no rotation into the frame of the half
//! vector has to be computed.

use lobe_lane::{Floats, Lanes};

use super::block::Column;
use super::pairs::Pairs;
use super::unit::unit;

/// The angles of a block of queries.
#[derive(Clone, Copy)]
pub(crate) struct HalfVector {
    /// `theta_h` and `theta_d`; at first, the tangents of their halves.
    pub(crate) theta_h: Column,
    pub(crate) theta_d: Column,
    /// `phi_d` in `[-pi, pi]`; at first, the components of `wi` perpendicular to the half vector, away from the normal
    /// and to the side.
    pub(crate) phi_d: Column,
    side: Column,
    /// All bits set if both directions point above the horizon.
    pub(crate) valid: Column<i32>,
}

impl HalfVector {
    pub(crate) const ZERO: Self = HalfVector {
        theta_h: Column::<f32>::ZERO,
        theta_d: Column::<f32>::ZERO,
        phi_d: Column::<f32>::ZERO,
        side: Column::<f32>::ZERO,
        valid: Column::<i32>::ZERO,
    };

    /// Fills the angles of queries `0..n`. `n` is a multiple of the lanes.
    ///
    /// If the half vector is the normal, its azimuth is that of `wo` if it is `VIEWED`, and 0 otherwise.
    #[inline(always)]
    pub(crate) fn run<L: Lanes, const VIEWED: bool>(&mut self, lanes: L, n: usize, pairs: Pairs<'_>) {
        self.frame::<L, VIEWED>(lanes, n, pairs);
        let mut query = 0;
        while query < n {
            self.theta_h.store(lanes, query, lobe_math::double_atan(lanes, self.theta_h.load(lanes, query)));
            self.theta_d.store(lanes, query, lobe_math::double_atan(lanes, self.theta_d.load(lanes, query)));
            query += L::LANES;
        }
        let mut query = 0;
        while query < n {
            let phi = lobe_math::atan2(lanes, self.side.load(lanes, query), self.phi_d.load(lanes, query));
            self.phi_d.store(lanes, query, phi);
            query += L::LANES;
        }
    }

    /// The intermediate values from which the angles are computed.
    #[inline(always)]
    fn frame<L: Lanes, const VIEWED: bool>(&mut self, lanes: L, n: usize, Pairs { wi, wo }: Pairs<'_>) {
        let (zero, one, two) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(2.0));
        let pole = lanes.splat(POLE2);
        let mut query = 0;
        while query < n {
            let (wi, wo) = (wi.load(lanes, query), wo.load(lanes, query));
            let above = zero.lt(wi[2]) & zero.lt(wo[2]);
            let ([ix, iy, iz], lit) = unit(lanes, wi);
            let ([ox, oy, oz], seen) = unit(lanes, wo);

            let (hx, hy, hz) = (ix + ox, iy + oy, iz + oz);
            let (dx, dy, dz) = (ix - ox, iy - oy, iz - oz);
            let across2 = lanes.mul_add(hx, hx, hy * hy);
            // A half vector along the horizon may have no length due to rounding.
            let h = lanes.mul_add(hz, hz, across2).max(pole).sqrt();
            let d = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, dz * dz)).sqrt();
            self.theta_h.store(lanes, query, across2.sqrt() / (h + hz));
            self.theta_d.store(lanes, query, d / (two + h));

            // The azimuth of the half vector, of any length; at the pole, the perpendicular vector is in the horizontal
            // plane.
            let tilted = pole.lt(across2);
            let (mut x, mut y) = (one, zero);
            if VIEWED {
                let aside = pole.lt(lanes.mul_add(ox, ox, oy * oy));
                (x, y) = (lanes.select(aside, ox, one), oy.masked(aside));
            }
            let (x, y) = (lanes.select(tilted, hx, x), lanes.select(tilted, hy, y));
            let along = lanes.mul_add(x, dx, y * dy);
            let side = lanes.mul_add(x, dy, -(y * dx));
            let away = lanes.mul_add(hz, along, -(across2.masked(tilted) * dz)) / h;
            self.phi_d.store(lanes, query, away);
            self.side.store(lanes, query, side);
            let valid = above & lit & seen;
            self.valid.store(lanes, query, lanes.select_int(valid, lanes.splat_int(-1), lanes.splat_int(0)));
            query += L::LANES;
        }
    }
}

/// Closer to the normal than the root of this sine, the half vector counts as the normal: the sum of two unit vectors
/// is not more accurate.
const POLE2: f32 = 1e-15;

/// The error from rounding two unit vectors, their sum and their difference.
const VECTOR: f64 = 6e-7;
/// The error from rounding an angle of up to a turn.
const ANGLE: f64 = 1e-6;

/// The largest errors of `theta_h`, `theta_d` and `phi_d` in the lanes, in radians.
///
/// The half vector has the length `2 cos(theta_d)`, so errors of the directions are amplified if they graze the surface
/// on opposite sides; its azimuth is poorly determined near the normal, as is that of `wi` near the half vector.
pub(crate) fn rounding(theta_h: f64, theta_d: f64) -> [f64; 3] {
    let (half, difference) = (2.0 * theta_d.cos().abs(), 2.0 * theta_d.sin());
    [VECTOR / half + ANGLE, VECTOR + ANGLE, VECTOR / (half * theta_h.sin()) + VECTOR / difference + ANGLE]
}
