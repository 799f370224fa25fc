//! Sampling of a function by histograms of its values.

use std::f32::consts::PI;

use lobe_backend::Backend;
use lobe_table::bsdf::ByHistograms;
use lobe_table::{Bsdf, Channels, Directions, DistributionOptions, Given, Sampled, Scatter};

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
