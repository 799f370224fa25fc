//! The stages in which camera paths sample lights and find them, weighted against all other techniques.

use lobe_trace::RayClass;

use super::Wavefront;
use crate::channels::Channels;
use crate::clock::Instant;
use crate::columns::{RAYS, vector};
use crate::connect::{Pass, Unpolarised};
use crate::light::LightRay;
use crate::vec3::neg;
use crate::wavefront::rays::Ray;
use crate::wavefront::shadow::ShadowRay;

impl<T: Unpolarised> Wavefront<'_, T> {
    /// Adds direct light at the hits.
    pub fn sample_lights_weighted(&mut self, depth: u32, class: RayClass, pass: &Pass) {
        if self.world.lights.all.is_empty() {
            return;
        }
        let begun = Instant::now();
        self.sample_lights(depth, None);
        self.stats.lights += begun.elapsed();
        self.evaluate_bsdfs(depth);
        self.reverse_densities(depth);
        let begun = Instant::now();
        let lights = &self.world.lights;
        let next = &self.next_event;
        let reverse = &self.walks.reverse;
        let queue = &mut self.shadow.queue;
        queue.clear();
        queue.extend(next.reached.len(), |out| {
            for (pair, &hit) in next.reached.iter().enumerate() {
                let hit = hit as usize;
                let (sample, at) = (&next.light_samples[hit / RAYS], hit % RAYS);
                let state = &self.arrived[hit];
                let walk = &self.walks.walks[state.slot as usize];
                let ray = Ray { origin: vector(&sample.origin, at), direction: vector(&sample.direction, at) };
                let cos = crate::vec3::dot(self.hits.geometric(hit), ray.direction).abs();
                let light = lights.chosen(self.numbers.of(hit)[0]);
                let pdf = sample.pdf[at];
                let back = lights.back(light, ray.direction, sample.t_max[at], pdf, cos);
                let share = walk.mis.next_event(next.pdf[pair] / pdf, back, reverse[pair], pass.factors);
                let radiance = T::radiance(T::apply(state.throughput, next.f[pair]), sample.emitted(at));
                let radiance = radiance.map(|value| value * share);
                // NaN must continue, to be counted.
                let some = radiance.as_ref().iter().fold(false, |some, x| some | (*x != 0.0));
                out.write(ray, sample.t_max[at], ShadowRay { slot: state.slot, radiance }, some);
            }
        });
        self.stats.lights += begun.elapsed();
        let delta = lights.all.iter().all(|light| light.is_delta());
        self.resolve_shadow_rays(class.shadow(delta));
    }

    /// The densities with which light paths would go back along the paths that have reached the hits.
    fn reverse_densities(&mut self, depth: u32) {
        let begun = Instant::now();
        let next = &self.next_event;
        let reverse = &mut self.walks.reverse;
        reverse.resize(next.reached.len(), 0.0);
        for group in &next.groups {
            let pairs = group.hits.clone();
            let (wi, wo) = (&next.wi[pairs.clone()], &next.wo[pairs.clone()]);
            let mode = crate::transport::TransportMode::Importance;
            self.world.materials[group.material].pdf(mode, wo, wi, &mut reverse[pairs], &mut self.scratch);
        }
        self.stats.at(depth).time += begun.elapsed();
    }

    /// Adds the radiance of emitting surfaces to the paths that have hit them.
    pub fn emit_weighted(&mut self, depth: u32) {
        let begun = Instant::now();
        let lights = &self.world.lights;
        for (hit, &group) in self.hits.groups().iter().enumerate() {
            let Some(light) = self.world.groups[group as usize].light else { continue };
            let (state, ray) = (&self.arrived[hit], self.queue.order[hit] as usize);
            let (distance, cos) = (self.found.t[ray], self.hits.front(hit));
            let wi = self.rays.direction(ray);
            let emitted = lights.emitted(light as usize, &LightRay { wi, distance, cos });
            let share = if depth == 0 {
                1.0
            } else {
                let (chance, pdf) =
                    (lights.chance(light as usize), lights.all[light as usize].pdf_le(&lights.bounds, neg(wi), cos));
                let mis = &self.walks.walks[state.slot as usize].mis;
                mis.found(chance * pdf.position, chance * pdf.position * pdf.direction)
            };
            let radiance = T::radiance(state.throughput, emitted.radiance.map(|x| x * share));
            add(&mut self.slots[state.slot as usize].sample.radiance, &radiance);
        }
        self.stats.interactions += begun.elapsed();
    }

    /// Adds the radiance of the environment to the paths of rays that have hit nothing.
    pub fn escape_weighted(&mut self, depth: u32) {
        let lights = &self.world.lights;
        let Some(environment) = lights.environment else { return };
        let begun = Instant::now();
        for &ray in &self.queue.missed {
            let state = &self.rays.states[ray as usize];
            let wi = self.rays.direction(ray as usize);
            let emitted = lights.emitted(environment, &LightRay { wi, distance: f32::INFINITY, cos: 1.0 });
            let share = if depth == 0 {
                1.0
            } else {
                let mis = &self.walks.walks[state.slot as usize].mis;
                mis.found(emitted.pdf_li, emitted.pdf_li * lights.disk())
            };
            let radiance = T::radiance(state.throughput, emitted.radiance.map(|x| x * share));
            add(&mut self.slots[state.slot as usize].sample.radiance, &radiance);
        }
        self.stats.interactions += begun.elapsed();
    }
}

/// Adds light that has arrived.
pub(super) fn add<S: Channels>(sum: &mut S, more: &S) {
    sum.as_mut().iter_mut().zip(more.as_ref()).for_each(|(sum, value)| *sum += value);
}
