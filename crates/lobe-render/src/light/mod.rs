//! Lights and their sampling: toward a light from points of surfaces, and along rays that leave it.

mod area;
mod cdf;
mod emission;
mod emit;
mod environment;
mod list;
mod polarised;
mod sample;

pub use area::AreaLight;
pub use environment::{Environment, EnvironmentError};
pub(crate) use list::Lights;
pub use polarised::LightPolarisation;
pub use sample::{EmissionPdf, EmissionSample, LightRay, LightSample, SceneBounds};

use lobe_lane::{Floats, Lanes};
use lobe_scalar::Reference;

use crate::channels::Channels;
use crate::vectors::{dot, scale, sub};

/// A light that emits `S`.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Light<S: Channels = [f32; 3]> {
    /// A point light, which emits in all directions.
    Point {
        /// Its position.
        position: [f32; 3],
        /// Radiant intensity in W/sr.
        intensity: S,
    },
    /// A spot light, which emits from a point into a cone.
    Spot {
        /// Its position.
        position: [f32; 3],
        /// The axis, a unit vector away from the light.
        direction: [f32; 3],
        /// Radiant intensity along the axis in W/sr.
        intensity: S,
        /// Cosines of the angles from the axis at which the light begins to fall off and at which it ends, the larger
        /// cosine first.
        falloff: [f32; 2],
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// A unit vector toward the light.
        toward: [f32; 3],
        /// Irradiance of a surface that faces the light, in W/m^2.
        irradiance: S,
    },
    /// Triangles that radiate.
    Area(AreaLight<S>),
    /// Radiance from all directions.
    Environment(Environment<S>),
}

impl<S: Channels> Light<S> {
    /// Samples the light as seen from the points `from`.
    #[inline(always)]
    pub fn sample_li<L: Lanes>(&self, lanes: L, from: [L::F; 3], u: [L::F; 2]) -> LightSample<L, S> {
        match self {
            Light::Point { position, intensity } => point(lanes, from, *position, *intensity),
            Light::Spot { position, direction, intensity, falloff } => {
                let sample = point(lanes, from, *position, *intensity);
                let cos = -dot::<L>(sample.wi, lanes.splat_xyz(*direction));
                let share = spot_share(lanes, *falloff, cos);
                LightSample { valid: sample.valid & lanes.splat(0.0).lt(share), ..sample.scaled(share) }
            }
            Light::Directional { toward, irradiance } => {
                let (wi, infinite) = (lanes.splat_xyz(*toward), lanes.splat(f32::INFINITY));
                LightSample::new(lanes, wi, infinite, *irradiance, infinite, infinite.eq(infinite))
            }
            Light::Area(area) => area.sample_li(lanes, from, u),
            Light::Environment(environment) => environment.sample_li(lanes, u),
        }
    }

    /// The density over solid angle, 1/sr, with which [`sample_li`](Light::sample_li) finds the end of a ray that has
    /// reached this light; 0 for a light without extent, which no ray reaches by chance.
    #[inline]
    pub fn pdf_li(&self, ray: &LightRay) -> f32 {
        match self {
            Light::Area(area) => {
                let lanes = Reference::default();
                lanes.extract(area.pdf_li(lanes, lanes.splat(ray.distance), lanes.splat(ray.cos)), 0)
            }
            Light::Environment(environment) => environment.radiance_and_pdf(ray.wi).1,
            Light::Point { .. } | Light::Spot { .. } | Light::Directional { .. } => 0.0,
        }
    }

    /// `true` if the light has no extent, so that no ray reaches it by chance.
    pub fn is_delta(&self) -> bool {
        match self {
            Light::Point { .. } | Light::Spot { .. } | Light::Directional { .. } => true,
            Light::Area(_) | Light::Environment(_) => false,
        }
    }

    /// `true` if its rays begin on triangles of the scene.
    pub(crate) fn has_surface(&self) -> bool {
        matches!(self, Light::Area(_))
    }

    /// The approximate power that reaches a scene of this radius, by which lights are chosen. A two-sided light counts
    /// with one side only; [`power`](Light::power) counts both.
    fn weight(&self, radius: f64) -> f64 {
        let one_sided = if let Light::Area(area) = self { if area.is_two_sided() { 0.5 } else { 1.0 } } else { 1.0 };
        one_sided * self.power(radius)
    }

    /// The mean over channels of the power in W that enters a sphere of this radius around the scene.
    pub fn power(&self, radius: f64) -> f64 {
        use std::f64::consts::PI;
        let mean = |x: &S| x.as_ref().iter().map(|x| f64::from(*x)).sum::<f64>() / S::COUNT as f64;
        let disk = PI * radius * radius;
        match self {
            Light::Point { intensity, .. } => 4.0 * PI * mean(intensity),
            Light::Spot { intensity, falloff, .. } => {
                2.0 * PI * (1.0 - 0.5 * f64::from(falloff[0] + falloff[1])) * mean(intensity)
            }
            Light::Directional { irradiance, .. } => disk * mean(irradiance),
            Light::Area(area) => {
                let sides = if area.is_two_sided() { 2.0 } else { 1.0 };
                sides * (PI * area.area() * mean(&area.radiance()))
            }
            Light::Environment(environment) => 4.0 * PI * disk * environment.mean(),
        }
    }
}

/// A point light as seen from points.
#[inline(always)]
fn point<L: Lanes, S: Channels>(lanes: L, from: [L::F; 3], position: [f32; 3], intensity: S) -> LightSample<L, S> {
    let toward = sub::<L>(lanes.splat_xyz(position), from);
    let (zero, one, infinite) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(f32::INFINITY));
    let distance = dot::<L>(toward, toward).sqrt();
    let near = one / (distance * distance);
    let wi = scale::<L>(toward, one / distance);
    let valid = zero.lt(distance) & near.lt(infinite);
    LightSample::new(lanes, wi, distance, intensity, infinite, valid).scaled(near)
}

/// The share of a spot light's intensity at this cosine to its axis, smooth between the two angles.
#[inline(always)]
fn spot_share<L: Lanes>(lanes: L, [full, none]: [f32; 2], cos: L::F) -> L::F {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let t = (cos - lanes.splat(none)) / lanes.splat((full - none).max(1e-6));
    let t = t.max(zero).min(one);
    t * t * (lanes.splat(3.0) - lanes.splat(2.0) * t)
}
