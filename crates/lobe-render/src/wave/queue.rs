//! Hits sorted by material.

use std::ops::Range;

use crate::hit::Hit;

/// The hits of a wave, those of one material after those of another, in the order of the rays within each.
#[derive(Debug, Default)]
pub(super) struct Queue {
    /// Numbers of hits.
    pub order: Vec<u32>,
    /// For each material that was hit its number and its part of `order`.
    pub parts: Vec<(usize, Range<usize>)>,
    counts: Vec<usize>,
}

impl Queue {
    /// A counting sort.
    pub fn sort(&mut self, hits: &[Hit], materials: usize) {
        let Queue { order, parts, counts } = self;
        counts.clear();
        counts.resize(materials, 0);
        for hit in hits {
            counts[hit.material as usize] += 1;
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
        order.resize(hits.len(), 0);
        for (number, hit) in hits.iter().enumerate() {
            let place = &mut counts[hit.material as usize];
            order[*place] = number as u32;
            *place += 1;
        }
    }
}
