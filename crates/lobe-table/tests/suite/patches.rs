//! Sampling of the patches of Klems matrices in lanes, against sampling one at a time in `f64`.

use std::f64::consts::TAU;

use lobe_backend::Backend;
use lobe_table::window::klems::{AngleBasis, KlemsMatrix, Ring};
use lobe_table::{PatchSampler, Scatter};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

const COUNT: usize = 5003;

fn sampler(scatter: Scatter, incident: AngleBasis, exit: AngleBasis) -> PatchSampler {
    let mut rng = Pcg32::seed_from_u64(3);
    let values = (0..incident.patches() * exit.patches()).map(|_| rng.random_range(-0.1f32..1.0).powi(5)).collect();
    let matrix = KlemsMatrix::new(incident, exit, values).expect("a matrix");
    PatchSampler::new(scatter, &[(&matrix, 1.0)], 0.05).expect("options").expect("a sampler")
}

/// Rings that end before the horizon.
fn short() -> AngleBasis {
    let ring = |lower, upper, patches| Ring { lower, upper, patches };
    AngleBasis::new("short", vec![ring(0.0, 20.0, 3), ring(20.0, 40.0, 7), ring(40.0, 70.0, 1)]).expect("a basis")
}

/// Directions well inside patches, on both sides, so that rounding does not select another patch.
fn inside(basis: &AngleBasis, seed: u64) -> Vec<[f32; 3]> {
    let mut rng = Pcg32::seed_from_u64(seed);
    let one = |_| {
        let ring = basis.rings()[rng.random_range(0..basis.rings().len())];
        let theta = (ring.lower + rng.random_range(0.01..0.99) * (ring.upper - ring.lower)).to_radians();
        let sector = f64::from(rng.random_range(0..ring.patches)) + rng.random_range(-0.49..0.49);
        let (sin, cos) = theta.sin_cos();
        let (sin_phi, cos_phi) = (sector / f64::from(ring.patches) * TAU).sin_cos();
        let side = if rng.random_range(0..3) == 0 { -1.0 } else { 1.0 };
        [sin * cos_phi, sin * sin_phi, side * cos].map(|x| x as f32)
    };
    (0..COUNT).map(one).collect()
}

fn check(scatter: Scatter, incident: AngleBasis, exit: AngleBasis) {
    let sampler = sampler(scatter, incident.clone(), exit.clone());
    let (mut known, mut other) = (inside(&incident, 1), inside(&exit, 2));
    let mut rng = Pcg32::seed_from_u64(4);
    let mut u: Vec<[f32; 2]> = (0..COUNT).map(|_| [rng.random(), rng.random()]).collect();
    u[..5].copy_from_slice(&[
        [0.0, 0.0],
        [1.0, 1.0],
        [f32::NAN, f32::NAN],
        [-1.0, 2.0],
        [1.0 - f32::EPSILON / 2.0, 0.5],
    ]);
    let nowhere = [[0.0; 3], [1.0, 0.0, 0.0], [f32::NAN, 0.0, 1.0], [0.0, f32::INFINITY, 1.0]];
    known[10..14].copy_from_slice(&nowhere);
    other[20..24].copy_from_slice(&nowhere);
    let mut strict: Option<Vec<u32>> = None;
    for backend in Backend::forms() {
        let (mut directions, mut pdfs) = (vec![[f32::NAN; 3]; COUNT], vec![f32::NAN; COUNT]);
        let (mut densities, mut brightness) = (vec![f32::NAN; COUNT], vec![f32::NAN; COUNT]);
        sampler.draw_batch(backend, &known, &u, &mut directions, &mut pdfs);
        sampler.pdf_batch(backend, &known, &other, &mut densities);
        sampler.brightness_batch(backend, &known, &mut brightness);
        for query in 0..COUNT {
            let (direction, pdf) = sampler.draw_reference(known[query], u[query]);
            let off = (0..3).map(|k| (direction[k] - directions[query][k]).abs()).fold(0.0, f32::max);
            assert!(off <= 6e-7, "{query} on {backend}: {:?}, not {direction:?}", directions[query]);
            // Near the horizon, the cosine of a direction is small, but its absolute error is the same.
            let near = |a: f32, b: f32| (a - b).abs() <= 2e-6 * b + 1e-7;
            assert!(near(pdfs[query], pdf), "{query} on {backend}: {}, not {pdf}", pdfs[query]);
            let density = sampler.pdf_reference(known[query], other[query]);
            assert!(near(densities[query], density), "{query} on {backend}: {}, not {density}", densities[query]);
            assert_eq!(brightness[query], sampler.brightness_reference(known[query]), "{query} on {backend}");
            if query % 97 == 0 {
                let (mut one, mut pdf) = ([[f32::NAN; 3]], [f32::NAN]);
                sampler.draw_batch(backend, &known[query..=query], &u[query..=query], &mut one, &mut pdf);
                assert_eq!((one[0], pdf[0]), (directions[query], pdfs[query]), "{query} alone on {backend}");
            }
        }
        let lit = densities.iter().filter(|&&density| density > 0.0).count();
        assert!(lit > COUNT / 5 && pdfs[10..14] == [0.0; 4] && densities[20..24] == [0.0; 4], "{lit} on {backend}");
        let numbers = directions.as_flattened().iter().chain(&pdfs).chain(&densities);
        let bits: Vec<u32> = numbers.map(|x| x.to_bits()).collect();
        if backend.is_strict() {
            assert!(*strict.get_or_insert_with(|| bits.clone()) == bits, "{backend}");
        }
    }
}

#[test]
fn lanes_draw_like_the_reference() {
    for scatter in [Scatter::Reflection, Scatter::Transmission] {
        check(scatter, AngleBasis::full(), AngleBasis::full());
        check(scatter, AngleBasis::half(), short());
        check(scatter, short(), AngleBasis::quarter());
    }
}
