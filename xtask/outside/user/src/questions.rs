//! The timed questions: every kernel that the library offers for lanes that are not a backend.

use std::sync::Arc;

use lobe::table::paper::PaperTable;
use lobe::table::rgl::{self, Drawn, UniformOrder, Wanted};
use lobe::table::window::tensor_tree::Rank;
use lobe::table::window::{Block, Component};
use lobe::table::{
    PatchSampler, Sampled, Sampler, SamplerOptions, half_diff, mueller, scattered, spherical, utia, window,
};
use lobe::{Axis, Backend, Decode, Directions, Edge, Edges, Lookup, specular};
use lobe_benches::contest::angles;
use lobe_benches::tables;
use lobe_benches::workload::{Input, Pairs};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use crate::kernels::{Acos, Azimuth, InLanes, Sample, Search};

/// Answers a question for all queries.
pub type Run = Box<dyn FnMut()>;

/// Queries per call: they take a few to a few hundred microseconds.
const COUNT: usize = 4096;
/// Calls with one query each.
const SINGLES: usize = 1024;

pub const QUESTIONS: &[(&str, fn() -> Run)] = &[
    ("acos", acos),
    ("azimuth", azimuth),
    ("search-17", || search(tables::anisotropic().knots()[2].clone())),
    ("search-60", || search((0..60).map(|knot| 3.1 * (f64::from(knot) / 59.0).powi(2)).collect())),
    ("iso", || batch(tables::isotropic(), Backend::fused)),
    ("iso-strict", || batch(tables::isotropic(), Backend::strict)),
    ("iso-lanes", || in_lanes(tables::isotropic())),
    ("iso-single", || single(tables::isotropic())),
    ("iso-paper", || paper(tables::isotropic())),
    ("iso-interpolation", || interpolation(tables::isotropic())),
    ("iso-sample", || sample(tables::isotropic())),
    ("aniso", || batch(tables::anisotropic(), Backend::fused)),
    ("aniso-lanes", || in_lanes(tables::anisotropic())),
    ("aniso-single", || single(tables::anisotropic())),
    ("aniso-interpolation", || interpolation(tables::anisotropic())),
    ("aniso-sample", || sample(tables::anisotropic())),
    ("rgl-eval", || rgl_values(false)),
    ("rgl-pdf", || rgl_values(true)),
    ("rgl-sample", rgl_sample),
    ("half-diff", || half_difference(Lookup::Nearest)),
    ("half-diff-linear", || half_difference(Lookup::Linear)),
    ("spherical", on_grid),
    ("scattered", samples),
    ("utia", utia_grid),
    ("klems", || sheet(tables::klems())),
    ("tensor-tree", || sheet(tables::tensor_tree(Rank::Four))),
    ("klems-sample", patches),
    ("mueller", matrices),
];

fn backend() -> Backend {
    Backend::detect().expect("LOBE_BACKEND, if it is set, names a backend of this machine")
}

fn columns(pairs: &Pairs) -> [Directions<'_>; 2] {
    [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z))
}

fn pairs() -> Pairs {
    Input::Incoherent.pairs(COUNT)
}

fn uniforms() -> Vec<[f32; 2]> {
    let mut rng = Pcg32::seed_from_u64(2005);
    (0..COUNT).map(|_| [rng.random(), rng.random()]).collect()
}

fn table(data: &specular::Data) -> specular::Table {
    specular::Table::new(data, &Edges::default()).expect("a small table")
}

fn acos() -> Run {
    let (backend, x) = (backend(), Input::Incoherent.thetas(COUNT));
    let x: Vec<f32> = x.iter().map(|theta| theta.cos() as f32).collect();
    let mut out = vec![0.0; COUNT];
    Box::new(move || backend.run(Acos { x: &x, out: &mut out }))
}

fn azimuth() -> Run {
    let (backend, pairs, mut out) = (backend(), pairs(), vec![0.0; COUNT]);
    Box::new(move || backend.run(Azimuth { x: &pairs.wi[0], y: &pairs.wi[1], out: &mut out }))
}

fn search(knots: Vec<f64>) -> Run {
    let axis = Axis::new(&knots, Edge::Clamp).expect("ascending knots");
    let (backend, angles) = (backend(), Input::Incoherent.thetas(COUNT));
    let angles: Vec<f32> = angles.iter().map(|&angle| angle as f32).collect();
    let (mut cells, mut fractions) = (vec![0; COUNT], vec![0.0; COUNT]);
    Box::new(move || {
        backend.run(Search { axis: &axis, angles: &angles, cells: &mut cells, fractions: &mut fractions });
    })
}

fn batch(data: specular::Data, form: fn(Backend) -> Backend) -> Run {
    let (backend, table, pairs, mut out) = (form(backend()), table(&data), pairs(), vec![0.0; 3 * COUNT]);
    Box::new(move || {
        let [wi, wo] = columns(&pairs);
        backend.run(table.batch(wi, wo, &mut out));
    })
}

fn in_lanes(data: specular::Data) -> Run {
    let (backend, table, (wi, wo)) = (backend(), table(&data), pairs().vectors());
    let mut out = [(); 3].map(|()| vec![0.0; COUNT]);
    Box::new(move || {
        let [r, g, b] = &mut out;
        backend.run(InLanes { table: &table, wi: &wi, wo: &wo, out: [r, g, b] });
    })
}

fn single(data: specular::Data) -> Run {
    let (backend, table, (wi, wo)) = (backend(), table(&data), pairs().vectors());
    let mut out = vec![[0.0; 3]; SINGLES];
    Box::new(move || {
        for ((out, wi), wo) in out.iter_mut().zip(&wi).zip(&wo) {
            backend.run_narrow(table.single(*wi, *wo, out));
        }
    })
}

