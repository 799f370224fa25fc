//! The stage that keeps the surfaces which light paths have met.

use super::Wavefront;
use crate::connect::{LightVertex, Unpolarised};

impl<T: Unpolarised> Wavefront<'_, T> {
    /// Keeps the hits on materials that have values for pairs of directions, at this depth.
    pub fn keep_vertices(&mut self, depth: u32) {
        for group in &self.queue.groups {
            if !self.world.materials[group.material].lobes().values {
                continue;
            }
            for hit in group.hits.clone() {
                let state = &self.arrived[hit];
                let walk = &self.walks.walks[state.slot as usize];
                let flux = T::radiance(state.throughput, walk.flux);
                if !flux.as_ref().iter().all(|x| x.is_finite()) {
                    self.stats.invalid += 1;
                    continue;
                }
                self.walks.found.push(LightVertex {
                    place: self.hits.place(hit),
                    wo: self.hits.wo()[hit],
                    flux,
                    mis: walk.mis,
                    material: group.material as u32,
                    surfaces: depth + 1,
                });
                self.walks.found_by.push(state.slot);
            }
        }
    }

    /// Counts the light paths that have met a surface.
    pub fn count_landed(&mut self) {
        self.stats.landed += self.hits.len() as u64;
    }
}
