//! From directions to the specular frame, from which the angles are computed (see [`coords`](crate::specular::coords)).

use std::f32::consts::FRAC_PI_2;

use lobe_lane::{Floats, Lanes};

use crate::Scatter;
use crate::grid::function::Function;
use crate::passes::block::{BLOCK, Column};
use crate::passes::pairs::Pairs;
use crate::passes::unit::{FARTHEST, POLE};

/// The intermediate values from which the angles of a block are computed.
///
/// Every angle comes from the tangent of its half, `sin / (1 + cos)`. The first passes mostly wait for divisions and
/// roots, so each root and each division serves two angles.
#[derive(Clone, Copy)]
pub(crate) struct Frame<const B: usize = BLOCK> {
    /// The tangent of half of sigma.
    pub(crate) half_sigma: Column<f32, B>,
    /// Cosine and sine of psi.
    pub(crate) psi: [Column<f32, B>; 2],
    /// `wo` about the zenith: perpendicular to it toward phi = 0 and phi = pi/2, and along it.
    pub(crate) across: [Column<f32, B>; 2],
    pub(crate) along: Column<f32, B>,
}

impl<const B: usize> Frame<B> {
    pub(crate) const ZERO: Self = Frame {
        half_sigma: Column::<f32, B>::ZERO,
        psi: [Column::<f32, B>::ZERO; 2],
        across: [Column::<f32, B>::ZERO; 2],
        along: Column::<f32, B>::ZERO,
    };
}

/// Fills the frame of queries `0..n` of a block, and sets all bits of `valid` for those whose directions are finite and
/// above the horizon. `n` is a multiple of the lanes.
#[inline(always)]
pub(crate) fn run<L: Lanes, const B: usize>(
    lanes: L,
    n: usize,
    pairs: Pairs<'_, B>,
    scatter: Scatter,
    refraction: Option<&Function>,
    frame: &mut Frame<B>,
    valid: &mut Column<i32, B>,
) {
    match (scatter, refraction) {
        (Scatter::Reflection, _) => pass(lanes, n, pairs, Mirror::<false>, frame, valid),
        (Scatter::Transmission, None) => pass(lanes, n, pairs, Mirror::<true>, frame, valid),
        (Scatter::Transmission, Some(offset)) => pass(lanes, n, pairs, Refracted(offset), frame, valid),
    }
}

/// The zenith of the scattered light.
pub(crate) trait Zenith: Copy {
    /// `true` if directions below the surface are folded up.
    const FOLD: bool;

    /// The zenith mirrored about the normal, which is `wi` itself unless light is refracted, and the sine of its polar
    /// angle. `sin` is that of sigma, and `psi` the cosine and sine of psi.
    fn opposite<L: Lanes>(self, lanes: L, wi: [L::F; 3], sin: L::F, psi: [L::F; 2]) -> ([L::F; 3], L::F);
}

/// The mirror direction or, if `FOLD`, straight through the surface and folded up.
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
        let sigma = lobe_math::double_atan(lanes, sin / (lanes.splat(1.0) + cos));
        let polar = (sigma + self.0.eval(lanes, sigma)).max(lanes.splat(0.0)).min(lanes.splat(FRAC_PI_2));
        let (sin, cos) = lobe_math::sin_cos(lanes, polar);
        ([sin * psi[0], sin * psi[1], cos], sin)
    }
}

#[inline(always)]
fn pass<L: Lanes, Z: Zenith, const B: usize>(
    lanes: L,
    n: usize,
    Pairs { wi, wo }: Pairs<'_, B>,
    zenith: Z,
    frame: &mut Frame<B>,
    valid: &mut Column<i32, B>,
) {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let mut query = 0;
    while query < n {
        let [ix, iy, iz] = wi.load(lanes, query);
        let [ox, oy, oz] = wo.load(lanes, query);
        let (iz, oz) = if Z::FOLD { (iz.abs(), oz.abs()) } else { (iz, oz) };

        let sin2 = lanes.mul_add(ix, ix, iy * iy);
        let sin = sin2.sqrt();
        let (pole, reach) = (lanes.splat(POLE), one + iz);
        let tilted = pole.lt(sin);
        // One division gives 1 / sin, for psi, and 1 / (1 + cos), for sigma.
        let shared = one / (pole.max(sin) * reach);
        let scale = (reach * shared).masked(tilted);
        let (cos_psi, sin_psi) = (lanes.select(tilted, ix * scale, one), iy * scale);

        // The difference of wo and the zenith: near the peak, its digits are exact, and those of a product are lost.
        let ([ax, ay, cos_zenith], sin_zenith) = zenith.opposite(lanes, [ix, iy, iz], sin, [cos_psi, sin_psi]);
        let (dx, dy, dz) = (ox + ax, oy + ay, oz - cos_zenith);
        let toward = lanes.mul_add(cos_psi, dx, sin_psi * dy);
        let y = lanes.mul_add(cos_psi, dy, -(sin_psi * dx));
        let x = lanes.mul_add(cos_zenith, toward, sin_zenith * dz);
        let distance2 = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, dz * dz));

        frame.half_sigma.store(lanes, query, sin2 * shared);
        frame.psi[0].store(lanes, query, cos_psi);
        frame.psi[1].store(lanes, query, sin_psi);
        frame.across[0].store(lanes, query, x);
        frame.across[1].store(lanes, query, y);
        frame.along.store(lanes, query, one - lanes.splat(0.5) * distance2);
        let size2 = distance2 + lanes.mul_add(iz, iz, sin2);
        let above = zero.lt(iz) & zero.lt(oz) & size2.lt(lanes.splat(FARTHEST));
        valid.store(lanes, query, lanes.select_int(above, lanes.splat_int(-1), lanes.splat_int(0)));
        query += L::LANES;
    }
}
