//! Directions to what the angles are computed from: the specular frame (see [`coords`](crate::coords)).

use std::f32::consts::FRAC_PI_2;

use lobe_lane::{Floats, Lanes};

use super::block::Column;
use crate::Scatter;
use crate::directions::BlockOfDirections;
use crate::function::Function;

/// The columns that the first pass fills.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    /// Cosine of sigma, and its squared sine.
    pub(crate) cos_sigma: Column,
    pub(crate) sin2_sigma: Column,
    /// Cosine and sine of psi.
    pub(crate) psi: [Column; 2],
    /// `wo` about the zenith: across it toward phi = 0 and phi = pi/2, and 1 less its component along it.
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
pub(crate) const POLE: f32 = 1e-30;

/// The squared distance of two unit vectors is at most 4 and a squared sine at most 1; a much larger sum, or NaN, means
/// that a component is not finite.
pub(crate) const FARTHEST: f32 = 16.0;

/// Fills the frame of queries `0..n` of a block. `n` is a multiple of the lanes.
#[inline(always)]
pub(crate) fn run<L: Lanes, B: BlockOfDirections>(
    lanes: L,
    n: usize,
    (wi, wo): (B, B),
    scatter: Scatter,
    refraction: Option<&Function>,
    frame: &mut Frame,
) {
    match (scatter, refraction) {
        (Scatter::Reflection, _) => pass(lanes, n, (wi, wo), Mirror::<false>, frame),
        (Scatter::Transmission, None) => pass(lanes, n, (wi, wo), Mirror::<true>, frame),
        (Scatter::Transmission, Some(offset)) => pass(lanes, n, (wi, wo), Refracted(offset), frame),
    }
}

/// Where the zenith of the scattered light lies.
pub(crate) trait Zenith: Copy {
    /// `true` where directions below the surface are folded up.
    const FOLD: bool;

    /// The zenith mirrored about the normal, which is `wi` itself unless light is refracted, and the sine of its polar
    /// angle. `sin` is that of sigma, and `psi` the cosine and sine of psi.
    fn opposite<L: Lanes>(self, lanes: L, wi: [L::F; 3], sin: L::F, psi: [L::F; 2]) -> ([L::F; 3], L::F);
}

/// The mirror direction, or where `FOLD`, straight through the surface and folded up.
#[derive(Clone, Copy)]
struct Mirror<const FOLD: bool>;

impl<const FOLD: bool> Zenith for Mirror<FOLD> {
    const FOLD: bool = FOLD;

    #[inline(always)]
    fn opposite<L: Lanes>(self, _lanes: L, wi: [L::F; 3], sin: L::F, _psi: [L::F; 2]) -> ([L::F; 3], L::F) {
        (wi, sin)
    }
}

/// Through the surface, bent by an offset that depends on sigma.
#[derive(Clone, Copy)]
pub(crate) struct Refracted<'a>(pub(crate) &'a Function);

impl Zenith for Refracted<'_> {
    const FOLD: bool = true;

    #[inline(always)]
    fn opposite<L: Lanes>(self, lanes: L, wi: [L::F; 3], sin: L::F, psi: [L::F; 2]) -> ([L::F; 3], L::F) {
        let [_, _, cos] = wi;
        let rest = sin * sin / (lanes.splat(1.0) + cos);
        let sigma = lobe_math::acos_from(lanes, cos, rest);
        let polar = (sigma + self.0.eval(lanes, sigma)).max(lanes.splat(0.0)).min(lanes.splat(FRAC_PI_2));
        let (sin, cos) = lobe_math::sin_cos(lanes, polar);
        ([sin * psi[0], sin * psi[1], cos], sin)
    }
}

#[inline(always)]
fn pass<L: Lanes, B: BlockOfDirections, Z: Zenith>(lanes: L, n: usize, (wi, wo): (B, B), zenith: Z, frame: &mut Frame) {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let mut query = 0;
    while query < n {
        let [ix, iy, iz] = wi.load(lanes, query);
        let [ox, oy, oz] = wo.load(lanes, query);
        let (iz, oz) = if Z::FOLD { (iz.abs(), oz.abs()) } else { (iz, oz) };

        let sin2 = lanes.mul_add(ix, ix, iy * iy);
        let sin = sin2.sqrt();
        let tilted = lanes.splat(POLE).lt(sin2);
        let scale = (one / sin).masked(tilted);
        let (cos_psi, sin_psi) = (lanes.select(tilted, ix * scale, one), iy * scale);

        // The difference of wo and the zenith: near the peak its digits are exact where those of a product are lost.
        let ([ax, ay, cos_zenith], sin_zenith) = zenith.opposite(lanes, [ix, iy, iz], sin, [cos_psi, sin_psi]);
        let (dx, dy, dz) = (ox + ax, oy + ay, oz - cos_zenith);
        let toward = lanes.mul_add(cos_psi, dx, sin_psi * dy);
        let y = lanes.mul_add(cos_psi, dy, -(sin_psi * dx));
        let x = lanes.mul_add(cos_zenith, toward, sin_zenith * dz);
        let distance2 = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, dz * dz));

        frame.cos_sigma.store(lanes, query, iz);
        frame.sin2_sigma.store(lanes, query, sin2);
        frame.psi[0].store(lanes, query, cos_psi);
        frame.psi[1].store(lanes, query, sin_psi);
        frame.across[0].store(lanes, query, x);
        frame.across[1].store(lanes, query, y);
        frame.rest.store(lanes, query, lanes.splat(0.5) * distance2);
        let valid = zero.lt(iz) & zero.lt(oz) & (distance2 + sin2).lt(lanes.splat(FARTHEST));
        frame.valid.store(lanes, query, lanes.select_int(valid, lanes.splat_int(-1), lanes.splat_int(0)));
        query += L::LANES;
    }
}
