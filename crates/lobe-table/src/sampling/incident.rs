//! The geometry of scattering for one incident direction per lane: the hemisphere as a rectangle.
//!
//! About the zenith of the scattered light (see [`coords`](crate::specular::coords)), the horizon is at a theta that
//! depends on phi: with the zenith at polar angle `z`, `wo` is above the horizon if `cos z cos theta + sin z cos phi
//! sin theta > 0`, that is, up to `tan(theta_max - pi/2) = tan z cos phi`. With `height = 1 - cos theta_max`, the
//! coordinate
//!
//! `v = (1 - cos theta) / height(phi)` in `[0, 1)`
//!
//! and phi in `[0, 2 pi)` cover the hemisphere and nothing below it. The Jacobian is simple, `sin theta dtheta dphi =
//! height(phi) dv dphi`, it is finite at the peak, and neither direction of the map needs a trigonometric function of
//! theta.

use lobe_lane::{Floats, Lanes};

use crate::Scatter;
use crate::grid::function::Function;
use crate::passes::unit::{FARTHEST, POLE};
use crate::specular::frame::{Refracted, Zenith};

/// The properties on which the frame of scattered light depends, in addition to the incident direction.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    pub(crate) scatter: Scatter,
    /// The angle by which refraction turns the zenith, by sigma.
    pub(crate) refraction: Option<Function>,
}

/// An incident direction in each lane, and the frame of its scattered light.
#[derive(Clone, Copy)]
pub(crate) struct Incident<L: Lanes> {
    /// Cosine of the polar angle, and its squared sine.
    pub(crate) cos: L::F,
    pub(crate) sin2: L::F,
    /// Cosine and sine of psi.
    pub(crate) psi: [L::F; 2],
    /// The zenith mirrored about the normal, and the sine of its polar angle.
    opposite: [L::F; 3],
    sin_zenith: L::F,
    /// The sign of z of scattered directions.
    side: L::F,
    /// Set if the direction is finite and above the horizon.
    pub(crate) valid: L::M,
}

/// A scattered direction about the zenith.
#[derive(Clone, Copy)]
pub(crate) struct Local<L: Lanes> {
    pub(crate) v: L::F,
    pub(crate) phi: L::F,
    pub(crate) height: L::F,
    /// Set if the direction is finite and above the horizon.
    pub(crate) valid: L::M,
}

impl<L: Lanes> Incident<L> {
    #[inline(always)]
    pub(crate) fn new(lanes: L, surface: &Surface, [x, y, z]: [L::F; 3]) -> Self {
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let (cos, side) = match surface.scatter {
            Scatter::Reflection => (z, one),
            Scatter::Transmission => (z.abs(), -one.mul_sign(z)),
        };
        let sin2 = lanes.mul_add(x, x, y * y);
        let sin = sin2.sqrt();
        let tilted = lanes.splat(POLE).lt(sin2);
        let scale = (one / sin).masked(tilted);
        let psi = [lanes.select(tilted, x * scale, one), y * scale];
        let (opposite, sin_zenith) = match &surface.refraction {
            None => ([x, y, cos], sin),
            Some(offset) => Refracted(offset).opposite(lanes, [x, y, cos], sin, psi),
        };
        let valid = zero.lt(cos) & lanes.mul_add(cos, cos, sin2).lt(lanes.splat(FARTHEST));
        Incident { cos, sin2, psi, opposite, sin_zenith, side, valid }
    }

    /// `1 - cos theta_max` at an azimuth whose cosine is given.
    #[inline(always)]
    pub(crate) fn height(&self, lanes: L, cos_phi: L::F) -> L::F {
        // cos theta_max = -a / q with a = sin z cos phi and q^2 = a^2 + cos^2 z. If a < 0, the difference 1 + a / q
        // would cancel, so it is written as cos^2 z / (q (q - a)).
        let cos_zenith = self.opposite[2];
        let a = self.sin_zenith * cos_phi;
        let cos2 = cos_zenith * cos_zenith;
        let least = lanes.splat(f32::MIN_POSITIVE);
        let q = lanes.mul_add(a, a, cos2).sqrt().max(least);
        let sum = q + a.abs();
        let numerator = lanes.select(a.lt(lanes.splat(0.0)), cos2 / sum, sum);
        (numerator / q).max(lanes.splat(1e-20))
    }

    /// The direction with `1 - cos theta = rest` at an azimuth about the zenith, never below the horizon.
    #[inline(always)]
    pub(crate) fn direction(&self, lanes: L, rest: L::F, [cos_phi, sin_phi]: [L::F; 2]) -> [L::F; 3] {
        let [cos_psi, sin_psi] = self.psi;
        let sin = (rest * (lanes.splat(2.0) - rest)).max(lanes.splat(0.0)).sqrt();
        let (toward, y) = (sin * cos_phi, sin * sin_phi);
        let along = lanes.splat(1.0) - rest;
        let cos_zenith = self.opposite[2];
        let x = lanes.mul_add(cos_zenith, toward, -(self.sin_zenith * along));
        let z = lanes.mul_add(self.sin_zenith, toward, cos_zenith * along);
        // Rounding alone could put a direction at the horizon below it.
        let z = z.max(lanes.splat(1e-9)) * self.side;
        [lanes.mul_add(cos_psi, x, -(sin_psi * y)), lanes.mul_add(sin_psi, x, cos_psi * y), z]
    }

    /// The place of a scattered direction about the zenith.
    #[inline(always)]
    pub(crate) fn locate(&self, lanes: L, [ox, oy, oz]: [L::F; 3]) -> Local<L> {
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let ([cos_psi, sin_psi], [ax, ay, cos_zenith]) = (self.psi, self.opposite);
        let oz = oz * self.side;
        // Near the peak, the difference of wo and the zenith keeps digits that a product would lose.
        let (dx, dy, dz) = (ox + ax, oy + ay, oz - cos_zenith);
        let toward = lanes.mul_add(cos_psi, dx, sin_psi * dy);
        let y = lanes.mul_add(cos_psi, dy, -(sin_psi * dx));
        let x = lanes.mul_add(cos_zenith, toward, self.sin_zenith * dz);
        let distance2 = lanes.mul_add(dx, dx, lanes.mul_add(dy, dy, dz * dz));
        let across = lanes.mul_add(x, x, y * y).sqrt();
        let cos_phi = lanes.select(zero.lt(across), x / across, one);
        let phi = lobe_math::azimuth(lanes, y, x);
        let height = self.height(lanes, cos_phi);
        let v = (lanes.splat(0.5) * distance2 / height).min(one);
        Local { v, phi, height, valid: self.valid & zero.lt(oz) & distance2.lt(lanes.splat(FARTHEST)) }
    }
}
