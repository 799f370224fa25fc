//! The noise of samples: mean and variance of the estimate of the albedo from one sample, `f cos / pdf`, in luminance.

use std::f64::consts::{PI, TAU};

use lobe::{Given, Material, Sampled, Sampler, luminance};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// Statistics of the luminance of single samples.
#[derive(Clone, Copy, Debug)]
pub struct Moments {
    /// The albedo.
    pub mean: f64,
    /// The variance divided by the square of the mean.
    pub variance: f64,
}

/// Pairs of random numbers in `[0, 1)`, the same for every call.
pub fn uniforms(count: usize) -> Vec<[f32; 2]> {
    let mut rng = Pcg32::seed_from_u64(2018);
    (0..count).map(|_| [rng.random(), rng.random()]).collect()
}

/// The noise of weights, one per sample and channel of the material.
pub fn of_weights(material: &Material, weights: &[f32]) -> Moments {
    let luminance = luminance(material.channels());
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for texel in weights.chunks_exact(luminance.len()) {
        let value: f64 = texel.iter().zip(&luminance).map(|(&x, &y)| f64::from(x) * f64::from(y)).sum();
        (count, sum, squares) = (count + 1.0, sum + value, squares + value * value);
    }
    let mean = sum / count;
    // Rounding could make the variance of equal values negative.
    Moments { mean, variance: (squares / count / (mean * mean) - 1.0).max(0.0) }
}

/// The noise of samples for one direction above the surface.
pub fn by_samples(sampler: &Sampler, given: Given, known: [f32; 3], uniforms: &[[f32; 2]]) -> Moments {
    let count = uniforms.len();
    let (mut directions, mut pdfs) = (vec![[0.0; 3]; count], vec![0.0; count]);
    let mut weights = vec![0.0; sampler.material().channel_count() * count];
    let out = Sampled { directions: &mut directions, weights: &mut weights, pdfs: &mut pdfs };
    sampler.sample_batch(given, &vec![known; count], uniforms, out);
    of_weights(sampler.material(), &weights)
}

/// The noise of directions sampled in proportion to their cosine, for one direction above the surface.
pub fn by_cosine(material: &Material, given: Given, known: [f32; 3], uniforms: &[[f32; 2]]) -> Moments {
    let draw = |&[u, w]: &[f32; 2]| {
        let (sin, cos) = (f64::from(w) * TAU).sin_cos();
        let radius = f64::from(u).sqrt();
        [radius * cos, radius * sin, (1.0 - f64::from(u)).sqrt()].map(|x| x as f32)
    };
    let drawn: Vec<[f32; 3]> = uniforms.iter().map(draw).collect();
    let known = vec![known; drawn.len()];
    let (wi, wo) = if given == Given::Light { (&known, &drawn) } else { (&drawn, &known) };
    let mut weights = vec![0.0; material.channel_count() * drawn.len()];
    material.eval_batch(wi, wo, &mut weights);
    weights.iter_mut().for_each(|weight| *weight *= PI as f32);
    of_weights(material, &weights)
}
