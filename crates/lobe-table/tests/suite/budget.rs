//! Distributions with a limit to the number of evaluations.

use std::f32::consts::PI;
use std::sync::Arc;

use lobe_backend::Backend;
use lobe_table::{Distribution, DistributionOptions, Edges, Sampler, SamplerOptions, Scatter, specular};

use crate::sampling::fixture;

/// A distribution of light that peaks in the mirror direction, and the number of values that it took.
fn built(isotropic: bool, evaluations: Option<usize>) -> (Distribution, usize) {
    let mut options = DistributionOptions::unknown(Scatter::Reflection, isotropic, 1 << 22);
    options.evaluations = evaluations;
    let mut taken = 0;
    let mut light = |known: &[[f32; 3]], other: &[[f32; 3]], out: &mut [f32]| {
        taken += out.len();
        for ((k, o), out) in known.iter().zip(other).zip(out) {
            let mirror = (k[2] * o[2] - k[0] * o[0] - k[1] * o[1]).max(0.0);
            *out = 0.1 + mirror.powi(20);
        }
    };
    let distribution = Distribution::of_function(Backend::best(), &options, &mut light, &mut |_, _| {}).unwrap();
    (distribution, taken)
}

#[test]
fn no_more_values_are_taken_than_allowed() {
    // One slice of 32 by 62 cells is surveyed, and every slice has 16 cells.
    const COARSEST: usize = 32 * 62 + 192 * 16;
    for isotropic in [true, false] {
        let (whole, all) = built(isotropic, None);
        assert!(!whole.is_limited());
        for limit in [0, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000] {
            let (distribution, taken) = built(isotropic, Some(limit));
            println!("at most {limit} of {all} values: {taken}");
            assert!(taken <= limit.max(COARSEST), "{taken} values, not at most {limit}");
            assert_eq!(distribution.is_limited(), taken < all, "at most {limit}: {taken} of {all} values");
            assert!(distribution.is_limited() || distribution.bytes() == whole.bytes());
            // Little of a limit is left unused.
            assert!(!distribution.is_limited() || limit < 100_000 || taken > limit / 8, "{taken} of {limit}");
        }
    }
}

#[test]
fn a_coarse_distribution_has_the_density_of_its_samples() {
    const SIDE: usize = 128;
    let at = |i: usize| (i as f32 + 0.5) / SIDE as f32;
    let u: Vec<[f32; 2]> = (0..SIDE * SIDE).map(|i| [at(i % SIDE), at(i / SIDE)]).collect();
    let known = vec![[0.6, 0.0, 0.8]; u.len()];
    for limit in [None, Some(100_000), Some(0)] {
        let (distribution, _) = built(true, limit);
        let (mut directions, mut pdfs) = (vec![[0.0; 3]; u.len()], vec![0.0; u.len()]);
        distribution.draw_batch(Backend::best(), &known, &u, &mut directions, &mut pdfs);
        // The integral of the cosine over the hemisphere.
        let sum: f64 = directions.iter().zip(&pdfs).map(|(direction, pdf)| f64::from(direction[2] / pdf)).sum();
        let mean = sum as f32 / u.len() as f32;
        assert!((mean / PI - 1.0).abs() < 0.01, "at most {limit:?}: {mean}, not pi");
    }
}

#[test]
fn tables_keep_to_limits_and_have_the_same_bits_within_them() {
    let table = Arc::new(specular::Table::new(&fixture("cloth-17x7x17x13.ddr"), &Edges::default()).unwrap());
    let draw = |options: &SamplerOptions| {
        let sampler = Sampler::new(Backend::scalar(), table.clone(), options).unwrap();
        let (mut directions, mut pdfs) = ([[0.0; 3]; 3], [0.0; 3]);
        let u = [[0.1, 0.2], [0.5, 0.5], [0.8, 0.9]];
        sampler.distribution().draw_batch(Backend::scalar(), &[[0.6, 0.0, 0.8]; 3], &u, &mut directions, &mut pdfs);
        let bits = directions.map(|direction| direction.map(f32::to_bits));
        (bits, sampler.bytes(), sampler.distribution().is_limited())
    };
    let whole = draw(&SamplerOptions::default());
    let evaluations = |most: usize| SamplerOptions { evaluations: Some(most), ..SamplerOptions::default() };
    assert_eq!(draw(&evaluations(usize::MAX - 1)), whole);
    let (_, bytes, is_limited) = draw(&evaluations(10_000));
    assert!(is_limited && bytes < whole.1 / 2, "{bytes} of {} bytes", whole.1);
    let (_, bytes, is_limited) = draw(&SamplerOptions { bytes: Some(whole.1 / 4), ..SamplerOptions::default() });
    assert!(!is_limited && bytes <= whole.1 / 4, "{bytes} of {} bytes", whole.1);
}
