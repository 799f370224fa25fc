//! Dividing a batch among threads does not change the result.
#![cfg(feature = "rayon")]

use std::path::Path;
use std::sync::Arc;

use lobe::{Channels, Given, Material, Options, PARALLEL_FROM, Sampled, Sampler, SamplerOptions, Scatter, specular};
use lobe_testing::examples;

/// Not a multiple of the block or of the task.
const COUNT: usize = PARALLEL_FROM + 4_173;

fn direction(i: usize) -> [f32; 3] {
    let (turn, z) = (i as f32 * 0.7, 0.05 + 0.9 * (i % 1013) as f32 / 1013.0);
    let across = (1.0 - z * z).sqrt();
    [across * turn.cos(), across * turn.sin(), z]
}

fn threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

#[test]
#[cfg_attr(target_family = "wasm", ignore = "WebAssembly cannot start threads")]
fn values_do_not_depend_on_the_number_of_threads() {
    let knots = [vec![0.0, 0.5, 1.2], vec![0.0], vec![0.0, 0.1, 0.7, 3.0], vec![0.0, 2.0, 4.0]];
    let values = (0..3 * 4 * 3 * 3).map(|i| (i * 37 % 101) as f32).collect();
    let samples = specular::Data::new(Scatter::Reflection, knots, Channels::Rgb, values).unwrap();
    let material = Material::from_samples(samples, &Options::default()).unwrap();

    let wi: Vec<_> = (0..COUNT).map(direction).collect();
    let wo: Vec<_> = (0..COUNT).map(|i| direction(7 * i + 3)).collect();
    let evaluate = |count: usize| {
        let mut out = vec![f32::NAN; 3 * COUNT];
        threads(count, || material.eval_batch(&wi, &wo, &mut out));
        out
    };
    let one = evaluate(1);
    assert!(one.iter().all(|x| x.is_finite()) && one.iter().any(|x| *x > 0.0));
    for count in [2, 5] {
        assert_eq!(evaluate(count), one, "{count} threads");
    }
    // The same queries again, in pieces too small to be divided.
    let mut pieces = vec![f32::NAN; 3 * COUNT];
    for (at, out) in pieces.chunks_mut(3 * 1000).enumerate() {
        let range = 1000 * at..1000 * at + out.len() / 3;
        material.eval_batch(&wi[range.clone()], &wo[range], out);
    }
    assert_eq!(pieces, one);
}

/// The results of a sampler for one batch, as bits.
fn answers(sampler: &Sampler) -> Vec<u32> {
    let channels = sampler.material().channel_count();
    let known: Vec<_> = (0..COUNT).map(direction).collect();
    let other: Vec<_> = (0..COUNT).map(|i| direction(7 * i + 3)).collect();
    let u: Vec<_> = (0..COUNT).map(|i| [(i as f32 * 0.618).fract(), (i as f32 * 0.414).fract()]).collect();
    let (mut directions, mut pdfs) = (vec![[f32::NAN; 3]; COUNT], vec![f32::NAN; COUNT]);
    let mut values = vec![f32::NAN; channels * COUNT];
    let mut bits = Vec::new();
    let mut keep = |directions: &[[f32; 3]], values: &[f32], pdfs: &[f32]| {
        bits.extend(directions.as_flattened().iter().chain(values).chain(pdfs).map(|x| x.to_bits()));
    };

    let out = Sampled { directions: &mut directions, weights: &mut values, pdfs: &mut pdfs };
    sampler.sample_batch(Given::Viewer, &known, &u, out);
    keep(&directions, &values, &pdfs);
    sampler.draw_batch(&known, &u, &mut directions, &mut pdfs);
    keep(&directions, &[], &pdfs);
    sampler.pdf_batch(Given::Light, &known, &other, &mut pdfs);
    keep(&[], &[], &pdfs);
    sampler.eval_pdf_batch(Given::Viewer, &known, &other, &mut values, &mut pdfs);
    keep(&[], &values, &pdfs);
    bits
}

#[test]
#[cfg_attr(target_family = "wasm", ignore = "WebAssembly cannot start threads")]
fn samples_do_not_depend_on_the_number_of_threads() {
    let mut seen = Vec::new();
    for (format, bytes) in examples::all() {
        let Ok(material) = Material::from_bytes(&bytes, Path::new("example"), &Options::default()) else { continue };
        if seen.contains(&material.kind()) {
            continue;
        }
        let material = Arc::new(material);
        let Ok(sampler) = Sampler::new(material.clone(), &SamplerOptions::default()) else { continue };
        seen.push(material.kind());
        let one = threads(1, || answers(&sampler));
        assert!(threads(3, || answers(&sampler)) == one, "{format}: three threads");
    }
    assert!(seen.len() >= 7, "samplers of {seen:?} only");
}
