//! RGL materials in lanes against the loader of the database and Mitsuba.

use std::path::Path;

use lobe_backend::Backend;
use lobe_formats::rgl;
use lobe_table::rgl::{Data, Drawn, Options, Table, UniformOrder, Wanted};
use lobe_testing::files::{bytes, shared};
use lobe_testing::golden::{Worst, queries, relative, unit};

const SYNTHETIC: [&str; 4] = ["rgl_iso_rgb", "rgl_iso_spec", "rgl_aniso_rgb", "rgl_aniso_spec"];
const REAL: [&str; 5] =
    ["cc_ibiza_sunset", "cc_iris_purple_gem", "colodur_napoli_4f", "paper_white", "vch_golden_yellow"];

fn load(path: &Path) -> Data {
    rgl::read(&bytes(path), path).expect("an RGL material")
}

/// Runs a check on every backend of this CPU.
macro_rules! on_every_backend {
    ($check:ident($($argument:expr),*)) => {
        for backend in Backend::available() {
            $check(backend, $($argument),*);
        }
    };
}

type Queries = [(Vec<f64>, Vec<f64>)];
type Directions = (Vec<[f32; 3]>, Vec<[f32; 3]>);

fn directions(queries: &Queries) -> Directions {
    queries.iter().map(|(query, _)| [0, 3].map(|at| unit(query, at).map(|x| x as f32)).into()).unzip()
}

fn evaluate(backend: Backend, table: &Table, (wi, wo): &Directions) -> (Vec<f32>, Vec<f32>) {
    let (mut values, mut pdf) = (vec![f32::NAN; wi.len() * table.channel_count()], vec![f32::NAN; wi.len()]);
    let wanted = Wanted::ValuesCosAndPdf(&mut values, &mut pdf);
    table.evaluate(backend, wi.into(), wo.into(), wanted);
    (values, pdf)
}

/// The golden columns hold the stored channels first, and the density at column `pdf_at`.
fn against(backend: Backend, name: &str, table: &Table, queries: &Queries, pdf_at: usize, floor: f64) {
    let channels = table.channel_count();
    let (values, pdf) = evaluate(backend, table, &directions(queries));
    let mut worst: [Worst; 2] = Default::default();
    for (at, (_, answer)) in queries.iter().enumerate() {
        for (value, expected) in values[at * channels..][..channels].iter().zip(answer) {
            worst[0].see(relative(f64::from(*value), *expected, floor), at);
        }
        worst[1].see(relative(f64::from(pdf[at]), answer[pdf_at], floor), at);
    }
    let [eval, density] = worst;
    println!("{name} on {backend}: eval {eval:?}, pdf {density:?}");
    assert!(eval.error < 1e-4 && density.error < 1e-4, "{name} on {backend}");
}

/// The columns after the density: direction, density and weights of a sample of the loader of the database.
fn draws(backend: Backend, name: &str, table: &Table, queries: &Queries) {
    let channels = table.channel_count();
    let (wi, _) = directions(queries);
    let uniforms: Vec<_> = queries.iter().map(|(query, _)| [query[6] as f32, query[7] as f32]).collect();
    let (mut wo, mut pdf) = (vec![[f32::NAN; 3]; wi.len()], vec![f32::NAN; wi.len()]);
    let mut weights = vec![f32::NAN; wi.len() * channels];
    let drawn = Drawn { wo: &mut wo, pdf: &mut pdf, weights: &mut weights };
    table.sample_batch(backend, (&wi).into(), &uniforms, UniformOrder::Powitacq, drawn);
    let mut worst: [Worst; 3] = Default::default();
    for (at, (_, answer)) in queries.iter().enumerate() {
        let expected = &answer[channels + 1..];
        if expected.iter().all(|x| *x == 0.0) {
            assert_eq!((wo[at], pdf[at]), ([0.0; 3], 0.0), "{name} on {backend}: query {at} has no sample");
        }
        wo[at].iter().zip(expected).for_each(|(a, b)| worst[0].see((f64::from(*a) - b).abs(), at));
        // Close to the pole of the half vector, the density rises without bound, and with it the effect of the last
        // digit of a single-precision position.
        worst[1].see(relative(f64::from(pdf[at]), expected[3], 1e-3) / (1.0 + expected[3] / 100.0), at);
        for (weight, expected) in weights[at * channels..][..channels].iter().zip(&expected[4..]) {
            worst[2].see(relative(f64::from(*weight), *expected, 1e-3), at);
        }
    }
    let [direction, density, weight] = worst;
    println!("{name} on {backend}: direction {direction:?}, pdf {density:?}, weight {weight:?}");
    assert!(direction.error < 1e-4 && density.error < 1e-4 && weight.error < 1e-4, "{name} on {backend}");
}

#[test]
fn synthetic_materials_match_the_loader_of_the_database() {
    let Some(shared) = shared() else { return };
    for name in SYNTHETIC {
        let material = load(&shared.join(format!("golden/{name}.bsdf")));
        let table = Table::new(&material, Options { clamp_negative: true }).expect("a table");
        let queries = queries(&shared.join(format!("golden/{name}.powitacq.txt")));
        assert_eq!(queries.len(), 150);
        let pdf_at = table.channel_count();
        on_every_backend!(against(name, &table, &queries, pdf_at, 1e-7));
        on_every_backend!(draws(name, &table, &queries));
    }
}

#[test]
fn real_materials_match_the_loader_of_the_database() {
    let Some(shared) = shared() else { return };
    for name in REAL {
        let material = load(&shared.join(format!("data/rgl_bsdf/{name}_rgb.bsdf")));
        let table = Table::new(&material, Options { clamp_negative: true }).expect("a table");
        let queries = queries(&shared.join(format!("golden/real_{name}_rgb.bsdf.powitacq.txt")));
        assert_eq!(queries.len(), 300);
        on_every_backend!(against(name, &table, &queries, 3, 1e-3));
        on_every_backend!(draws(name, &table, &queries));
    }
}

#[test]
fn reduced_and_unweighted_materials_match_mitsuba() {
    let Some(shared) = shared() else { return };
    for name in ["rgl_aniso_spec_r2", "rgl_iso_spec_nojac"] {
        let material = load(&shared.join(format!("golden/{name}.bsdf")));
        let table = Table::new(&material, Options::default()).expect("a table");
        let mut queries = queries(&shared.join(format!("golden/{name}.mitsuba.txt")));
        assert_eq!(queries.len(), 100);
        // Seven stored wavelengths, four between them, and the density.
        queries.iter_mut().for_each(|(_, answer)| drop(answer.drain(7..11)));
        on_every_backend!(against(name, &table, &queries, 7, 1e-7));
    }
}
