//! Importance sampling against its own densities, against the table, and on every backend.

use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

use lobe_formats::Document;
use lobe_lane::{Kernel, Lanes};
use lobe_table::{Channels, Edges, Given, Sampled, Sampler, SamplerOptions, Samples, Scatter, Table, coords};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;
use statrs::distribution::{ChiSquared, ContinuousCDF};

const REFERENCE: lobe_scalar::Scalar<1> = lobe_scalar::Scalar::<1>;

fn fixture(name: &str) -> Samples {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures").join(name);
    match lobe_formats::open(&path).unwrap().1 {
        Document::Table(measured) => measured.data,
        _ => panic!("{name} is no table"),
    }
}

/// A table of noise on knots that are not even.
fn random(seed: u64, [sigma, psi, theta, phi]: [usize; 4], channels: Channels, scatter: Scatter) -> Samples {
    let mut rng = Pcg32::seed_from_u64(seed);
    let mut knots = |count: usize, last: f64| {
        let mut gaps: Vec<f64> = (0..count).map(|_| rng.random_range(0.3..1.0)).collect();
        gaps[0] = 0.0;
        let all = gaps.iter().sum::<f64>().max(1e-9);
        gaps.iter().scan(0.0, |at, gap| Some({ *at += gap; *at / all * last })).collect::<Vec<f64>>()
    };
    let knots = [knots(sigma, 1.5), knots(psi, TAU), knots(theta, PI), knots(phi, TAU)];
    let count = sigma * psi * theta * phi * channels.count();
    // A few values are negative, as in measurements, and a few are large.
    let values = (0..count).map(|_| rng.random_range(-0.1f32..1.3).powi(3)).collect();
    Samples::new(scatter, knots, channels, values).unwrap()
}

/// Every kind of table.
fn tables() -> Vec<(&'static str, Samples)> {
    let spectral = Channels::Spectral(vec![450.0, 500.0, 550.0, 600.0]);
    let bent = random(5, [5, 1, 8, 7], Channels::Mono, Scatter::Transmission);
    let offsets = bent.knots()[0].iter().map(|sigma| (sigma.sin() / 1.5).asin() - sigma).collect();
    vec![
        ("conductor", fixture("conductor-7x8x13.ddr")),
        ("cloth", fixture("cloth-17x7x17x13.ddr")),
        ("isotropic noise", random(1, [6, 1, 9, 8], Channels::Rgb, Scatter::Reflection)),
        ("anisotropic noise", random(2, [5, 4, 7, 9], Channels::Xyz, Scatter::Reflection)),
        ("transmission", random(3, [5, 3, 8, 7], spectral, Scatter::Transmission)),
        ("refraction", bent.with_refraction(offsets).unwrap()),
    ]
}

fn sampler(samples: &Samples) -> Sampler {
    let table = Arc::new(Table::new(samples, &Edges::default()).unwrap());
    Sampler::new(REFERENCE, table, &SamplerOptions::default()).unwrap()
}

fn direction(sigma: f64, psi: f64) -> [f32; 3] {
    coords::angles_to_directions([sigma.to_radians(), psi.to_radians(), 0.0, 0.0], |s| s).0.map(|x| x as f32)
}

/// At, near and far from the normal, on knots and between them, for several rotations of the sample.
fn incidents() -> Vec<[f32; 3]> {
    let mut incidents = vec![direction(0.0, 0.0), direction(0.001, 77.0), direction(1.0, 10.0)];
    for (k, sigma) in [30.0, 47.0, 60.0, 80.0, 85.0, 88.0].into_iter().enumerate() {
        incidents.extend([0.0, 100.0, 215.0].map(|psi| direction(sigma, psi + 13.0 * k as f64)));
    }
    incidents
}

/// Samples and densities of one table, whatever the backend.
struct Run {
    directions: Vec<[f32; 3]>,
    weights: Vec<f32>,
    pdfs: Vec<f32>,
}

fn run<L: Lanes>(lanes: L, sampler: &Sampler, given: Given, known: &[[f32; 3]], u: &[[f32; 2]]) -> Run {
    let count = known.len();
    let mut run = Run {
        directions: vec![[f32::NAN; 3]; count],
        weights: vec![f32::NAN; count * sampler.table().channel_count()],
        pdfs: vec![f32::NAN; count],
    };
    let Run { directions, weights, pdfs } = &mut run;
    sampler.sample_batch(lanes, given, known, u, Sampled { directions, weights, pdfs });
    run
}

