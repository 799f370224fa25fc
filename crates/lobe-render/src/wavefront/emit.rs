//! The stages that record the first surface of a path, and take the light of surfaces that emit.

use super::{Wavefront, accumulate, power_heuristic};
use crate::channels::Channels;
use crate::clock::Instant;
use crate::film::FirstHit;
use crate::light::LightRay;
use crate::transport::Transport;

impl<T: Transport> Wavefront<'_, T> {
    /// Records the hits of camera rays, for the images of albedo, normal, depth and material.
    pub fn record_first_hits(&mut self) {
        let begun = Instant::now();
        for (hit, &group) in self.hits.groups().iter().enumerate() {
            let (state, ray) = (&self.arrived[hit], self.queue.order[hit] as usize);
            let material = self.world.groups[group as usize].material;
            self.slots[state.slot as usize].sample.first_hit = FirstHit {
                albedo: self.world.materials[material as usize].albedo(),
                normal: self.hits.normal(hit),
                depth: self.found.t[ray],
                material: material + 1,
            };
        }
        self.stats.interactions += begun.elapsed();
    }

    /// Adds the radiance of emitting surfaces to the paths that have hit them, weighted against sampling them as
    /// lights; no channel of a path gets more than `limit`.
    pub fn emit(&mut self, limit: f32) {
        let begun = Instant::now();
        for (hit, &group) in self.hits.groups().iter().enumerate() {
            let Some(light) = self.world.groups[group as usize].light else { continue };
            let (state, ray) = (&self.arrived[hit], self.queue.order[hit] as usize);
            let (distance, cos) = (self.found.t[ray], self.hits.front(hit));
            let reached = LightRay { wi: self.rays.direction(ray), distance, cos };
            let emitted = self.world.lights.emitted(light as usize, &reached);
            let share = power_heuristic(state.pdf, emitted.pdf_li);
            let radiance = emitted.radiance.map(|x| x * share);
            let polarisation = self.world.lights.polarisation(light as usize);
            let radiance = T::radiance_from(state.throughput, radiance, polarisation, reached.wi);
            accumulate(&mut self.slots[state.slot as usize], radiance, limit);
        }
        self.stats.interactions += begun.elapsed();
    }
}
