//! Importance sampling of tables: every entry point, on every backend. The crate `lobe` tests, for all materials
//! together, that samples follow their density.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use lobe_backend::Backend;
use lobe_lane::{Kernel, Lanes};
use lobe_table::{
    Channels, Data, DistributionError, Edges, Given, Sampled, Sampler, SamplerError, SamplerOptions, Scatter, specular,
    specular::coords,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

pub fn fixture(name: &str) -> specular::Data {
    match lobe_formats::open(&lobe_testing::files::fixture(name)).unwrap().1.only() {
        Some(Data::Specular(samples)) => samples.clone(),
        _ => panic!("{name} is not a table"),
    }
}

/// A table of noise on uneven knots.
fn random(seed: u64, [sigma, psi, theta, phi]: [usize; 4], channels: Channels, scatter: Scatter) -> specular::Data {
    let mut rng = Pcg32::seed_from_u64(seed);
    let mut knots = |count: usize, last: f64| {
        let mut gaps: Vec<f64> = (0..count).map(|_| rng.random_range(0.3..1.0)).collect();
        gaps[0] = 0.0;
        let all = gaps.iter().sum::<f64>().max(1e-9);
        gaps.iter()
            .scan(0.0, |at, gap| {
                Some({
                    *at += gap;
                    *at / all * last
                })
            })
            .collect::<Vec<f64>>()
    };
    let knots = [knots(sigma, 1.5), knots(psi, TAU), knots(theta, PI), knots(phi, TAU)];
    let count = sigma * psi * theta * phi * channels.count();
    // A few values are negative, as in measurements, and a few are large.
    let values = (0..count).map(|_| rng.random_range(-0.1f32..1.3).powi(3)).collect();
    specular::Data::new(scatter, knots, channels, values).unwrap()
}

/// Every kind of table.
fn tables() -> Vec<(&'static str, specular::Data)> {
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

fn sampler(samples: &specular::Data) -> Sampler {
    let table = Arc::new(specular::Table::new(samples, &Edges::default()).unwrap());
    Sampler::new(Backend::scalar(), table, &SamplerOptions::default()).unwrap()
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

/// Samples and densities of one table, on any backend.
struct Run {
    directions: Vec<[f32; 3]>,
    weights: Vec<f32>,
    pdfs: Vec<f32>,
}

fn run(backend: Backend, sampler: &Sampler, given: Given, known: &[[f32; 3]], u: &[[f32; 2]]) -> Run {
    let count = known.len();
    let mut run = Run {
        directions: vec![[f32::NAN; 3]; count],
        weights: vec![f32::NAN; count * sampler.table().channel_count()],
        pdfs: vec![f32::NAN; count],
    };
    let Run { directions, weights, pdfs } = &mut run;
    sampler.sample_batch(backend, given, known, u, Sampled { directions, weights, pdfs });
    run
}

fn numbers(seed: u64, count: usize) -> Vec<[f32; 2]> {
    let mut rng = Pcg32::seed_from_u64(seed);
    (0..count).map(|_| [rng.random(), rng.random()]).collect()
}

/// One sample and one density, in the last lane only.
struct OneLane<'a>(&'a Sampler, Given, [f32; 3], [f32; 2], &'a mut [f32]);

impl Kernel for OneLane<'_> {
    type Out = ([f32; 3], [f32; 2]);

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> ([f32; 3], [f32; 2]) {
        let OneLane(sampler, given, known, u, weight) = self;
        let last = L::LANES - 1;
        let mask = lanes.first_n(L::LANES) ^ lanes.first_n(last);
        let mut weights = vec![lanes.splat(f32::NAN); weight.len()];
        let known = known.map(|x| lanes.splat(x));
        let (sampled, pdf) = sampler.sample_lanes(lanes, given, known, u.map(|x| lanes.splat(x)), mask, &mut weights);
        let (wi, wo) = if given == Given::Light { (known, sampled) } else { (sampled, known) };
        let again = sampler.pdf_lanes(lanes, given, wi, wo, mask);
        for (target, value) in weight.iter_mut().zip(weights) {
            *target = lanes.extract(value, last);
            assert!(last == 0 || lanes.extract(value, 0) == 0.0, "a lane that the mask leaves out");
        }
        assert!(last == 0 || (lanes.extract(pdf, 0), lanes.extract(again, 0)) == (0.0, 0.0));
        (sampled.map(|x| lanes.extract(x, last)), [pdf, again].map(|x| lanes.extract(x, last)))
    }
}

/// Incident directions, some of which are not above the surface; and numbers, some of which are out of range.
fn hostile(count: usize) -> (Vec<[f32; 3]>, Vec<[f32; 2]>) {
    let mut u = numbers(8, count);
    u[..6].copy_from_slice(&[
        [0.0, 0.0],
        [1.0, 1.0],
        [0.999_999_94, 0.999_999_94],
        [f32::NAN, 0.5],
        [-1.0, 2.0],
        [0.0, 1.0],
    ]);
    let incidents = incidents();
    let mut known: Vec<[f32; 3]> = (0..count).map(|k| incidents[k * 7 % incidents.len()]).collect();
    known[10] = [0.6, 0.0, -0.8];
    known[11] = [f32::NAN, 0.0, 1.0];
    known[12] = [0.0, f32::INFINITY, 0.5];
    known[13] = [1.0, 0.0, 0.0];
    known[14] = [0.0; 3];
    // Light that skims the surface.
    known[15] = [1.0, 0.0, 1e-6];
    known[16] = [-0.6, 0.8, 1e-20];
    (known, u)
}

fn bits(run: &Run) -> Vec<u32> {
    let directions = run.directions.iter().flatten();
    directions.chain(&run.weights).chain(&run.pdfs).map(|x| x.to_bits()).collect()
}

fn check_ways(backend: Backend) {
    for (name, samples) in tables() {
        let sampler = sampler(&samples);
        let channels = sampler.table().channel_count();
        let through = samples.scatter() == Scatter::Transmission;
        let (known, u) = hostile(300);
        for given in [Given::Light, Given::Viewer] {
            let batch = run(backend, &sampler, given, &known, &u);
            let (mut agree, mut drawn) = (0, 0);
            for k in 0..known.len() {
                let (direction, pdf) = (batch.directions[k], batch.pdfs[k]);
                let weights = &batch.weights[k * channels..][..channels];
                let mut weight = vec![f32::NAN; channels];
                let one = sampler.sample(backend, given, known[k], u[k], &mut weight);
                assert_eq!((one, weight.as_slice()), ((direction, pdf), weights), "{name}: one sample, query {k}");
                let (lane, [lane_pdf, again]) = backend.run(OneLane(&sampler, given, known[k], u[k], &mut weight));
                assert_eq!((lane, lane_pdf, weight.as_slice()), (direction, pdf, weights), "{name}: lanes, query {k}");

                let (wi, wo) = if given == Given::Light { (known[k], direction) } else { (direction, known[k]) };
                assert_eq!(sampler.pdf(backend, given, wi, wo), again, "{name}: one density, query {k}");
                if (11..=14).contains(&k) || (k == 10 && !through) {
                    assert_eq!((direction, pdf), ([0.0; 3], 0.0), "{name}: query {k} is not a direction");
                    assert!(weights.iter().all(|&w| w == 0.0));
                    continue;
                }
                assert!(pdf > 0.0 && pdf.is_finite(), "{name}: density {pdf} of query {k}");
                assert!((direction[2] > 0.0) == ((known[k][2] > 0.0) != through), "{name}: side of query {k}");
                let length = direction.iter().map(|x| x * x).sum::<f32>();
                assert!((length - 1.0).abs() < 1e-6, "{name}: length {length} of query {k}");
                let mut f = vec![0.0; channels];
                sampler.table().eval(backend, wi, wo, &mut f);
                for (f, weight) in f.iter().zip(weights) {
                    assert_eq!(f * (direction[2].abs() / pdf), *weight, "{name}: weight of query {k}");
                }
                drawn += 1;
                agree += usize::from((pdf - again).abs() <= 2e-3 * pdf);
            }
            // At the edge of a cell, and for light that skims the surface, rounding may lead to another cell.
            assert!(agree + 12 > drawn, "{name} {given:?}: {agree} of {drawn} densities are reproduced");
        }
    }
}

#[test]
fn lanes_draw_like_the_f64_reference() {
    for (name, samples) in tables() {
        let sampler = sampler(&samples);
        let (known, u) = (incidents(), numbers(9, 4_000));
        let known: Vec<[f32; 3]> = known.into_iter().cycle().take(u.len()).collect();
        let drawn = run(Backend::scalar(), &sampler, Given::Light, &known, &u);
        let mut apart = 0;
        for query in 0..u.len() {
            let (direction, pdf) = sampler
                .distribution()
                .draw_reference(known[query].map(f64::from), u[query].map(f64::from))
                .expect("a direction above the surface");
            let found = drawn.directions[query].map(f64::from);
            let distance = (0..3).map(|i| (found[i] - direction[i]).powi(2)).sum::<f64>().sqrt();
            let density = (f64::from(drawn.pdfs[query]) / pdf - 1.0).abs();
            // At the edge of a cell, rounding may lead to the neighbouring cell, and phi changes fast if the light
            // skims the surface.
            apart += usize::from(distance > 2e-3 || density > 2e-3);
        }
        assert!(apart < u.len() / 100, "{name}: {apart} of {} samples", u.len());
    }
}

#[test]
fn batches_single_queries_and_lanes_agree() {
    Backend::forms().into_iter().for_each(check_ways);
}

#[test]
fn strict_samples_have_the_same_bits_on_every_backend() {
    for (name, samples) in tables() {
        let table = Arc::new(specular::Table::new(&samples, &Edges::default()).unwrap());
        let options = SamplerOptions::default();
        let (known, u) = hostile(5_003);
        let mut expected = Vec::new();
        for backend in Backend::available() {
            // Built on the backend that samples, so that building is also compared.
            let sampler = Sampler::new(backend, table.clone(), &options).unwrap();
            for given in [Given::Light, Given::Viewer] {
                let got = run(backend.strict(), &sampler, given, &known, &u);
                let mut pdfs = vec![f32::NAN; known.len()];
                sampler.pdf_batch(backend.strict(), given, &known, &got.directions, &mut pdfs);
                let got = (bits(&got), pdfs.iter().map(|x| x.to_bits()).collect::<Vec<u32>>());
                let at = given as usize;
                if expected.len() <= at {
                    expected.push(got);
                } else {
                    assert!(got == expected[at], "{name} {given:?} on {backend}");
                }
            }
        }
    }
}

#[test]
fn the_density_is_positive_wherever_the_table_is() {
    for (name, samples) in tables() {
        let sampler = sampler(&samples);
        let channels = sampler.table().channel_count();
        let through = samples.scatter() == Scatter::Transmission;
        let u = numbers(21, 4_000);
        let mut f = vec![0.0; channels];
        for (k, incident) in incidents().into_iter().cycle().take(u.len()).enumerate() {
            let wo = direction(f64::from(u[k][0]) * 89.9, f64::from(u[k][1]) * 360.0);
            let wo = [wo[0], wo[1], if through { -wo[2] } else { wo[2] }];
            sampler.table().eval(Backend::scalar(), incident, wo, &mut f);
            let pdf = sampler.pdf(Backend::scalar(), Given::Light, incident, wo);
            // A cosine distribution is a twentieth of each slice; a cell has its mean.
            assert!(pdf > 1e-3 * wo[2].abs(), "{name}: {pdf} from {incident:?} to {wo:?}, f {f:?}");
        }
    }
}

#[test]
fn a_black_table_is_sampled_by_the_cosine() {
    let black = random(1, [3, 1, 4, 5], Channels::Mono, Scatter::Reflection);
    let black = specular::Data::new(Scatter::Reflection, black.knots().clone(), Channels::Mono, vec![0.0; 60]).unwrap();
    let sampler = sampler(&black);
    let u = numbers(4, 100_000);
    let sampled = run(Backend::scalar(), &sampler, Given::Light, &vec![direction(40.0, 0.0); u.len()], &u);
    assert!(sampled.weights.iter().all(|&weight| weight == 0.0));
    // The mean cosine under a density proportional to the cosine is 2/3.
    let mean = sampled.directions.iter().map(|w| f64::from(w[2])).sum::<f64>() / u.len() as f64;
    assert!((mean - 2.0 / 3.0).abs() < 0.02, "mean cosine {mean}");
}

#[test]
fn memory_is_at_most_one_and_a_half_tables() {
    for (name, samples) in tables() {
        let sampler = sampler(&samples);
        let (bytes, table) = (sampler.bytes(), sampler.table().bytes());
        println!("{name}: {bytes} bytes in addition to the {table} of the table");
        assert!(2 * bytes <= 3 * table, "{name}: {bytes} bytes for a table of {table}");
    }
}

#[test]
fn progress_ends_with_all_slices() {
    let table = Arc::new(specular::Table::new(&fixture("cloth-17x7x17x13.ddr"), &Edges::default()).unwrap());
    let mut calls = Vec::new();
    Sampler::with_progress(Backend::scalar(), table, &SamplerOptions::default(), &mut |done, all| {
        calls.push((done, all))
    })
    .unwrap();
    assert_eq!(calls, (1..=17 * 7).map(|done| (done, 17 * 7)).collect::<Vec<_>>());
}

#[test]
fn invalid_options_are_refused() {
    let table = Arc::new(specular::Table::new(&fixture("conductor-7x8x13.ddr"), &Edges::default()).unwrap());
    for defensive in [0.0, -0.1, 1.1, f32::NAN] {
        let options = SamplerOptions { defensive, ..SamplerOptions::default() };
        let error = Sampler::new(Backend::scalar(), table.clone(), &options).unwrap_err();
        assert!(
            matches!(error, SamplerError::Distribution(DistributionError::Defensive { .. })),
            "{defensive}: {error}"
        );
    }
    for luminance in [vec![], vec![1.0], vec![0.0; 3], vec![1.0, -1.0, 1.0], vec![1.0, f32::INFINITY, 0.0]] {
        let options = SamplerOptions { luminance: Some(luminance.clone()), ..SamplerOptions::default() };
        let error = Sampler::new(Backend::scalar(), table.clone(), &options).unwrap_err();
        assert!(matches!(error, SamplerError::Luminance { channels: 3, .. }), "{luminance:?}: {error}");
    }
}
