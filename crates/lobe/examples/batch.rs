//! Evaluates a batch whose directions are in columns, one slice per component, and in vectors: both give the same bits.

use std::error::Error;

use lobe::{Directions, Material};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/cloth-17x7x17x13.ddr");

/// Directions on a spiral over the hemisphere.
fn spiral(count: usize) -> Vec<[f32; 3]> {
    let direction = |i: usize| {
        let z = (i as f32 + 0.5) / count as f32;
        let (sin, cos) = (2.399_963 * i as f32).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        [radius * cos, radius * sin, z]
    };
    (0..count).map(direction).collect()
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let material = Material::open(FILE)?;
    let channels = material.channel_count();

    // One direction of the light for all queries.
    let wo = spiral(10_000);
    let wi = vec![[0.5, 0.0, 0.75f32.sqrt()]; wo.len()];
    let mut f = vec![0.0; wo.len() * channels];
    material.eval_batch(&wi, &wo, &mut f);

    let column = |w: &[[f32; 3]], axis: usize| w.iter().map(|v| v[axis]).collect::<Vec<f32>>();
    let [ix, iy, iz] = [0, 1, 2].map(|axis| column(&wi, axis));
    let [ox, oy, oz] = [0, 1, 2].map(|axis| column(&wo, axis));
    let mut same = vec![0.0; f.len()];
    material.eval_batch(Directions::columns(&ix, &iy, &iz), Directions::columns(&ox, &oy, &oz), &mut same);
    assert_eq!(f, same);

    // The spiral has equal areas, so the mean of f cos times 2 pi is the albedo.
    for channel in 0..channels {
        let sum: f32 = f.chunks_exact(channels).zip(&wo).map(|(f, wo)| f[channel] * wo[2]).sum();
        let albedo = sum / wo.len() as f32 * std::f32::consts::TAU;
        println!("albedo of channel {channel}: {albedo:.3}");
        assert!(albedo > 0.0 && albedo < 1.0);
    }
    Ok(())
}
