//! The metallic-roughness model of glTF 2.0, appendix B, and two of its extensions.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use super::albedo::Albedo;
use super::{microfacet, shape, width};
use crate::geometry::Geometry;
use crate::parameter::Parameter;
use crate::real::Real;

pub(super) const METALLIC: Parameter = shape("metallic", "share that is metal", [0.0, 1.0]);
pub(super) const ROUGHNESS: Parameter = width("roughness", "root of the roughness of the facets", super::ROUGHNESS);
pub(super) const CLEARCOAT: Parameter = shape("clearcoat", "share that is coated", [0.0, 1.0]);
pub(super) const CLEARCOAT_ROUGHNESS: Parameter =
    width("clearcoat_roughness", "root of the roughness of the coat", super::ROUGHNESS);
pub(super) const SHEEN: Parameter = shape("sheen", "the sheen, equal in all channels", [0.0, 1.0]);
pub(super) const SHEEN_ROUGHNESS: Parameter =
    width("sheen_roughness", "root of the roughness of the sheen", [LEAST_SHEEN, 1.0]);

/// The reflectance along the normal of a surface with index 1.5.
const DIELECTRIC: f64 = 0.04;

fn facets<T: Real>(geometry: &Geometry, roughness: T) -> T {
    let alpha = roughness.square();
    microfacet::mirrors(geometry, [alpha, alpha], T::of(0.0))
}

pub(super) fn base<T: Real>(geometry: &Geometry, metallic: T, roughness: T, color: T) -> T {
    let f0 = T::of(DIELECTRIC).lerp(color, metallic);
    let fresnel = microfacet::schlick(geometry.cos_d, f0);
    let diffuse = fresnel.rest() * color * metallic.rest() / PI;
    diffuse + fresnel * facets(geometry, roughness)
}

/// A clear coat on `base`: the facets of the coat, with the Fresnel term of the viewer's direction, dim the base.
pub(super) fn coated<T: Real>(geometry: &Geometry, base: T, coat: T, roughness: T) -> T {
    let reflected = coat * microfacet::schlick(geometry.cos_o(), DIELECTRIC);
    base.lerp(facets(geometry, roughness), reflected)
}

/// Fibres over `base`: the distribution of A. Estevez and C. Kulla, *Production friendly microfacet sheen BRDF*, 2017,
/// with the visibility of M. Ashikhmin and S. Premoze, *Distribution-based BRDFs*, 2007.
pub(super) fn sheen<T: Real>(geometry: &Geometry, base: T, sheen: T, roughness: T) -> T {
    let (cos_i, cos_o) = (geometry.cos_i(), geometry.cos_o());
    let lost = FIBRES.at(cos_i, roughness);
    let lost_o = FIBRES.at(cos_o, roughness);
    let lost = if lost.value() > lost_o.value() { lost } else { lost_o };
    sheen * fibres(geometry.h[2], cos_i, cos_o, roughness) + base * (sheen * lost).rest()
}

fn fibres<T: Real>(cos_h: f64, cos_i: f64, cos_o: f64, roughness: T) -> T {
    let inverse = roughness.square().recip();
    let distribution = (inverse + 2.0) * T::of(1.0 - cos_h * cos_h).powf(inverse * 0.5) / TAU;
    distribution / (4.0 * (cos_i + cos_o - cos_i * cos_o))
}

const LEAST_SHEEN: f64 = 0.1;
/// The share of the light that white fibres reflect.
static FIBRES: LazyLock<Albedo> = LazyLock::new(|| Albedo::new(LEAST_SHEEN, integral));

/// Midpoints of equal projected solid angles.
fn integral(cos: f64, roughness: f64) -> f64 {
    const RINGS: usize = 40;
    let sin = (1.0 - cos * cos).sqrt();
    let mut sum = 0.0;
    for ring in 0..RINGS {
        let sin2 = (ring as f64 + 0.5) / RINGS as f64;
        let (s, c) = (sin2.sqrt(), (1.0 - sin2).sqrt());
        for sector in 0..RINGS {
            let phi = PI * (sector as f64 + 0.5) / RINGS as f64;
            let geometry = Geometry::new([sin, 0.0, cos], [s * phi.cos(), s * phi.sin(), c]);
            sum += fibres(geometry.h[2], cos, c, roughness);
        }
    }
    PI * sum / (RINGS * RINGS) as f64
}
