//! From directions to the quantities from which angles are computed.

use lobe_lane::{Floats, Lanes};

use crate::passes::block::Column;
use crate::passes::pairs::Pairs;
use crate::passes::unit::{FARTHEST, POLE};

/// The columns that the first pass fills.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    /// x and y of `wi`, moved to the stored azimuths; its z and its squared sine.
    pub(super) wi: [Column; 2],
    pub(super) cos_i: Column,
    pub(super) sin2_i: Column,
    /// x and y along the azimuth of the half vector; for isotropic materials, minus the azimuth of `wi`.
    pub(super) across: [Column; 2],
    /// The half vector's cosine and squared sine.
    pub(super) cos_m: Column,
    pub(super) sin2_m: Column,
    /// Cosine of the angle between the half vector and either direction.
    pub(super) cos_d: Column,
    /// The factor of every value so far: 1, or the inverse of the cosine of `wo`.
    pub(super) factor: Column,
    /// All bits set if both directions are finite and above the surface.
    pub(super) valid: Column<i32>,
}

impl Frame {
    pub(super) const ZERO: Self = Frame {
        wi: [Column::<f32>::ZERO; 2],
        cos_i: Column::<f32>::ZERO,
        sin2_i: Column::<f32>::ZERO,
        across: [Column::<f32>::ZERO; 2],
        cos_m: Column::<f32>::ZERO,
        sin2_m: Column::<f32>::ZERO,
        cos_d: Column::<f32>::ZERO,
        factor: Column::<f32>::ZERO,
        valid: Column::<i32>::ZERO,
    };
}

/// The smallest cosine to divide by: the inverse of a smaller one would overflow in products.
const FLATTEST: f32 = 1e-20;

/// The treatment of azimuths by a material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Symmetry {
    pub(super) isotropic: bool,
    /// 1, 2 or 4: see [`Data::reduction`](crate::rgl::Data::reduction).
    pub(super) reduction: u32,
}

/// A `wi` in each lane, moved to the stored azimuths.
#[derive(Clone, Copy)]
pub(super) struct Oriented<L: Lanes> {
    /// -0.0 if x, or y, of all directions must change sign for this, and back; +0.0 otherwise.
    pub(super) signs: [L::F; 2],
    /// x, y and z.
    pub(super) wi: [L::F; 3],
    /// Squared sine.
    pub(super) sin2: L::F,
    /// Cosine and sine of the azimuth from which half vectors are measured, which is 0 unless the material is
    /// isotropic.
    pub(super) turn: [L::F; 2],
}

impl Symmetry {
    /// Moves `wi` to the stored azimuths.
    #[inline(always)]
    pub(super) fn orient<L: Lanes>(self, lanes: L, [x, y, z]: [L::F; 3]) -> Oriented<L> {
        let (zero, one, negative) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(-0.0));
        let (half, quarter) = (every(lanes, self.reduction == 2), every(lanes, self.reduction == 4));
        let isotropic = every(lanes, self.isotropic);
        let (right, behind) = (zero.le(x), zero.le(y));
        let signs = [negative.masked((half & behind) | (quarter & right)), negative.masked((half | quarter) & behind)];
        let (x, y) = (x.mul_sign(signs[0]), y.mul_sign(signs[1]));
        let sin2 = lanes.mul_add(x, x, y * y);
        // The azimuth of a `wi` at the normal is 0.
        let turned = isotropic & lanes.splat(POLE).lt(sin2);
        let scale = (one / sin2.sqrt()).masked(turned);
        Oriented { signs, wi: [x, y, z], sin2, turn: [lanes.select(turned, x * scale, one), y * scale] }
    }
}

/// All lanes, or none.
#[inline(always)]
fn every<L: Lanes>(lanes: L, wanted: bool) -> L::M {
    lanes.first_n(if wanted { L::LANES } else { 0 })
}

/// Fills the frame of queries `0..n` of a block. `n` is a multiple of the lanes.
///
/// `cosine` keeps the cosine of `wo` in the values.
#[inline(always)]
pub(super) fn run<L: Lanes>(
    lanes: L,
    n: usize,
    Pairs { wi, wo }: Pairs<'_>,
    symmetry: Symmetry,
    cosine: bool,
    frame: &mut Frame,
) {
    let (zero, one, pole) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(POLE));
    let divide = every(lanes, !cosine);
    let mut query = 0;
    while query < n {
        let Oriented { signs, wi: [ix, iy, iz], sin2, turn: [cos_phi, sin_phi] } =
            symmetry.orient(lanes, wi.load(lanes, query));
        let [ox, oy, oz] = wo.load(lanes, query);
        let (ox, oy) = (ox.mul_sign(signs[0]), oy.mul_sign(signs[1]));

        // Near the normal, the sum of the directions keeps digits of the half vector that a product would lose.
        let (hx, hy, hz) = (ix + ox, iy + oy, iz + oz);
        let across2 = lanes.mul_add(hx, hx, hy * hy);
        // The azimuth of a half vector at the normal is 0, before that of `wi` is subtracted.
        let tilted = pole.lt(across2);
        let (x, y) = (lanes.select(tilted, hx, one), hy.masked(tilted));
        let length2 = lanes.mul_add(hz, hz, across2);
        let length = length2.max(pole).sqrt();
        let inverse = one / length;

        frame.wi[0].store(lanes, query, ix);
        frame.wi[1].store(lanes, query, iy);
        frame.cos_i.store(lanes, query, iz);
        frame.sin2_i.store(lanes, query, sin2);
        frame.across[0].store(lanes, query, lanes.mul_add(cos_phi, x, sin_phi * y));
        frame.across[1].store(lanes, query, lanes.mul_add(cos_phi, y, -(sin_phi * x)));
        frame.cos_m.store(lanes, query, hz * inverse);
        frame.sin2_m.store(lanes, query, across2 * inverse * inverse);
        frame.cos_d.store(lanes, query, lanes.splat(0.5) * length);
        let divisor = lanes.select(divide, oz, one);
        frame.factor.store(lanes, query, one / divisor.max(lanes.splat(FLATTEST)));
        let valid = zero.lt(iz) & zero.lt(oz) & (length2 + sin2).lt(lanes.splat(FARTHEST));
        frame.valid.store(lanes, query, lanes.select_int(valid, lanes.splat_int(-1), lanes.splat_int(0)));
        query += L::LANES;
    }
}
