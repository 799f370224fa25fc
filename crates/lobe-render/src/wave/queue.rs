//! Hits sorted by material.

use std::ops::Range;

use super::Vertex;

/// The hits of a wave, those of one material after those of another, in the order of the rays within each.
#[derive(Debug)]
pub(super) struct Queue<const C: usize> {
    pub sorted: Vec<Vertex<C>>,
    /// For each material that was hit its number and its part of `sorted`.
    pub parts: Vec<(usize, Range<usize>)>,
    counts: Vec<usize>,
}

impl<const C: usize> Default for Queue<C> {
    fn default() -> Self {
        Queue { sorted: Vec::new(), parts: Vec::new(), counts: Vec::new() }
    }
}

impl<const C: usize> Queue<C> {
    /// A counting sort. Where all hits are of one material they are not moved but taken.
    pub fn sort(&mut self, found: &mut Vec<Vertex<C>>, materials: usize) {
        let Queue { sorted, parts, counts } = self;
        counts.clear();
        counts.resize(materials, 0);
        for vertex in &*found {
            counts[vertex.hit.material as usize] += 1;
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
        if parts.len() <= 1 {
            return std::mem::swap(sorted, found);
        }
        sorted.clone_from(found);
        for vertex in &*found {
            let place = &mut counts[vertex.hit.material as usize];
            sorted[*place] = *vertex;
            *place += 1;
        }
    }
}
