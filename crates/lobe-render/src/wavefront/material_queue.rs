//! Rays that have hit something, sorted by material.

use std::ops::Range;

/// The rays of a wave that have hit something, one material after another, in their order within each.
#[derive(Debug, Default)]
pub(crate) struct MaterialQueue {
    /// Indices of rays.
    pub order: Vec<u32>,
    /// The hits of each material.
    pub groups: Vec<MaterialHits>,
    /// Rays that have hit nothing.
    pub missed: Vec<u32>,
    hit: Vec<u32>,
    /// Rays and materials, in the order of the rays.
    met: Vec<RayOfMaterial>,
    counts: Vec<usize>,
}

/// The hits of one material.
#[derive(Clone, Debug)]
pub(crate) struct MaterialHits {
    pub material: usize,
    /// Their range in the sorted order.
    pub hits: Range<usize>,
}

#[derive(Clone, Copy, Debug)]
struct RayOfMaterial {
    ray: u32,
    material: u32,
}

impl MaterialQueue {
    /// Separates rays that have hit something from those that have not.
    pub fn split(&mut self, hit: impl ExactSizeIterator<Item = bool>) {
        // Each is written to both lists, and overwritten in the one to which it does not belong: a branch would be
        // unpredictable.
        let room = hit.len() + 1;
        self.hit.resize(room, 0);
        self.missed.resize(room, 0);
        let (mut hits, mut misses) = (0, 0);
        for (ray, hit) in hit.enumerate() {
            self.hit[hits] = ray as u32;
            self.missed[misses] = ray as u32;
            hits += usize::from(hit);
            misses += usize::from(!hit);
        }
        self.hit.truncate(hits);
        self.missed.truncate(misses);
    }

    /// A counting sort by material of the rays that have hit something; rays that are not followed further are left
    /// out.
    pub fn sort(&mut self, materials: usize, material: impl Fn(usize) -> Option<u32>) {
        let MaterialQueue { order, groups, hit, met, counts, .. } = self;
        met.clear();
        met.extend(
            hit.iter().filter_map(|&ray| material(ray as usize).map(|material| RayOfMaterial { ray, material })),
        );
        counts.clear();
        counts.resize(materials, 0);
        for met in &*met {
            counts[met.material as usize] += 1;
        }
        groups.clear();
        let mut begin = 0;
        for (material, count) in counts.iter_mut().enumerate() {
            let end = begin + *count;
            if *count > 0 {
                groups.push(MaterialHits { material, hits: begin..end });
            }
            *count = begin;
            begin = end;
        }
        order.resize(met.len(), 0);
        for met in &*met {
            let next = &mut counts[met.material as usize];
            order[*next] = met.ray;
            *next += 1;
        }
    }
}
