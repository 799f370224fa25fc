//! From directions to the four angles, with one arc cosine each.

use std::f32::consts::TAU;

use lobe_lane::{Floats, Lanes};

/// Sigma, psi (0 unless `anisotropic`), theta and phi in radians; see [`coords`](crate::specular::coords) for the
/// geometry.
#[inline(always)]
pub(super) fn angles<L: Lanes>(lanes: L, wi: [L::F; 3], wo: [L::F; 3], anisotropic: bool) -> [L::F; 4] {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let [ix, iy, iz] = wi;
    let [ox, oy, oz] = wo;

    let sin_sigma = lanes.mul_add(ix, ix, iy * iy).sqrt();
    let tilted = zero.lt(sin_sigma);
    let scale = one / lanes.select(tilted, sin_sigma, one);
    let (cos_psi, sin_psi) = (lanes.select(tilted, ix * scale, one), iy * scale);
    let toward = lanes.mul_add(cos_psi, ox, sin_psi * oy);
    let y = lanes.mul_add(cos_psi, oy, -(sin_psi * ox));
    let x = lanes.mul_add(iz, toward, sin_sigma * oz);
    let z = lanes.mul_add(iz, oz, -(sin_sigma * toward));

    let length = lanes.mul_add(x, x, y * y).sqrt();
    let off_axis = zero.lt(length);
    let cos_phi = lanes.select(off_axis, x / lanes.select(off_axis, length, one), one);
    let psi = if anisotropic { turn(lanes, cos_psi, sin_psi) } else { zero };
    [acos(lanes, iz), psi, acos(lanes, z), turn(lanes, cos_phi, y)]
}

/// The angle in `[0, 2 pi]` of a cosine and of anything with the sign of the sine.
#[inline(always)]
fn turn<L: Lanes>(lanes: L, cos: L::F, sin: L::F) -> L::F {
    let half_turn = acos(lanes, cos);
    lanes.select(sin.lt(lanes.splat(0.0)), lanes.splat(TAU) - half_turn, half_turn)
}

/// The four-term arc cosine, for arguments that rounding may have moved outside `[-1, 1]`.
#[inline(always)]
fn acos<L: Lanes>(lanes: L, cos: L::F) -> L::F {
    let one = lanes.splat(1.0);
    lobe_math::paper::acos(lanes, cos.max(-one).min(one))
}

/// The lanes in which both directions are finite and above the horizon.
#[inline(always)]
pub(super) fn above_horizon<L: Lanes>(lanes: L, wi: [L::F; 3], wo: [L::F; 3]) -> L::M {
    let (zero, limit) = (lanes.splat(0.0), lanes.splat(2.0));
    let mut valid = zero.lt(wi[2]) & zero.lt(wo[2]);
    let mut axis = 0;
    while axis < 3 {
        valid = valid & wi[axis].abs().lt(limit) & wo[axis].abs().lt(limit);
        axis += 1;
    }
    valid
}
