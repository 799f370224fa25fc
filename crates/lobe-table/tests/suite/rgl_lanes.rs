//! RGL materials in lanes against the `f64` reference, for every layout, and the same bits on every backend.

use std::f32::consts::{FRAC_PI_2, PI};

use lobe_backend::Backend;
use lobe_table::rgl::{self, Drawn, Images, Parts, Reference, UniformOrder, Wanted};
use lobe_table::{Channels, Directions};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

/// An image that is smooth along u.x, with equal ends along u.y, so that an error in a position causes an error of the
/// same size in the value; its values start at `low`.
fn images(part: &'static str, [slices, height, width]: [usize; 3], low: f32) -> Images {
    let mut texels = Vec::new();
    for slice in 0..slices {
        for row in 0..height {
            for col in 0..width {
                let (x, y) = (col as f32 / (width - 1) as f32, row as f32 / (height - 1) as f32);
                let wave = (2.0 * PI * y).cos() * x + (3.0 * x + slice as f32).sin();
                texels.push(low + 0.4 * (wave + 2.0));
            }
        }
    }
    Images::new(part, [slices, height, width], texels).expect("valid images")
}

fn material(phi_i: &[f32], theta_i: &[f32], channels: usize, jacobian: bool) -> rgl::Data {
    let incident = phi_i.len() * theta_i.len();
    rgl::Data::new(Parts {
        description: "waves".into(),
        phi_i: phi_i.to_vec(),
        theta_i: theta_i.to_vec(),
        ndf: images("ndf", [1, 5, 6], 0.1),
        sigma: images("sigma", [1, 2, 4], 0.3),
        vndf: images("vndf", [incident, 7, 6], 0.1),
        luminance: images("luminance", [incident, 4, 5], 0.1),
        channels: match channels {
            3 => Channels::Rgb,
            n => Channels::Spectral((0..n).map(|i| 400.0 + 10.0 * i as f64).collect()),
        },
        spectra: images("spectra", [incident * channels, 5, 4], -1.0),
        jacobian,
        valid: None,
    })
    .expect("a valid material")
}

/// Directions of all kinds: every quadrant, the normal, the mirror direction, below the surface, and invalid ones.
fn directions(count: usize) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let mut rng = Pcg32::seed_from_u64(18);
    let mut any = || loop {
        let v: [f32; 3] = std::array::from_fn(|_| rng.random_range(-1.0..1.0f32));
        let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
        if (0.1..1.0).contains(&length) {
            return [v[0] / length, v[1] / length, (v[2] / length).abs()];
        }
    };
    let (mut wi, mut wo): (Vec<_>, Vec<_>) = (0..count).map(|_| (any(), any())).unzip();
    wo[0] = [-wi[0][0], -wi[0][1], wi[0][2]];
    (wi[1], wo[2]) = ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
    (wi[3], wo[3]) = ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
    wo[4] = wi[4];
    (wi[5], wo[5]) = ([-0.6, 0.0, 0.8], [-0.6, -0.0, 0.8]);
    wi[6] = [1e-4, 0.0, 1.0];
    for (k, bad) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().enumerate() {
        for axis in 0..3 {
            wi[NOTHING.start + 6 * k + axis][axis] = bad;
            wo[NOTHING.start + 6 * k + 3 + axis][axis] = bad;
        }
    }
    let mut at = NOTHING.start + 18;
    for z in [0.0, -0.0, -1e-40, -0.5, -1.0] {
        wi[at][2] = z;
        wo[at + 1][2] = z;
        at += 2;
    }
    assert_eq!(at, NOTHING.end);
    (wi, wo)
}

/// The queries that must give 0.
const NOTHING: std::ops::Range<usize> = 10..38;

/// Not a multiple of any number of lanes, and more than one block.
const COUNT: usize = 331;

