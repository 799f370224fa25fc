//! Directions to what the angles are computed from: the specular frame (see [`coords`](crate::coords)).

use lobe_lane::{Floats, Lanes};

use super::block::{BLOCK, Column};
use crate::Scatter;
use crate::directions::Directions;
use crate::function::Function;

/// The columns that the first pass fills.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    /// Cosine of sigma, and its squared sine.
    pub(crate) cos_sigma: Column,
    pub(crate) sin2_sigma: Column,
    /// Cosine and sine of psi.
    pub(crate) psi: [Column; 2],
    /// `wo` about the zenith: across it toward phi = 0 and phi = pi/2, and 1 less its component along it. Nothing across
    /// where not valid, so that phi, which multiplies the texels of colours last, is a number.
    pub(crate) across: [Column; 2],
    pub(crate) rest: Column,
    /// All bits set where both directions are finite and above the horizon.
    pub(crate) valid: Column<i32>,
}

impl Frame {
    pub(crate) const ZERO: Self = Frame {
        cos_sigma: Column::<f32>::ZERO,
        sin2_sigma: Column::<f32>::ZERO,
        psi: [Column::<f32>::ZERO; 2],
        across: [Column::<f32>::ZERO; 2],
        rest: Column::<f32>::ZERO,
        valid: Column::<i32>::ZERO,
    };
}

/// Closer to the normal than 1e-15 rad, psi is taken for 0: the squares of shorter components lose their digits.
const POLE: f32 = 1e-30;

/// The squared distance of two unit vectors is at most 4, and their squared length 1; much more, or NaN, means that a
/// component is not finite.
const FARTHEST: f32 = 16.0;

/// Fills the frame of queries `0..n` from the directions at `at..at + n`. `n` is a multiple of the lanes.
#[inline(always)]
pub(crate) fn run<L: Lanes, D: Directions>(
    lanes: L,
    scatter: Scatter,
    refraction: Option<&Function>,
    (wi, wo): (D, D),
    (at, n): (usize, usize),
    frame: &mut Frame,
) {
    match (scatter, refraction) {
        (Scatter::Reflection, _) => pass::<L, D, false>(lanes, None, (wi, wo), (at, n), frame),
        (Scatter::Transmission, refraction) => pass::<L, D, true>(lanes, refraction, (wi, wo), (at, n), frame),
    }
}

#[inline(always)]
fn pass<L: Lanes, D: Directions, const FOLD: bool>(
    lanes: L,
    refraction: Option<&Function>,
    (wi, wo): (D, D),
    (at, n): (usize, usize),
    frame: &mut Frame,
) {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let mut query = 0;
    while query < n && query < BLOCK {
        let [ix, iy, iz] = wi.load(lanes, at + query);
        let [ox, oy, oz] = wo.load(lanes, at + query);
        let (iz, oz) = if FOLD { (iz.abs(), oz.abs()) } else { (iz, oz) };

        let sin2 = lanes.mul_add(ix, ix, iy * iy);
        let sin = sin2.sqrt();
        let tilted = lanes.splat(POLE).lt(sin2);
        let scale = (one / sin).masked(tilted);
        let (cos_psi, sin_psi) = (lanes.select(tilted, ix * scale, one), iy * scale);

        // The zenith's polar angle, by its sine and cosine: sigma itself, or moved by refraction.
        let (sin_zenith, cos_zenith) = match refraction {
            None => (sin, iz),
            Some(offset) => {
                let sigma = lobe_math::acos_from(lanes, iz, sin2 / (one + iz));
                let polar = (sigma + offset.eval(lanes, sigma)).max(zero).min(lanes.splat(std::f32::consts::FRAC_PI_2));
                lobe_math::sin_cos(lanes, polar)
            }
        };

        // The difference of wo and the zenith: near the peak its digits are exact where those of a product are lost.
        let (dx, dy, dz) = match refraction {
            None => (ox + ix, oy + iy, oz - iz),
            Some(_) => {
                let (ax, ay) = (sin_zenith * cos_psi, sin_zenith * sin_psi);
                (ox + ax, oy + ay, oz - cos_zenith)
            }
        };
        let toward = lanes.mul_add(cos_psi, dx, sin_psi * dy);
        let y = lanes.mul_add(cos_psi, dy, -(sin_psi * dx));
        let x = lanes.mul_add(cos_zenith, toward, sin_zenith * dz);
        let distance2 = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, dz * dz));

        frame.cos_sigma.store(lanes, query, iz);
        frame.sin2_sigma.store(lanes, query, sin2);
        frame.psi[0].store(lanes, query, cos_psi);
        frame.psi[1].store(lanes, query, sin_psi);
        // A zenith that is computed is finite even where wi is not.
        let size2 = match refraction {
            None => distance2,
            Some(_) => distance2 + lanes.mul_add(iz, iz, sin2),
        };
        let valid = zero.lt(iz) & zero.lt(oz) & size2.lt(lanes.splat(FARTHEST));
        frame.across[0].store(lanes, query, x.masked(valid));
        frame.across[1].store(lanes, query, y.masked(valid));
        frame.rest.store(lanes, query, lanes.splat(0.5) * distance2);
        frame.valid.store(lanes, query, lanes.select_int(valid, lanes.splat_int(-1), lanes.splat_int(0)));
        query += L::LANES;
    }
}