fn numbers(seed: u64, count: usize) -> Vec<[f32; 2]> {
    let mut rng = Pcg32::seed_from_u64(seed);
    (0..count).map(|_| [rng.random(), rng.random()]).collect()
}

fn best<K: Kernel>(kernel: K) -> K::Out {
    #[cfg(target_arch = "x86_64")]
    if let Some(avx2) = lobe_avx::Avx2::detect() {
        return avx2.vectorize(kernel);
    }
    REFERENCE.vectorize(kernel)
}

/// The work of a test on the fastest backend there is.
struct Fast<'a>(&'a Sampler, Given, &'a [[f32; 3]], &'a [[f32; 2]]);

impl Kernel for Fast<'_> {
    type Out = Run;
    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Run {
        run(lanes, self.0, self.1, self.2, self.3)
    }
}

struct FastPdf<'a>(&'a Sampler, &'a [[f32; 3]], &'a [[f32; 3]]);

impl Kernel for FastPdf<'_> {
    type Out = Vec<f32>;
    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<f32> {
        let mut pdfs = vec![f32::NAN; self.1.len()];
        self.0.pdf_batch(lanes, Given::Light, self.1, self.2, &mut pdfs);
        pdfs
    }
}

/// Bins for a chi-square test, in theta and phi about the mirror direction, which are not the coordinates sampled in.
const THETAS: usize = 40;
const PHIS: usize = 24;
/// Midpoints a bin and axis, over which the density is summed.
const POINTS: usize = 24;
/// Samples a direction.
const COUNT: usize = 1_000_000;

/// The theta at a part of the way: bins are finer near the peak.
fn theta_at(part: f64) -> f64 {
    PI * part * part
}

/// The integral of the density over each bin.
fn expected(sampler: &Sampler, incident: [f32; 3]) -> Vec<f64> {
    let [sigma, psi, ..] = coords::directions_to_angles(incident.map(f64::from), [0.0, 0.0, 1.0], |s| s);
    let side = if sampler.table().scatter() == Scatter::Reflection { 1.0 } else { -1.0 };
    let mut bins = Vec::new();
    let incidents = vec![incident; POINTS * POINTS];
    for i in 0..THETAS {
        for j in 0..PHIS {
            let (mut scattered, mut solid_angles) = (Vec::new(), Vec::new());
            for point in 0..POINTS * POINTS {
                let part = |k: usize| (i * POINTS + k) as f64 / (THETAS * POINTS) as f64;
                let (low, high) = (theta_at(part(point / POINTS)), theta_at(part(point / POINTS + 1)));
                let width = TAU / (PHIS * POINTS) as f64;
                let theta = ((low.cos() + high.cos()) / 2.0).acos();
                let phi = ((j * POINTS + point % POINTS) as f64 + 0.5) * width;
                let wo = coords::angles_to_directions([sigma, psi, theta, phi], |s| s).1;
                let above = if wo[2] > 0.0 { side } else { f64::NAN };
                scattered.push([wo[0], wo[1], wo[2] * above].map(|x| x as f32));
                solid_angles.push((low.cos() - high.cos()) * width);
            }
            let pdfs = best(FastPdf(sampler, &incidents, &scattered));
            bins.push(pdfs.iter().zip(solid_angles).map(|(pdf, solid_angle)| f64::from(*pdf) * solid_angle).sum());
        }
    }
    bins
}

/// How many samples fall into each bin.
fn observed(sampler: &Sampler, incident: [f32; 3], seed: u64) -> Vec<f64> {
    let u = numbers(seed, COUNT);
    let known = vec![incident; COUNT];
    let Run { directions, .. } = best(Fast(sampler, Given::Light, &known, &u));
    let mut bins = vec![0.0; THETAS * PHIS];
    for wo in directions {
        assert!((f64::from(wo[2]) * f64::from(incident[2]) > 0.0) == (sampler.table().scatter() == Scatter::Reflection));
        let wo = [wo[0], wo[1], wo[2].abs()].map(f64::from);
        let [.., theta, phi] = coords::directions_to_angles(incident.map(f64::from), wo, |s| s);
        let i = ((theta / PI).sqrt() * THETAS as f64) as usize;
        let j = (phi / TAU * PHIS as f64) as usize;
        bins[i.min(THETAS - 1) * PHIS + j.min(PHIS - 1)] += 1.0;
    }
    bins
}