fn paper(data: specular::Data) -> Run {
    let (backend, table, pairs) = (backend(), PaperTable::new(&data).expect("a small RGB table"), pairs());
    let mut out = [(); 3].map(|()| vec![0.0; COUNT]);
    Box::new(move || {
        let ([wi, wo], [r, g, b]) = (columns(&pairs), &mut out);
        backend.run(table.batch(wi, wo, [r, g, b]));
    })
}

fn interpolation(data: specular::Data) -> Run {
    let (backend, table, angles) = (backend(), table(&data), angles(Input::Incoherent, COUNT));
    let mut out = vec![0.0; 3 * COUNT];
    Box::new(move || backend.run(table.interpolation(angles.each_ref().map(Vec::as_slice), &mut out)))
}

fn sample(data: specular::Data) -> Run {
    let backend = backend();
    let sampler = Sampler::new(backend, Arc::new(table(&data)), &SamplerOptions::default()).expect("valid options");
    let (known, uniforms) = (pairs().vectors().0, uniforms());
    let (mut directions, mut pdfs, mut weights) = (vec![[0.0; 3]; COUNT], vec![0.0; COUNT], vec![0.0; 3 * COUNT]);
    Box::new(move || {
        let out = Sampled { directions: &mut directions, weights: &mut weights, pdfs: &mut pdfs };
        backend.run(Sample { sampler: &sampler, known: &known, uniforms: &uniforms, out });
    })
}

fn rgl_table() -> rgl::Table {
    rgl::Table::new(&tables::rgl(), rgl::Options::default()).expect("a small material")
}

fn rgl_values(densities: bool) -> Run {
    let (backend, table, pairs) = (backend(), rgl_table(), pairs());
    let mut out = vec![0.0; if densities { COUNT } else { 3 * COUNT }];
    Box::new(move || {
        let [wi, wo] = columns(&pairs);
        let wanted = if densities { Wanted::Pdf(&mut out) } else { Wanted::Values(&mut out) };
        backend.run(table.batch(wi, wo, wanted));
    })
}

fn rgl_sample() -> Run {
    let (backend, table, pairs, uniforms) = (backend(), rgl_table(), pairs(), uniforms());
    let (mut wo, mut pdf, mut weights) = (vec![[0.0; 3]; COUNT], vec![0.0; COUNT], vec![0.0; 3 * COUNT]);
    Box::new(move || {
        let drawn = Drawn { wo: &mut wo, pdf: &mut pdf, weights: &mut weights };
        backend.run(table.sampling(columns(&pairs)[0], &uniforms, UniformOrder::default(), drawn));
    })
}

fn half_difference(lookup: Lookup) -> Run {
    let table = half_diff::Table::new(&tables::half_difference([90, 90, 180])).expect("a grid that lanes can index");
    let (backend, pairs, mut out) = (backend(), pairs(), vec![0.0; 3 * COUNT]);
    Box::new(move || {
        let [wi, wo] = columns(&pairs);
        backend.run(table.batch(lookup, wi, wo, &mut out));
    })
}

fn on_grid() -> Run {
    let table = spherical::Table::new(&tables::spherical()).expect("a small grid");
    let (backend, pairs, mut out) = (backend(), pairs(), vec![0.0; table.channel_count() * COUNT]);
    Box::new(move || {
        let [wi, wo] = columns(&pairs);
        backend.run(table.batch(wi, wo, &mut out));
    })
}

fn samples() -> Run {
    let table = scattered::Table::new(&tables::scattered()).expect("few samples");
    let (backend, pairs, mut out) = (backend(), pairs(), vec![0.0; 3 * COUNT]);
    Box::new(move || {
        let [wi, wo] = columns(&pairs);
        backend.run(table.batch(wi, wo, &mut out));
    })
}

fn utia_grid() -> Run {
    let table = utia::Table::new(&tables::utia(), Decode::Raw).expect("a valid grid");
    let (backend, pairs, mut out) = (backend(), pairs(), vec![0.0; 3 * COUNT]);
    Box::new(move || {
        let [wi, wo] = columns(&pairs);
        backend.run(table.batch(wi, wo, &mut out));
    })
}

fn sheet(window: window::Blocks) -> Run {
    let table = window::Table::new(vec![window]).expect("a small sheet");
    let (backend, pairs, mut out) = (backend(), pairs(), vec![0.0; COUNT]);
    Box::new(move || {
        let [wi, wo] = columns(&pairs);
        backend.run(table.batch(wi, wo, &mut out));
    })
}

fn patches() -> Run {
    let window = tables::klems();
    let Some(Component::Klems(matrix)) = window.block(Block::ReflectionBack) else { panic!("a sheet of matrices") };
    let sampler = PatchSampler::new(lobe::Scatter::Reflection, &[(matrix, 1.0)], 0.05);
    let sampler = sampler.expect("a part of a cosine").expect("a matrix");
    let (backend, known, uniforms) = (backend(), pairs().vectors().0, uniforms());
    let (mut directions, mut pdfs) = (vec![[0.0; 3]; COUNT], vec![0.0; COUNT]);
    Box::new(move || backend.run(sampler.drawing(&known, &uniforms, &mut directions, &mut pdfs)))
}

fn matrices() -> Run {
    let table = mueller::Table::new(&tables::mueller()).expect("a small table");
    let (backend, pairs, mut out) = (backend(), pairs(), vec![0.0; table.channel_count() * COUNT]);
    Box::new(move || {
        let [wi, wo] = columns(&pairs);
        backend.run(table.batch(wi, wo, &mut out));
    })
}
