//! Batches over the threads of rayon's pool. The answers do not depend on how many there are.

use lobe_lane::Lanes;

use crate::{Hits, Intersect, Occluded, RayClass, Rays, Scene};

/// Rays that are worth a task: some hundred microseconds.
const TASK: usize = 4096;

/// The cut of a batch: in the middle, but never through a packet.
fn middle(n: usize) -> usize {
    (n / 2).next_multiple_of(64)
}

/// The nearest hits of a batch, as [`Intersect`] finds them.
///
/// # Panics
/// If there are not as many places for hits as rays.
pub fn intersect<L: Lanes, const W: usize>(
    lanes: L,
    scene: &Scene<W>,
    class: RayClass,
    rays: Rays<'_>,
    hits: Hits<'_>,
) {
    if rays.len() <= TASK {
        return lanes.vectorize(Intersect::new(scene, class, rays, hits));
    }
    let (rays, more_rays) = rays.split_at(middle(rays.len()));
    let (hits, more_hits) = hits.split_at(rays.len());
    rayon::join(|| intersect(lanes, scene, class, rays, hits), || intersect(lanes, scene, class, more_rays, more_hits));
}

/// Which rays of a batch hit anything, as [`Occluded`] finds it.
///
/// # Panics
/// If there are not as many answers as rays.
pub fn occluded<L: Lanes, const W: usize>(
    lanes: L,
    scene: &Scene<W>,
    class: RayClass,
    rays: Rays<'_>,
    out: &mut [bool],
) {
    if rays.len() <= TASK {
        return lanes.vectorize(Occluded::new(scene, class, rays, out));
    }
    let (rays, more_rays) = rays.split_at(middle(rays.len()));
    let (out, more_out) = out.split_at_mut(rays.len());
    rayon::join(|| occluded(lanes, scene, class, rays, out), || occluded(lanes, scene, class, more_rays, more_out));
}
