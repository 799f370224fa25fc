//! Rays and what they hit.

use lobe_trace::{HitSoA, MISS, RaySoA};

use crate::vec3::Vec3;

/// A batch of rays with room for their hits.
#[derive(Debug, Default)]
pub(super) struct Batch {
    pub rays: RaySoA,
    pub hits: HitSoA,
}

impl Batch {
    /// No rays; memory is kept.
    pub fn clear(&mut self) {
        clear(&mut self.rays);
    }

    /// The direction of a ray.
    pub fn direction(&self, i: usize) -> Vec3 {
        self.rays.direction.each_ref().map(|component| component[i])
    }
}

/// Removes all rays and keeps the memory.
pub(super) fn clear(rays: &mut RaySoA) {
    rays.origin.iter_mut().chain(&mut rays.direction).for_each(Vec::clear);
    rays.t_min.clear();
    rays.t_max.clear();
}

/// Makes it `n` rays without end, whatever their origins and directions are.
pub(super) fn fill(rays: &mut RaySoA, n: usize) {
    rays.origin.iter_mut().chain(&mut rays.direction).for_each(|column| column.resize(n, 0.0));
    rays.t_min.clear();
    rays.t_min.resize(n, 0.0);
    rays.t_max.clear();
    rays.t_max.resize(n, f32::INFINITY);
}

/// Makes room for the hits of `n` rays.
pub(super) fn fit(hits: &mut HitSoA, n: usize) {
    let HitSoA { t, u, v, primitive, instance } = hits;
    [t, u, v].into_iter().for_each(|column| column.resize(n, 0.0));
    [primitive, instance].into_iter().for_each(|column| column.resize(n, MISS));
}
