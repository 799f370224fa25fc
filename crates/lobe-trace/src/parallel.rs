//! Batches divided among the threads of rayon's pool. The answers do not depend on their number.

use lobe_backend::Backend;

use crate::{Hits, RayClass, Rays, Scene};

/// The number of rays that are worth a task, which takes some hundred microseconds.
const TASK: usize = 4096;

/// The position at which a batch is split: in the middle, but never within a packet.
fn middle(n: usize) -> usize {
    (n / 2).next_multiple_of(64)
}

/// The nearest hits of a batch, as [`Scene::intersect`] finds them.
///
/// # Panics
/// If `rays` and `hits` differ in length.
pub fn intersect(backend: Backend, scene: &Scene, class: RayClass, rays: Rays<'_>, hits: Hits<'_>) {
    if rays.len() <= TASK {
        return scene.intersect(backend, class, rays, hits);
    }
    let (rays, more_rays) = rays.split_at(middle(rays.len()));
    let (hits, more_hits) = hits.split_at(rays.len());
    rayon::join(
        || intersect(backend, scene, class, rays, hits),
        || intersect(backend, scene, class, more_rays, more_hits),
    );
}

/// Which rays of a batch hit anything, as [`Scene::occluded`] finds them.
///
/// # Panics
/// If `rays` and `out` differ in length.
pub fn occluded(backend: Backend, scene: &Scene, class: RayClass, rays: Rays<'_>, out: &mut [bool]) {
    if rays.len() <= TASK {
        return scene.occluded(backend, class, rays, out);
    }
    let (rays, more_rays) = rays.split_at(middle(rays.len()));
    let (out, more_out) = out.split_at_mut(rays.len());
    rayon::join(|| occluded(backend, scene, class, rays, out), || occluded(backend, scene, class, more_rays, more_out));
}
