//! Diffuse surfaces.

use std::f64::consts::PI;

use crate::geometry::Geometry;
use crate::real::Real;

pub(super) fn lambert<T: Real>(albedo: T) -> T {
    albedo / PI
}

/// Equation 30 of Oren and Nayar 1994, as in `lobe_model::OrenNayar`.
pub(super) fn oren_nayar<T: Real>(geometry: &Geometry, degrees: T, albedo: T) -> T {
    let s2 = (degrees * (PI / 180.0)).square();
    let a = (s2 / (s2 + 0.33) * 0.5).rest();
    let b = s2 / (s2 + 0.09) * 0.45;
    let Geometry { wi, wo, .. } = geometry;
    let along = (wi[0] * wo[0] + wi[1] * wo[1]).max(0.0);
    albedo / PI * (a + b * (along / wi[2].max(wo[2])))
}

/// The energy-preserving form of Oren and Nayar's model that OpenPBR prescribes: J. Portsmouth, P. Kutz and S. Hill,
/// *EON: A practical energy-preserving rough diffuse BRDF*, JCGT 14(1), 2025, with the polynomial of its section 3.2
/// for the albedo.
pub(super) fn eon<T: Real>(geometry: &Geometry, roughness: T, albedo: T) -> T {
    const C1: f64 = 0.5 - 2.0 / (3.0 * PI);
    const C2: f64 = 2.0 / 3.0 - 28.0 / (15.0 * PI);
    let Geometry { wi, wo, .. } = geometry;
    let s = wi[0] * wo[0] + wi[1] * wo[1];
    let s_over_t = if s > 0.0 { s / wi[2].max(wo[2]) } else { s };
    let af = (roughness * C1 + 1.0).recip();
    let once = albedo / PI * af * (roughness * s_over_t + 1.0);
    let reflected = |cos: f64| {
        let m = 1.0 - cos;
        let g = m * (0.057_108_528_9 + m * (0.491_881_867 + m * (-0.332_181_442 + m * 0.071_442_995_3)));
        af * (roughness * g + 1.0)
    };
    let mean = af * (roughness * C2 + 1.0);
    let again = albedo.square() * mean / (albedo * mean.rest()).rest();
    let lost = mean.rest().value();
    if lost < 1e-7 {
        return once;
    }
    once + again / PI * reflected(wi[2]).rest() * reflected(wo[2]).rest() / mean.rest()
}
