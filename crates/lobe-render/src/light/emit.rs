//! Samples rays that leave any of the lights of a scene.

use lobe_lane::{Floats, Ints, Lanes, MAX_LANES, Mask};
use lobe_scalar::Reference;

use super::sample::{EmissionPdf, EmissionSample};
use super::{Light, Lights};
use crate::channels::Channels;
use crate::vec3::Vec3;
use crate::vectors::select;

/// Rays that leave randomly chosen lights, one per lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Emitting<L: Lanes, S: Channels> {
    /// The number of the light.
    pub light: L::I,
    /// Its ray, whose densities do not include the probability of the light.
    pub sample: EmissionSample<L, S>,
}

impl<S: Channels> Lights<S> {
    /// The light that a number in `[0, 1)` chooses.
    pub fn chosen(&self, choice: f32) -> usize {
        let lanes = Reference::default();
        let (chosen, _) = self.cdf.sample(lanes, lanes.splat_int(0), lanes.splat(choice));
        lanes.extract_int(chosen, 0) as usize
    }

    /// Samples rays that leave lights, which are chosen by `choice`. There must be a light.
    #[inline(always)]
    pub fn sample_le<L: Lanes>(&self, lanes: L, choice: L::F, u: [L::F; 4]) -> Emitting<L, S> {
        let (chosen, _) = self.cdf.sample(lanes, lanes.splat_int(0), choice);
        let mut numbers = [0; MAX_LANES];
        lanes.store_int(&mut numbers, chosen);
        let zero = lanes.splat(0.0);
        let mut sample = EmissionSample {
            origin: [zero; 3],
            direction: [zero; 3],
            emitted: S::ZERO.in_lanes(lanes),
            pdf: EmissionPdf { position: zero, direction: zero },
            valid: zero.lt(zero),
        };
        let mut left = (1u32 << L::LANES) - 1;
        while left != 0 {
            let number = numbers[left.trailing_zeros() as usize & (MAX_LANES - 1)];
            let here = chosen.eq(lanes.splat_int(number));
            let other = self.all[number as usize].sample_le(lanes, &self.bounds, u);
            sample = merged(lanes, here, other, sample);
            left &= !here.bits();
        }
        Emitting { light: chosen, sample }
    }

    /// The density over a surface with which a light that was sampled for it sends rays there, over the density with
    /// which light paths begin at the same point of the light. `pdf` is the density of the sample, 1/sr; the light is
    /// at the given distance from the surface, in the unit direction `wi`, at the cosine `cos`.
    pub fn back(&self, light: usize, wi: Vec3, distance: f32, pdf: f32, cos: f32) -> f32 {
        let direction = wi.map(|x| -x);
        match &self.all[light] {
            Light::Point { .. } | Light::Spot { .. } => {
                self.all[light].pdf_le(&self.bounds, direction, 1.0).direction * cos / (distance * distance)
            }
            Light::Directional { .. } | Light::Environment(_) => self.disk() * cos,
            Light::Area(area) => {
                // The cosine at the light, from the density of the sample.
                let at_light = self.chances[light] * distance * distance / (pdf * area.area() as f32);
                let front = if area.is_two_sided() { 0.5 } else { 1.0 };
                front * std::f32::consts::FRAC_1_PI * at_light * cos / (distance * distance)
            }
        }
    }

    /// Density over the area of the disk through which light from infinitely far away enters the scene.
    pub fn disk(&self) -> f32 {
        (1.0 / (std::f64::consts::PI * self.bounds.radius * self.bounds.radius)) as f32
    }

    /// `true` if any light emits.
    pub fn emit(&self) -> bool {
        self.all.iter().any(|light| light.power(self.bounds.radius) > 0.0)
    }
}

#[inline(always)]
fn merged<L: Lanes, S: Channels>(
    lanes: L,
    mask: L::M,
    a: EmissionSample<L, S>,
    mut b: EmissionSample<L, S>,
) -> EmissionSample<L, S> {
    let (into, from) = (b.emitted.as_mut(), a.emitted.as_ref());
    let mut k = 0;
    while k < into.len() {
        into[k] = lanes.select(mask, from[k], into[k]);
        k += 1;
    }
    EmissionSample {
        origin: select(lanes, mask, a.origin, b.origin),
        direction: select(lanes, mask, a.direction, b.direction),
        emitted: b.emitted,
        pdf: EmissionPdf {
            position: lanes.select(mask, a.pdf.position, b.pdf.position),
            direction: lanes.select(mask, a.pdf.direction, b.pdf.direction),
        },
        valid: (mask & a.valid) | (!mask & b.valid),
    }
}