/// The probability of a worse fit, bins of less than 10 samples lumped together.
fn p_value(expected: &[f64], observed: &[f64]) -> f64 {
    let total: f64 = expected.iter().sum();
    let (mut statistic, mut freedom) = (0.0, -1.0);
    let mut lump = (0.0, 0.0);
    let mut add = |(e, o): (f64, f64)| {
        statistic += (o - e) * (o - e) / e;
        freedom += 1.0;
    };
    for (e, o) in expected.iter().zip(observed) {
        let e = e / total * COUNT as f64;
        if e < 10.0 {
            lump = (lump.0 + e, lump.1 + o);
        } else {
            add((e, *o));
        }
    }
    if lump.0 >= 5.0 {
        add(lump);
    }
    1.0 - ChiSquared::new(freedom).unwrap().cdf(statistic)
}

#[test]
fn samples_follow_the_density() {
    let (tables, incidents) = (tables(), incidents());
    let tests = tables.len() * incidents.len();
    // Sidak: all tests together pass with probability 0.99 where all hypotheses hold.
    let significance = 1.0 - 0.99f64.powf(1.0 / tests as f64);
    let mut failures = Vec::new();
    for (name, samples) in &tables {
        let sampler = sampler(samples);
        let (mut least, mut off) = (1.0f64, 0.0f64);
        for (k, &incident) in incidents.iter().enumerate() {
            let expected = expected(&sampler, incident);
            let total: f64 = expected.iter().sum();
            let p = p_value(&expected, &observed(&sampler, incident, k as u64));
            (least, off) = (least.min(p), off.max((total - 1.0).abs()));
            if p < significance {
                failures.push(format!("{name} {incident:?}: p = {p:.1e}"));
            }
            if (total - 1.0).abs() > 1e-3 {
                failures.push(format!("{name} {incident:?}: the density integrates to {total}"));
            }
        }
        println!("{name}: least p {least:.1e} (at least {significance:.1e}), integral off by {off:.1e}");
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// The mean of what a sampler estimates, and the variance of one estimate over the mean's square.
fn moments(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for value in values {
        (count, sum, squares) = (count + 1.0, sum + value, squares + value * value);
    }
    let mean = sum / count;
    (mean, squares / count / (mean * mean) - 1.0)
}

/// Luminance by Rec. 709.
fn luminance(rgb: &[f32]) -> f64 {
    0.2126 * f64::from(rgb[0]) + 0.7152 * f64::from(rgb[1]) + 0.0722 * f64::from(rgb[2])
}

#[test]
fn albedo_is_that_of_cosine_sampling_with_less_noise() {
    for (name, at_least) in [("conductor-7x8x13.ddr", 10.0), ("cloth-17x7x17x13.ddr", 3.0)] {
        let sampler = sampler(&fixture(name));
        for incident in incidents() {
            let count = 400_000;
            let u = numbers(3, count);
            let known = vec![incident; count];
            let Run { weights, .. } = best(Fast(&sampler, Given::Light, &known, &u));
            let (albedo, variance) = moments(weights.chunks(3).map(luminance));

            let cosine: Vec<[f32; 3]> = u
                .iter()
                .map(|&[u, w]| {
                    let (sin, cos) = (f64::from(w) * TAU).sin_cos();
                    let radius = f64::from(u).sqrt();
                    [radius * cos, radius * sin, (1.0 - f64::from(u)).sqrt()].map(|x| x as f32)
                })
                .collect();
            let mut f = vec![0.0; 3 * count];
            sampler.table().eval_batch(REFERENCE, known.as_slice(), cosine.as_slice(), &mut f);
            let (reference, by_cosine) = moments(f.chunks(3).map(|f| PI * luminance(f)));
            let error = ((variance + by_cosine) / count as f64).sqrt() * reference;
            println!("{name} {incident:.3?}: albedo {albedo:.4}, relative variance {variance:.4} for {by_cosine:.3}: {:.1}", by_cosine / variance);
            assert!((albedo - reference).abs() < 5.0 * error, "{albedo} is not {reference} within {error}");
            assert!(by_cosine > at_least * variance, "{name} {incident:?}: {variance} after {by_cosine}");
        }
    }
}
