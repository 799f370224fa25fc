//! Samples rays that leave lights, for paths that begin there.

use std::f32::consts::{FRAC_1_PI, PI};

use lobe_lane::{Floats, Lanes};
use lobe_scalar::Reference;

use super::Light;
use super::sample::{EmissionPdf, EmissionSample, SceneBounds};
use super::spot_share;
use crate::channels::Channels;
use crate::vec3::Vec3;
use crate::vectors::{add, disk, frame_of, neg, sin_cos, to_world};

impl<S: Channels> Light<S> {
    /// Samples rays that leave the light, from four numbers in `[0, 1)` each: two for the position, two for the
    /// direction.
    ///
    /// The mean of `emitted / (pdf.position * pdf.direction)` is the [`power`](Light::power).
    #[inline(always)]
    pub fn sample_le<L: Lanes>(&self, lanes: L, bounds: &SceneBounds, u: [L::F; 4]) -> EmissionSample<L, S> {
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let always = zero.lt(one);
        match self {
            Light::Point { position, intensity } => {
                let pdf = EmissionPdf { position: one, direction: lanes.splat(0.25 * FRAC_1_PI) };
                let direction = cone(lanes, [u[2], u[3]], -1.0);
                let emitted = intensity.in_lanes(lanes);
                EmissionSample { origin: lanes.splat_xyz(*position), direction, emitted, pdf, valid: always }
            }
            Light::Spot { position, direction: axis, intensity, falloff } => {
                let local = cone(lanes, [u[2], u[3]], falloff[1]);
                let direction = to_world::<L>(frame_of(lanes, lanes.splat_xyz(*axis)), local);
                let share = spot_share(lanes, *falloff, local[2]);
                let mut emitted = intensity.in_lanes(lanes);
                for channel in emitted.as_mut() {
                    *channel = *channel * share;
                }
                let pdf = EmissionPdf { position: one, direction: lanes.splat(cone_pdf(falloff[1])) };
                EmissionSample { origin: lanes.splat_xyz(*position), direction, emitted, pdf, valid: zero.lt(share) }
            }
            Light::Directional { toward, irradiance } => {
                let toward = lanes.splat_xyz(*toward);
                let pdf = EmissionPdf { position: lanes.splat(disk_pdf(bounds)), direction: one };
                let origin = on_disk(lanes, bounds, toward, [u[0], u[1]]);
                let emitted = irradiance.in_lanes(lanes);
                EmissionSample { origin, direction: neg::<L>(toward), emitted, pdf, valid: always }
            }
            Light::Area(area) => area.sample_le(lanes, u),
            Light::Environment(environment) => {
                let sample = environment.sample_li(lanes, [u[2], u[3]]);
                let pdf = EmissionPdf { position: lanes.splat(disk_pdf(bounds)), direction: sample.pdf };
                let origin = on_disk(lanes, bounds, sample.wi, [u[0], u[1]]);
                let direction = neg::<L>(sample.wi);
                EmissionSample { origin, direction, emitted: sample.radiance, pdf, valid: sample.valid }
            }
        }
    }

    /// The densities with which [`sample_le`](Light::sample_le) samples a ray in this unit direction. `cos` is the
    /// cosine between the direction and the normal of the triangle where the ray leaves an area light; other lights
    /// ignore it.
    ///
    /// The direction of a directional light has density 1, because no other can be sampled.
    pub fn pdf_le(&self, bounds: &SceneBounds, direction: [f32; 3], cos: f32) -> EmissionPdf<f32> {
        match self {
            Light::Point { .. } => EmissionPdf { position: 1.0, direction: 0.25 * FRAC_1_PI },
            Light::Spot { direction: axis, falloff, .. } => {
                let inside = crate::vec3::dot(direction, *axis) >= falloff[1];
                EmissionPdf { position: 1.0, direction: if inside { cone_pdf(falloff[1]) } else { 0.0 } }
            }
            Light::Directional { .. } => EmissionPdf { position: disk_pdf(bounds), direction: 1.0 },
            Light::Area(area) => {
                let lanes = Reference::default();
                let pdf = area.pdf_le(lanes, lanes.splat(cos));
                EmissionPdf { position: lanes.extract(pdf.position, 0), direction: lanes.extract(pdf.direction, 0) }
            }
            Light::Environment(environment) => {
                let wi: Vec3 = direction.map(|x| -x);
                EmissionPdf { position: disk_pdf(bounds), direction: environment.radiance_and_pdf(wi).1 }
            }
        }
    }
}

/// Uniform directions in the cone about +z with cosines of at least `least`; -1 means the whole sphere.
#[inline(always)]
fn cone<L: Lanes>(lanes: L, [u, v]: [L::F; 2], least: f32) -> [L::F; 3] {
    let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
    let z = one - u * lanes.splat(1.0 - least);
    let radius = (one - z * z).max(zero).sqrt();
    let [sin, cos] = sin_cos(lanes, v);
    [radius * cos, radius * sin, z]
}

fn cone_pdf(least: f32) -> f32 {
    1.0 / (2.0 * PI * (1.0 - least))
}

/// Uniform points on the disk through which light from the direction `toward` enters the scene.
#[inline(always)]
fn on_disk<L: Lanes>(lanes: L, bounds: &SceneBounds, toward: [L::F; 3], u: [L::F; 2]) -> [L::F; 3] {
    let radius = lanes.splat(bounds.radius as f32);
    let [x, y] = disk(lanes, u);
    let local = [x * radius, y * radius, radius];
    add::<L>(lanes.splat_xyz(bounds.center), to_world::<L>(frame_of(lanes, toward), local))
}

fn disk_pdf(bounds: &SceneBounds) -> f32 {
    (1.0 / (std::f64::consts::PI * bounds.radius * bounds.radius)) as f32
}

#[cfg(test)]
mod tests;
