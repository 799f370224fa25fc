//! The parameters of OpenPBR 1.1 that a measured opaque material determines: base, metalness, specular roughness with
//! its anisotropy, index.
//!
//! The weights of base and specular are 1 and the specular colour is white, because measurements cannot separate them
//! from the colour of the base and the index. Facets reflect once. The diffuse base is dimmed by the albedo of the
//! dielectric facets toward the viewer, which is tabulated with Schlick's Fresnel term.

use std::sync::LazyLock;

use lobe_model::Ggx;

use super::albedo::Albedo;
use super::{diffuse, microfacet, shape, width};
use crate::geometry::Geometry;
use crate::parameter::Parameter;
use crate::real::Real;

pub(super) const METALNESS: Parameter = shape("base_metalness", "share that is metal", [0.0, 1.0]);
pub(super) const ROUGHNESS: Parameter =
    width("specular_roughness", "root of the roughness of the facets", super::ROUGHNESS);
pub(super) const IOR: Parameter = shape("specular_ior", "refractive index of the dielectric part", [1.01, 3.0]);
pub(super) const DIFFUSE_ROUGHNESS: Parameter =
    shape("base_diffuse_roughness", "roughness of the diffuse base", [0.0, 1.0]);
pub(super) const ANISOTROPY: Parameter = shape(
    "specular_roughness_anisotropy",
    "anisotropy: the excess roughness of one direction over the other",
    [0.0, 0.99],
);
pub(super) const ROTATION: Parameter =
    shape("rotation", "azimuth of the rougher direction, in degrees", [-100.0, 100.0]);

pub(super) fn f<T: Real>(geometry: &Geometry, shape: [T; 6], color: T) -> T {
    let [metalness, roughness, ior, diffuse_roughness, anisotropy, rotation] = shape;
    let narrow = anisotropy.rest();
    let along = roughness.square() * ((narrow.square() + 1.0).recip() * 2.0).sqrt();
    let facets = microfacet::mirrors(geometry, [along, along * narrow], rotation);
    let metal = facets * microfacet::schlick(geometry.cos_d, color);
    let passed = albedo(geometry.cos_o(), roughness, ior).rest();
    let dielectric = facets * fresnel(geometry.cos_d, ior) + passed * diffuse::eon(geometry, diffuse_roughness, color);
    dielectric.lerp(metal, metalness)
}

/// Fresnel's reflectance of a dielectric for unpolarised light.
fn fresnel<T: Real>(cos: f64, ior: T) -> T {
    let g = (ior.square() + (cos * cos - 1.0)).sqrt();
    let (less, more) = (g - cos, g + cos);
    let parallel = (more * cos - 1.0) / (less * cos + 1.0);
    (less / more).square() * (parallel.square() + 1.0) * 0.5
}

/// The share of the light that isotropic facets of a dielectric reflect.
fn albedo<T: Real>(cos: f64, roughness: T, ior: T) -> T {
    let f0 = ((ior - 1.0) / (ior + 1.0)).square();
    f0.rest() * GRAZING.at(cos, roughness) + f0 * MIRRORS.at(cos, roughness)
}

/// The share of the light that facets reflect if they are perfect mirrors.
static MIRRORS: LazyLock<Albedo> =
    LazyLock::new(|| Albedo::new(super::ROUGHNESS[0], |cos, roughness| facets(cos, roughness, |_| 1.0)));
/// The share that facets reflect with the factor `(1 - cos)^5`, the part of Schlick's term that does not depend on the
/// index.
static GRAZING: LazyLock<Albedo> = LazyLock::new(|| {
    Albedo::new(super::ROUGHNESS[0], |cos, roughness| facets(cos, roughness, |cos| (1.0 - cos).powi(5)))
});

/// Facets visible to the viewer, weighted with the masking of the light that they reflect.
fn facets(cos: f64, roughness: f64, fresnel: impl Fn(f64) -> f64) -> f64 {
    const SIDE: usize = 12;
    let ggx = Ggx { alpha: [roughness * roughness; 2] };
    let wo = [(1.0 - cos * cos).sqrt(), 0.0, cos];
    let mut sum = 0.0;
    for index in 0..SIDE * SIDE {
        let u = [(index / SIDE) as f64 + 0.5, (index % SIDE) as f64 + 0.5].map(|u| u / SIDE as f64);
        let h = ggx.visible_normal(wo, u);
        let cos_d = wo[0] * h[0] + wo[2] * h[2];
        let wi = [2.0 * cos_d * h[0] - wo[0], 2.0 * cos_d * h[1], 2.0 * cos_d * h[2] - wo[2]];
        if wi[2] > 0.0 {
            let seen = 1.0 + ggx.lambda(wo);
            sum += fresnel(cos_d) * seen / (seen + ggx.lambda(wi));
        }
    }
    sum / (SIDE * SIDE) as f64
}
