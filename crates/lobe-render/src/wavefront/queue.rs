//! Rays that have hit something, sorted by material.

use std::ops::Range;

/// The rays of a wave that have hit something, those of one material after those of another, in their order within each.
#[derive(Debug, Default)]
pub(super) struct Queue {
    /// Numbers of rays.
    pub order: Vec<u32>,
    /// For each material that was hit its number and its part of `order`.
    pub parts: Vec<(usize, Range<usize>)>,
    /// Rays that have hit nothing.
    pub missed: Vec<u32>,
    hit: Vec<u32>,
    /// Rays and materials, as they come.
    met: Vec<[u32; 2]>,
    counts: Vec<usize>,
}

impl Queue {
    /// Tells rays that have hit something from those that have not.
    pub fn split(&mut self, hit: impl ExactSizeIterator<Item = bool>) {
        // Each is written to both lists, and written over where it does not belong: which it is cannot be foreseen.
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

    /// A counting sort of the rays that have hit something by which of `materials` it was; without those that are
    /// followed no further.
    pub fn sort(&mut self, materials: usize, material: impl Fn(usize) -> Option<u32>) {
        let Queue { order, parts, hit, met, counts, .. } = self;
        met.clear();
        met.extend(hit.iter().filter_map(|&ray| material(ray as usize).map(|material| [ray, material])));
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
