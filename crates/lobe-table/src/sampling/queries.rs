//! What is asked of a sampler in batches: samples, densities, and the brightness of the surface.

use crate::directions::Directions;

/// All samples of a batch.
pub(super) struct Draws<'a, S> {
    pub sampler: &'a S,
    pub known: Directions<'a>,
    pub u: &'a [[f32; 2]],
    pub directions: &'a mut [[f32; 3]],
    pub pdfs: &'a mut [f32],
}

impl<'a, S> Draws<'a, S> {
    /// # Panics
    /// If the slices do not have the same length.
    pub fn new(
        sampler: &'a S,
        known: &'a [[f32; 3]],
        u: &'a [[f32; 2]],
        directions: &'a mut [[f32; 3]],
        pdfs: &'a mut [f32],
    ) -> Self {
        let count = known.len();
        assert_eq!((u.len(), directions.len(), pdfs.len()), (count, count, count), "one of each per direction");
        Draws { sampler, known: known.into(), u, directions, pdfs }
    }
}

/// All densities of a batch.
pub(super) struct Densities<'a, S> {
    pub sampler: &'a S,
    pub known: Directions<'a>,
    pub other: Directions<'a>,
    pub pdfs: &'a mut [f32],
}

impl<'a, S> Densities<'a, S> {
    /// # Panics
    /// If the slices do not have the same length.
    pub fn new(sampler: &'a S, known: &'a [[f32; 3]], other: &'a [[f32; 3]], pdfs: &'a mut [f32]) -> Self {
        assert_eq!((known.len(), other.len()), (pdfs.len(), pdfs.len()), "as many known as other and densities");
        Densities { sampler, known: known.into(), other: other.into(), pdfs }
    }
}

/// The brightness of the surface for many directions.
pub(super) struct Brightnesses<'a, S> {
    pub sampler: &'a S,
    pub known: Directions<'a>,
    pub out: &'a mut [f32],
}

impl<'a, S> Brightnesses<'a, S> {
    /// # Panics
    /// If the slices do not have the same length.
    pub fn new(sampler: &'a S, known: &'a [[f32; 3]], out: &'a mut [f32]) -> Self {
        assert_eq!(known.len(), out.len(), "a result per direction");
        Brightnesses { sampler, known: known.into(), out }
    }
}
