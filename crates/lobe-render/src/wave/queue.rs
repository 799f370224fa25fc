//! Rays that have hit something, sorted by material.

use std::ops::Range;

/// The rays of a wave that have hit something, those of one material after those of another, in their order within each.
#[derive(Debug, Default)]
pub(super) struct Queue {
    /// Numbers of rays.
    pub order: Vec<u32>,
    /// For each material that was hit its number and its part of `order`.
    pub parts: Vec<(usize, Range<usize>)>,
    /// Rays and materials, as they come.
    met: Vec<[u32; 2]>,
    counts: Vec<usize>,
}

impl Queue {
    /// No rays; memory is kept.
    pub fn clear(&mut self) {
        self.met.clear();
    }

    /// Adds a ray that has hit a material.
    pub fn push(&mut self, ray: usize, material: u32) {
        self.met.push([ray as u32, material]);
    }

    /// A counting sort by one of `materials`.
    pub fn sort(&mut self, materials: usize) {
        let Queue { order, parts, met, counts } = self;
        counts.clear();
        counts.resize(materials, 0);
        for [_, material] in &*met {
            counts[*material as usize] += 1;
        }
        parts.clear();
        let mut begin = 0;
        for (material, count) in counts.iter_mut().enumerate() {
            let end = begin + *count;
            if *count > 0 {
                parts.push((material, begin..end));
            }
            *count = begin;
            begin = end;
        }
        order.resize(met.len(), 0);
        for [ray, material] in &*met {
            let place = &mut counts[*material as usize];
            order[*place] = *ray;
            *place += 1;
        }
    }
}
