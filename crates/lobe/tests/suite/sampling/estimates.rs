//! Estimates from samples are right, and less noisy than those from cosine sampling.

use std::f64::consts::PI;

use lobe::{Aspect, Given, Sampled, Sampler, Scatter, Side, luminance};
use rayon::prelude::*;

use super::materials::{Named, fixture, sampler, samplers};
use super::{cosine, direction, incidents, numbers};

/// The mean, and the variance of one value divided by the square of the mean.
fn moments(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for value in values {
        (count, sum, squares) = (count + 1.0, sum + value, squares + value * value);
    }
    let mean = sum / count;
    (mean, squares / count / (mean * mean) - 1.0)
}

fn dot(texel: &[f32], weights: &[f32]) -> f64 {
    texel.iter().zip(weights).map(|(f, y)| f64::from(*f) * f64::from(*y)).sum()
}

/// The luminance of the albedo, from samples and from cosine sampling: mean and relative variance of each.
fn albedo(sampler: &Sampler, given: Given, known: [f32; 3], count: usize) -> [(f64, f64); 2] {
    let material = sampler.material();
    let (channels, weights) = (material.channel_count(), luminance(material.channels()));
    let (u, known) = (numbers(3, count), vec![known; count]);
    let (mut directions, mut pdfs) = (vec![[0.0; 3]; count], vec![0.0; count]);
    let mut values = vec![0.0; count * channels];
    let out = Sampled { directions: &mut directions, weights: &mut values, pdfs: &mut pdfs };
    sampler.sample_batch(given, &known, &u, out);
    let by_samples = moments(values.chunks(channels).map(|weight| dot(weight, &weights)));

    let light = Side::of(known[0]);
    let reflects = material.holds(Aspect { scatter: Scatter::Reflection, light });
    let transmits = material.holds(Aspect { scatter: Scatter::Transmission, light });
    let side = |query: usize| match (reflects, transmits) {
        (true, true) => [1.0, -1.0][query % 2],
        (true, false) => 1.0,
        _ => -1.0,
    };
    let others: Vec<[f32; 3]> = (0..count).map(|query| cosine(u[query], side(query) * known[query][2])).collect();
    let (wi, wo) = if given == Given::Light { (&known, &others) } else { (&others, &known) };
    material.eval_batch(wi, wo, &mut values);
    let sides = if reflects && transmits { 2.0 } else { 1.0 };
    let by_cosine = moments(values.chunks(channels).map(|f| sides * PI * dot(f, &weights)));
    [by_samples, by_cosine]
}

#[test]
fn estimates_agree_with_cosine_sampling() {
    samplers().par_iter().for_each(|Named { name, sampler, .. }| {
        // The published scheme of the EPFL database loses samples below the horizon, and its measurements have values
        // where the scheme has no density.
        let tolerance = if sampler.material().kind() == lobe::table::rgl::KIND { 0.02 } else { 0.0 };
        let front = [Aspect::REFLECTION, Aspect::TRANSMISSION].iter().any(|&aspect| sampler.material().holds(aspect));
        for given in [Given::Light, Given::Viewer] {
            for (sigma, psi) in [(3.0, 20.0), (41.0, 130.0), (70.0, 250.0)] {
                let [x, y, z] = direction(sigma, psi);
                let known = [x, y, if front { z } else { -z }];
                let count = 20_000;
                let [(found, variance), (reference, by_cosine)] = albedo(sampler, given, known, count);
                if reference == 0.0 && found == 0.0 {
                    continue;
                }
                let error = ((variance.max(0.0) + by_cosine.max(0.0)) / count as f64).sqrt() * reference.abs();
                assert!(
                    (found - reference).abs() < 6.0 * error + (tolerance + 1e-5) * reference.abs(),
                    "{name} {given:?} at {sigma}: {found} is not {reference} within {error}, {variance} {by_cosine}"
                );
            }
        }
    });
}

#[test]
fn samples_are_less_noisy_than_cosine_sampling() {
    for (name, at_least) in [("conductor-7x8x13.ddr", 10.0), ("cloth-17x7x17x13.ddr", 3.0)] {
        let sampler = sampler(fixture(name));
        for incident in incidents() {
            let [(_, variance), (_, by_cosine)] = albedo(&sampler, Given::Light, incident, 200_000);
            assert!(by_cosine > at_least * variance, "{name} {incident:?}: {variance} after {by_cosine}");
        }
    }
}

#[test]
fn memory_is_at_most_one_and_a_half_materials() {
    for Named { name, sampler, .. } in samplers() {
        let (bytes, material) = (sampler.bytes(), sampler.material().bytes());
        // The coarsest grid of the tiniest material has no room to shrink.
        assert!(2 * bytes <= 3 * material || bytes < 120_000, "{name}: {bytes} bytes for a material of {material}");
    }
}

#[test]
fn joint_values_and_densities_equal_separate_ones() {
    // Representations with their own implementation, and some without.
    for Named { name, sampler, is_shared } in samplers() {
        let material = sampler.material();
        if *is_shared && material.kind() != lobe::table::rgl::KIND {
            continue;
        }
        let wi: Vec<[f32; 3]> = numbers(5, 300).into_iter().map(|u| cosine(u, 1.0)).collect();
        let wo: Vec<[f32; 3]> = numbers(6, 300).into_iter().map(|u| cosine(u, 1.0)).collect();
        for given in [Given::Light, Given::Viewer] {
            let (mut values, mut pdfs) = (vec![0.0; 300 * material.channel_count()], vec![0.0; 300]);
            let (mut both, mut both_pdfs) = (values.clone(), pdfs.clone());
            material.eval_batch(&wi, &wo, &mut values);
            sampler.pdf_batch(given, &wi, &wo, &mut pdfs);
            sampler.eval_pdf_batch(given, &wi, &wo, &mut both, &mut both_pdfs);
            assert!(pdfs.iter().any(|&pdf| pdf > 0.0) || material.holds(Aspect::TRANSMISSION), "{name}");
            assert_eq!((values, pdfs), (both, both_pdfs), "{name}, {given:?}");
        }
    }
}
