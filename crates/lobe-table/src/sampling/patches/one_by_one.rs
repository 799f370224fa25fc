//! Batches without kernels: one sample after the other.

use lobe_backend::Backend;

use super::PatchSampler;
use crate::sampling::queries::{Brightnesses, Densities, Draws};

impl PatchSampler {
    /// A direction and its density, 1/sr, for light from each of the `known` directions; zeros if the known direction
    /// is in no patch.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn draw_batch(
        &self,
        _: Backend,
        known: &[[f32; 3]],
        u: &[[f32; 2]],
        directions: &mut [[f32; 3]],
        pdfs: &mut [f32],
    ) {
        let Draws { directions, pdfs, .. } = Draws::new(self, known, u, directions, pdfs);
        for query in 0..known.len() {
            (directions[query], pdfs[query]) = self.draw_reference(known[query], u[query]);
        }
    }

    /// The density with which each of the `other` directions is drawn.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn pdf_batch(&self, _: Backend, known: &[[f32; 3]], other: &[[f32; 3]], pdfs: &mut [f32]) {
        let Densities { pdfs, .. } = Densities::new(self, known, other, pdfs);
        for query in 0..known.len() {
            pdfs[query] = self.pdf_reference(known[query], other[query]);
        }
    }

    /// The integral of luminance times `f` times cosine for light from each direction.
    ///
    /// # Panics
    /// If the slices do not have the same length.
    pub fn brightness_batch(&self, _: Backend, known: &[[f32; 3]], out: &mut [f32]) {
        let Brightnesses { out, .. } = Brightnesses::new(self, known, out);
        for (out, known) in out.iter_mut().zip(known) {
            *out = self.brightness_reference(*known);
        }
    }
}