/// `f`, `f cos` and densities, which must not depend on what is requested together; and drawn directions, with their
/// densities and weights.
fn evaluate(backend: Backend, table: &rgl::Table) -> [Vec<f32>; 6] {
    let (wi, wo) = directions(COUNT);
    let values = || vec![f32::NAN; COUNT * table.channel_count()];
    let (mut f, mut alone, mut cos, mut pdf) = (values(), values(), values(), vec![f32::NAN; COUNT]);
    let mut pdf_alone = pdf.clone();
    for wanted in [
        Wanted::ValuesAndPdf(&mut f, &mut pdf),
        Wanted::Values(&mut alone),
        Wanted::ValuesCos(&mut cos),
        Wanted::Pdf(&mut pdf_alone),
    ] {
        table.evaluate(backend, (&wi).into(), (&wo).into(), wanted);
    }
    assert_eq!((bits(&alone), bits(&pdf_alone)), (bits(&f), bits(&pdf)));
    let (mut drawn, mut density, mut weights) = (vec![[f32::NAN; 3]; COUNT], vec![f32::NAN; COUNT], values());
    let outputs = Drawn { wo: &mut drawn, pdf: &mut density, weights: &mut weights };
    table.sample_batch(backend, (&wi).into(), &uniforms(), UniformOrder::Pbrt, outputs);
    [f, cos, pdf, drawn.into_flattened(), density, weights]
}

/// The corners of the unit square and numbers in it.
fn uniforms() -> Vec<[f32; 2]> {
    let mut rng = Pcg32::seed_from_u64(4);
    let mut uniforms: Vec<[f32; 2]> = (0..COUNT).map(|_| [rng.random(), rng.random()]).collect();
    uniforms[..4].copy_from_slice(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.5, 1.0]]);
    uniforms
}

#[test]
fn components_and_single_pairs_give_the_same_bits() {
    let backend = Backend::scalar();
    let table = rgl::Table::new(&material(&[0.0], &THETA_I, 3, true), rgl::Options::default()).expect("a table");
    let (wi, wo) = directions(COUNT);
    let [f, _, pdf, ..] = evaluate(backend, &table);
    let split = |w: &[[f32; 3]]| [0, 1, 2].map(|k| w.iter().map(|v| v[k]).collect::<Vec<f32>>());
    let ([ix, iy, iz], [ox, oy, oz]) = (split(&wi), split(&wo));
    let (wi_columns, wo_columns) = (Directions::columns(&ix, &iy, &iz), Directions::columns(&ox, &oy, &oz));
    let (mut values, mut densities) = (vec![f32::NAN; f.len()], vec![f32::NAN; COUNT]);
    table.evaluate(backend, wi_columns, wo_columns, Wanted::ValuesAndPdf(&mut values, &mut densities));
    assert_eq!((bits(&values), bits(&densities)), (bits(&f), bits(&pdf)));
    for query in 0..COUNT {
        let mut one = [f32::NAN; 3];
        table.eval(backend, wi[query], wo[query], &mut one);
        assert_eq!(bits(&one), bits(&f[3 * query..][..3]));
    }
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|x| x.to_bits()).collect()
}

/// Checks drawn directions and their weights.
fn check_draws(rgl: &rgl::Data, [.., wo, pdf, weights]: &[Vec<f32>; 6], clamp: bool, name: &str) {
    let reference = Reference::new(rgl).clamp_negative(clamp);
    let channels = rgl.parts().channels.count();
    let mut above = 0;
    for (query, (wi, uniform)) in directions(COUNT).0.into_iter().zip(uniforms()).enumerate() {
        let (wo, weights) = (&wo[3 * query..][..3], &weights[query * channels..][..channels]);
        let found = wi.iter().all(|x| x.is_finite()).then(|| {
            let wi = unit(wi);
            reference.sample(wi, uniform.map(f64::from), UniformOrder::Pbrt)
        });
        let Some(sample) = found.flatten() else {
            // A direction along the surface may be on either side of it.
            if wo[2] > 1e-5 || pdf[query] > 0.0 && wo[2] == 0.0 {
                panic!("{name} {query}: drawn {wo:?}");
            }
            assert!(wo[2] > 0.0 || weights.iter().all(|x| *x == 0.0), "{name} {query}");
            continue;
        };
        if sample.wo[2] < 1e-5 && pdf[query] == 0.0 {
            continue;
        }
        above += 1;
        let along = wo.iter().zip(&sample.wo).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
        assert!(along < 2e-5, "{name} {query}: {wo:?} is not {:?}", sample.wo);
        let error = (f64::from(pdf[query]) / sample.pdf - 1.0).abs();
        assert!(error < 1e-4, "{name} {query}: density {} is not {}", pdf[query], sample.pdf);
        for (got, expected) in weights.iter().zip(&sample.weight) {
            let error = (f64::from(*got) - expected).abs() / expected.abs().max(1.0);
            assert!(error < 1e-4, "{name} {query}: weight {got} is not {expected}");
        }
    }
    assert!(above > COUNT / 4, "{name}: {above} samples above the surface");
}

