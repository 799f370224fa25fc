//! Sampling by histograms of a function's values.

use std::sync::Arc;

use lobe_backend::Backend;

use super::Bsdf;
use crate::mueller::Matrix;
use crate::{
    Aspect, Channels, Directions, Distribution, DistributionError, DistributionOptions, Given, Sampled, luminance,
    specular,
};

/// A function with histograms of luminance times value times cosine, from which directions are sampled: for models and
/// for a program's own functions.
///
/// Its values are those of the function. Directions are sampled only for known directions with `z > 0`, on the side
/// that the options name.
#[derive(Clone, Debug)]
pub struct ByHistograms<B> {
    bsdf: B,
    distribution: Arc<Distribution>,
}

impl<B: Bsdf> ByHistograms<B> {
    /// Measures where the function scatters light. `given` says whether the histograms are for known directions to the
    /// light or to the viewer; sampling and densities are right for both, but if the function is not reciprocal,
    /// samples for the chosen one are less noisy.
    ///
    /// # Errors
    /// If the options are invalid.
    pub fn new(
        bsdf: B,
        backend: Backend,
        given: Given,
        options: &DistributionOptions,
    ) -> Result<Self, DistributionError> {
        let weights = luminance(bsdf.channels());
        let mut values = Vec::new();
        let mut light = |known: &[[f32; 3]], other: &[[f32; 3]], out: &mut [f32]| {
            values.resize(known.len() * weights.len(), 0.0);
            let (wi, wo) = if given == Given::Light { (known, other) } else { (other, known) };
            bsdf.eval_batch(backend, wi.into(), wo.into(), &mut values);
            for (out, texel) in out.iter_mut().zip(values.chunks_exact(weights.len())) {
                *out = texel.iter().zip(&weights).map(|(value, weight)| value * weight).sum();
            }
        };
        let distribution = Arc::new(Distribution::of_function(backend, options, &mut light, &mut |_, _| {})?);
        Ok(ByHistograms { bsdf, distribution })
    }
}

impl<B: Bsdf> Bsdf for ByHistograms<B> {
    fn channels(&self) -> &Channels {
        self.bsdf.channels()
    }

    fn holds(&self, aspect: Aspect) -> bool {
        self.bsdf.holds(aspect)
    }

    fn is_isotropic(&self) -> bool {
        self.bsdf.is_isotropic()
    }

    fn bytes(&self) -> usize {
        self.bsdf.bytes() + self.distribution.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.bsdf.eval_batch(backend, wi, wo, out);
    }

    fn sample_batch(&self, backend: Backend, given: Given, known: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_>) {
        let Sampled { directions, weights, pdfs } = out;
        self.distribution.draw_batch(backend, known, u, directions, pdfs);
        let sampled = &*directions;
        let (wi, wo) = if given == Given::Light { (known, sampled) } else { (sampled, known) };
        self.bsdf.eval_batch(backend, wi.into(), wo.into(), weights);
        let texels = weights.chunks_exact_mut(self.channels().count());
        for ((texel, direction), &pdf) in texels.zip(sampled).zip(&*pdfs) {
            let cos = direction[2].abs();
            texel.iter_mut().for_each(|value| *value = if pdf > 0.0 { *value * cos / pdf } else { 0.0 });
        }
    }

    fn draw_batch(&self, backend: Backend, known: &[[f32; 3]], u: &[[f32; 2]], out: &mut [[f32; 3]], pdfs: &mut [f32]) {
        self.distribution.draw_batch(backend, known, u, out, pdfs);
    }

    fn pdf_batch(&self, backend: Backend, given: Given, wi: &[[f32; 3]], wo: &[[f32; 3]], pdfs: &mut [f32]) {
        let (known, other) = if given == Given::Light { (wi, wo) } else { (wo, wi) };
        self.distribution.pdf_batch(backend, known, other, pdfs);
    }

    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        self.bsdf.mueller(wi, wo, nm)
    }

    fn is_polarised(&self) -> bool {
        self.bsdf.is_polarised()
    }

    fn mueller_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        self.bsdf.mueller_batch(backend, wi, wo, out)
    }

    fn specular_table(&self) -> Option<&Arc<specular::Table>> {
        self.bsdf.specular_table()
    }
}
