//! The stage that traces rays, sorts their hits by material, and finds the interactions.

use lobe_trace::{MISS, RayClass};

use super::{Wavefront, rays};
use crate::clock::Instant;
use crate::transport::Transport;

/// The hits that are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    /// All of them.
    All,
    /// Only those on surfaces that emit light, because paths end there.
    Emitters,
}

impl<T: Transport> Wavefront<'_, T> {
    /// Traces the rays of the wave and finds the surface interactions of those hits that are kept.
    pub fn intersect(&mut self, class: RayClass, keep: Keep) {
        self.trace(class);
        self.sort(keep);
        let begun = Instant::now();
        self.hits.find(self.backend, self.world, &self.queue.order, &self.rays.rays, &self.found);
        self.stats.interactions += begun.elapsed();
    }

    fn trace(&mut self, class: RayClass) {
        let begun = Instant::now();
        rays::fit(&mut self.found, self.rays.len());
        self.world.scene.intersect(self.backend, class, self.rays.rays.view(), self.found.view());
        self.stats.trace += begun.elapsed();
        self.stats.rays += self.rays.len() as u64;
    }

    /// Sorts the rays by the materials they have hit.
    fn sort(&mut self, keep: Keep) {
        let begun = Instant::now();
        let (triangles, groups) = (self.world.triangles.as_slice(), &self.world.groups);
        let primitives = &self.found.primitive;
        self.queue.split(primitives.iter().map(|&primitive| primitive != MISS));
        self.queue.sort(self.world.materials.len(), |ray| {
            let group = &groups[triangles[primitives[ray] as usize][3] as usize];
            (keep == Keep::All || group.light.is_some()).then_some(group.material)
        });
        self.arrived.clear();
        self.arrived.extend(self.queue.order.iter().map(|ray| self.rays.states[*ray as usize]));
        self.stats.sort += begun.elapsed();
    }
}
