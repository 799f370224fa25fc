//! Directions to what the angles are computed from.

use lobe_lane::{Floats, Lanes};

use crate::directions::BlockOfDirections;
use crate::passes::block::Column;
use crate::passes::frame::{FARTHEST, POLE};

/// The columns that the first pass fills.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    /// x and y of `wi`, moved to the azimuths that are stored; its z and its squared sine.
    pub(super) wi: [Column; 2],
    pub(super) cos_i: Column,
    pub(super) sin2_i: Column,
    /// x and y along the azimuth of the half vector; in isotropic materials less the azimuth of `wi`.
    pub(super) across: [Column; 2],
    /// The half vector's cosine and squared sine.
    pub(super) cos_m: Column,
    pub(super) sin2_m: Column,
    /// Cosine of the angle between the half vector and either direction.
    pub(super) cos_d: Column,
    /// What every value is multiplied by so far: 1, or the inverse of the cosine of `wo`.
    pub(super) factor: Column,
    /// All bits set where both directions are finite and above the surface.
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

/// The least cosine that is divided by: the inverse of a smaller one would overflow in products.
const FLATTEST: f32 = 1e-20;

/// What a material says of azimuths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Symmetry {
    pub(super) isotropic: bool,
    /// 1, 2 or 4: see [`Rgl::reduction`](crate::rgl::Rgl::reduction).
    pub(super) reduction: u32,
}

impl Symmetry {
    /// -0.0 in the lanes where x and where y of both directions must change sign to get into the azimuths that are
    /// stored, +0.0 elsewhere.
    #[inline(always)]
    pub(super) fn signs<L: Lanes>(self, lanes: L, x: L::F, y: L::F) -> [L::F; 2] {
        let (zero, turn) = (lanes.splat(0.0), lanes.splat(-0.0));
        let half = lanes.first_n(if self.reduction == 2 { L::LANES } else { 0 });
        let quarter = lanes.first_n(if self.reduction == 4 { L::LANES } else { 0 });
        let (right, behind) = (zero.le(x), zero.le(y));
        [turn.masked((half & behind) | (quarter & right)), turn.masked((half | quarter) & behind)]
    }
}

/// Fills the frame of queries `0..n` of a block. `n` is a multiple of the lanes.
///
/// `cosine` leaves the cosine of `wo` in the values.
#[inline(always)]
pub(super) fn run<L: Lanes, B: BlockOfDirections>(
    lanes: L,
    n: usize,
    (wi, wo): (B, B),
    symmetry: Symmetry,
    cosine: bool,
    frame: &mut Frame,
) {
    let (zero, one, pole) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(POLE));
    let isotropic = lanes.first_n(if symmetry.isotropic { L::LANES } else { 0 });
    let divide = lanes.first_n(if cosine { 0 } else { L::LANES });
    let mut query = 0;
    while query < n {
        let [ix, iy, iz] = wi.load(lanes, query);
        let [ox, oy, oz] = wo.load(lanes, query);
        let [sign_x, sign_y] = symmetry.signs(lanes, ix, iy);
        let (ix, ox, iy, oy) = (ix.mul_sign(sign_x), ox.mul_sign(sign_x), iy.mul_sign(sign_y), oy.mul_sign(sign_y));

        let sin2 = lanes.mul_add(ix, ix, iy * iy);
        let turned = isotropic & pole.lt(sin2);
        let scale = (one / sin2.sqrt()).masked(turned);
        let (cos_phi, sin_phi) = (lanes.select(turned, ix * scale, one), iy * scale);

        // The sum of the directions has the digits of a half vector near the normal that a product would lose.
        let (hx, hy, hz) = (ix + ox, iy + oy, iz + oz);
        let across2 = lanes.mul_add(hx, hx, hy * hy);
        // The azimuth of a half vector at the normal is 0, before that of `wi` is taken off.
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
