//! Draws directions from a material in a Monte Carlo loop: the light that a surface sends to a viewer under a sky.

use std::error::Error;
use std::sync::Arc;

use lobe::{Given, Material, Sampled, Sampler, SamplerOptions};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/conductor-7x8x13.ddr");
const SAMPLES: usize = 1 << 14;

/// Radiance from a direction: a sky that is brighter toward the horizon.
fn sky([_, _, z]: [f32; 3]) -> f32 {
    1.5 - z
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let material = Arc::new(Material::open(FILE)?);
    let channels = material.channel_count();
    let sampler = Sampler::new(Arc::clone(&material), &SamplerOptions::default())?;

    // The viewer is known, the light is drawn, by points that fill the square evenly (Roberts' R2 sequence).
    let viewer = vec![[0.6, 0.0, 0.8]; SAMPLES];
    let point = |i: usize| [0.754_877_67, 0.569_840_3].map(|a: f64| (a * i as f64).fract() as f32);
    let numbers: Vec<[f32; 2]> = (0..SAMPLES).map(point).collect();
    let mut directions = vec![[0.0; 3]; SAMPLES];
    let (mut weights, mut pdfs) = (vec![0.0; SAMPLES * channels], vec![0.0; SAMPLES]);
    let out = Sampled { directions: &mut directions, weights: &mut weights, pdfs: &mut pdfs };
    sampler.sample_batch(Given::Viewer, &viewer, &numbers, out);

    // A weight is f cos / pdf, so the estimate is the mean of weight times radiance.
    let mut radiance = vec![0.0; channels];
    for (wi, weight) in directions.iter().zip(weights.chunks_exact(channels)) {
        for (sum, weight) in radiance.iter_mut().zip(weight) {
            *sum += weight * sky(*wi) / SAMPLES as f32;
        }
    }
    println!("radiance to the viewer: {radiance:.4?}");
    assert!(radiance.iter().all(|value| *value > 0.0 && *value < 1.5));
    Ok(())
}
