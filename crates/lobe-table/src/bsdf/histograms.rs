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

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;
    use crate::Scatter;

    /// A function with two channels that is brighter for viewers near the normal, and so not reciprocal.
    #[derive(Debug)]
    struct Rising(Channels);

    impl Bsdf for Rising {
        fn channels(&self) -> &Channels {
            &self.0
        }

        fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
            for (query, texel) in out.chunks_exact_mut(2).enumerate() {
                let (wi, wo) = (wi.get(query), wo.get(query));
                let value = if wi[2] > 0.0 && wo[2] > 0.0 { wo[2] * wo[2] * wi[2] / PI } else { 0.0 };
                texel.copy_from_slice(&[value, 0.5 * value]);
            }
        }
    }

    #[test]
    fn weights_are_values_times_cosine_over_density_for_both_given_directions() {
        const SIDE: usize = 64;
        const COUNT: usize = SIDE * SIDE;
        let at = |i: usize| (i as f32 + 0.5) / SIDE as f32;
        let u: Vec<[f32; 2]> = (0..COUNT).map(|i| [at(i % SIDE), at(i / SIDE)]).collect();
        let known = vec![[0.6, 0.0, 0.8]; COUNT];
        let backend = Backend::best();
        let options = DistributionOptions::unknown(Scatter::Reflection, true, 1 << 20);
        for measured in [Given::Light, Given::Viewer] {
            let rising = Rising(Channels::Named(vec!["a".into(), "b".into()]));
            let bsdf = ByHistograms::new(rising, backend, measured, &options).unwrap();
            // The integral of the other direction's share times cosine, times that of the known one.
            for (given, albedo) in [(Given::Light, 0.8 / 2.0), (Given::Viewer, 0.8 * 0.8 * 2.0 / 3.0)] {
                let (mut directions, mut weights) = (vec![[0.0; 3]; COUNT], vec![0.0; 2 * COUNT]);
                let (mut pdfs, mut found) = (vec![0.0; COUNT], vec![0.0; COUNT]);
                let out = Sampled { directions: &mut directions, weights: &mut weights, pdfs: &mut pdfs };
                bsdf.sample_batch(backend, given, &known, &u, out);
                let (wi, wo) = if given == Given::Light { (&known, &directions) } else { (&directions, &known) };
                let mut values = vec![0.0; 2 * COUNT];
                bsdf.eval_pdf_batch(backend, given, wi, wo, &mut values, &mut found);
                let mut apart = 0;
                for query in 0..COUNT {
                    apart += usize::from((found[query] / pdfs[query] - 1.0).abs() > 1e-2);
                    for (weight, value) in weights[2 * query..][..2].iter().zip(&values[2 * query..]) {
                        let expected = value * directions[query][2] / pdfs[query];
                        assert!((weight - expected).abs() <= 1e-5 * expected, "{weight}, not {expected}");
                    }
                }
                // At the edge of a cell, rounding may lead to the neighbouring one.
                assert!(apart < COUNT / 50, "{apart} of {COUNT} densities are not reproduced");
                let mean = weights.iter().step_by(2).sum::<f32>() / COUNT as f32;
                assert!((mean / albedo - 1.0).abs() < 0.02, "{mean} of the light, not {albedo}");
            }
        }
    }
}
