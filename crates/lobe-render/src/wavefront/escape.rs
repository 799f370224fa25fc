//! The stage that takes the light of the environment for rays that leave the scene.

use super::{Wavefront, accumulate, power_heuristic};
use crate::channels::Channels;
use crate::clock::Instant;
use crate::light::LightRay;
use crate::transport::Transport;

impl<T: Transport> Wavefront<'_, T> {
    /// Adds the radiance of the environment to the paths of rays that have hit nothing, weighted against sampling it as
    /// a light; no channel of a path gets more than `limit`.
    pub fn escape(&mut self, limit: f32) {
        let lights = &self.world.lights;
        let Some(environment) = lights.environment else { return };
        let begun = Instant::now();
        for &ray in &self.queue.missed {
            let state = &self.rays.states[ray as usize];
            let wi = self.rays.direction(ray as usize);
            let emitted = lights.emitted(environment, &LightRay { wi, distance: f32::INFINITY, cos: 1.0 });
            let share = power_heuristic(state.pdf, emitted.pdf_li);
            let radiance = emitted.radiance.map(|x| x * share);
            let radiance = T::radiance_from(state.throughput, radiance, lights.polarisation(environment), wi);
            accumulate(&mut self.slots[state.slot as usize], radiance, limit);
        }
        self.stats.interactions += begun.elapsed();
    }
}