fn unit(w: [f32; 3]) -> [f64; 3] {
    let w = w.map(f64::from);
    let length = w.iter().map(|x| x * x).sum::<f64>().sqrt();
    w.map(|x| x / length)
}

/// Checks values and densities.
fn check(rgl: &rgl::Data, [f, cos, pdf, ..]: &[Vec<f32>; 6], clamp: bool, name: &str) {
    let reference = Reference::new(rgl).clamp_negative(clamp);
    let channels = rgl.parts().channels.count();
    let (wi, wo) = directions(COUNT);
    let (mut expected, mut expected_cos) = (vec![0.0; channels], vec![0.0; channels]);
    let mut below = false;
    for query in 0..COUNT {
        let at = query * channels..(query + 1) * channels;
        if NOTHING.contains(&query) {
            assert!(f[at.clone()].iter().chain(&cos[at]).all(|x| *x == 0.0), "{name} {query}: {:?}", wi[query]);
            assert_eq!(pdf[query], 0.0, "{name} {query}");
            continue;
        }
        let (wi, wo) = (unit(wi[query]), unit(wo[query]));
        reference.eval(wi, wo, &mut expected);
        reference.eval_cos(wi, wo, &mut expected_cos);
        let density = [reference.pdf(wi, wo)];
        // The spectra have both signs, so the error of their sum is absolute; f is that sum divided by the cosine.
        let pairs = f[at.clone()].iter().zip(&expected).map(|pair| (pair, 1.0 / wo[2]));
        let pairs = pairs.chain(cos[at].iter().zip(&expected_cos).map(|pair| (pair, 1.0)));
        for ((got, expected), unit) in pairs.chain(pdf[query..=query].iter().zip(&density).map(|pair| (pair, 1.0))) {
            below |= *got < 0.0;
            let error = (f64::from(*got) - expected).abs() / expected.abs().max(unit);
            assert!(error < 2e-5, "{name} {query}: {got} is not {expected}: {wi:?} {wo:?}");
        }
    }
    assert_eq!(below, !clamp, "{name}: values below zero");
}

fn check_all(phi_i: &[f32], theta_i: &[f32]) {
    for channels in [1, 2, 3, 4, 11] {
        for (jacobian, clamp_negative) in [(true, false), (false, true)] {
            let name = format!("{} azimuths, {} zeniths, {channels} channels", phi_i.len(), theta_i.len());
            let rgl = material(phi_i, theta_i, channels, jacobian);
            let table = rgl::Table::new(&rgl, rgl::Options { clamp_negative }).expect("a table");
            let scalar = evaluate(Backend::scalar().strict(), &table);
            check(&rgl, &scalar, clamp_negative, &name);
            check_draws(&rgl, &scalar, clamp_negative, &name);
            for backend in Backend::forms() {
                let found = evaluate(backend, &table);
                if backend.is_strict() {
                    for (one, other) in scalar.iter().zip(&found) {
                        assert_eq!(bits(one), bits(other), "{name} on {backend}");
                    }
                } else {
                    check(&rgl, &found, clamp_negative, &name);
                    check_draws(&rgl, &found, clamp_negative, &name);
                }
            }
        }
    }
}

const THETA_I: [f32; 4] = [0.0, 0.4, 1.0, 1.5];

#[test]
fn isotropic_materials() {
    check_all(&[0.0], &THETA_I);
    check_all(&[0.0], &[0.3]);
    // Two azimuths are blended, but the material still turns with the light.
    check_all(&[-PI, PI], &THETA_I);
}

#[test]
fn anisotropic_materials() {
    check_all(&[-PI, -1.0, 0.5, PI], &THETA_I);
    check_all(&[-PI, -1.0, 0.5, PI], &[0.3]);
}

#[test]
fn materials_with_reduced_azimuths() {
    check_all(&[-PI, -1.0, 0.0], &THETA_I);
    check_all(&[-PI, -2.0, -FRAC_PI_2], &THETA_I);
}
