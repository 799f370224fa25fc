//! Tables of every layout, with their queries.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use lobe_benches::workload::{Input, Pairs};
use lobe_table::{Channels, Data, Edges, Scatter, specular};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::bound::FusedBound;

/// Queries of each workload: whole blocks, and a remainder that is not a multiple of any number of lanes.
const QUERIES: usize = 64 * 4 + 3;

/// A table and its queries.
pub(super) struct Case {
    /// The name of the results; several cases share a name.
    pub(super) name: String,
    pub(super) table: specular::Table,
    /// The largest magnitude of a value of the table.
    pub(super) largest: f64,
    pub(super) queries: Queries,
    /// For each query, the bound of the fused form's difference; `None` for queries that are not unit vectors.
    pub(super) bounds: Option<Vec<Allowed>>,
}

/// The bound of the fused form's difference.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    pub(super) difference: f64,
    /// `true` if the query is at a step of the table.
    pub(super) at_step: bool,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Queries {
    pub(super) wi: Vec<[f32; 3]>,
    pub(super) wo: Vec<[f32; 3]>,
}

/// All cases, created once: random tables and, if they exist, the files of `fixtures/`.
pub(super) fn cases() -> &'static [Case] {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    CASES.get_or_init(|| {
        let mut cases = Vec::new();
        let mut seed = 0;
        for channels in [1, 2, 3, 4, 8, 31] {
            for anisotropic in [false, true] {
                for scatter in [Scatter::Reflection, Scatter::Transmission] {
                    for edges in [Edges::default(), Edges::extrapolate(), Edges::zero()] {
                        let samples = random(seed, channels, anisotropic, scatter);
                        add(&mut cases, &format!("{channels} channels"), &samples, &edges);
                        seed += 1;
                    }
                }
            }
        }
        for path in fixtures() {
            let document = lobe_formats::open(&path).map(|(_, document)| document);
            let Some(Data::Specular(samples)) = document.as_ref().ok().and_then(|document| document.only()) else {
                panic!("{}: not a readable table", path.display());
            };
            for edges in [Edges::default(), Edges::extrapolate(), Edges::zero()] {
                let name = path.file_name().expect("a file").to_string_lossy();
                add(&mut cases, &name, samples, &edges);
            }
        }
        cases
    })
}

fn add(cases: &mut Vec<Case>, name: &str, samples: &specular::Data, edges: &Edges) {
    let table = specular::Table::new(samples, edges).expect("a valid table");
    let bound = FusedBound::new(samples, edges);
    let sets = [
        ("incoherent", workload(Input::Incoherent), true),
        ("coherent", workload(Input::Coherent), true),
        ("adversarial", adversarial(), true),
        ("not unit", not_unit(), false),
    ];
    for (set, queries, unit) in sets {
        let allowed = |(&wi, &wo): (&[f32; 3], &[f32; 3])| {
            let difference = bound.at(wi, wo);
            Allowed { difference, at_step: bound.is_void(difference) }
        };
        let bounds = || queries.wi.iter().zip(&queries.wo).map(allowed).collect();
        let (name, bounds) = (format!("{name}, {set}"), unit.then(bounds));
        cases.push(Case { name, table: table.clone(), largest: bound.largest(), queries, bounds });
    }
}

/// The tables in `fixtures/`, in the order of their names; empty if the folder does not exist.
fn fixtures() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .map(|entries| entries.filter_map(|entry| Some(entry.ok()?.path())).collect())
        .unwrap_or_default();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "ddr"));
    files.sort();
    files
}

/// A table of random values, some negative, whose knots are searched in all ways over the seeds. The ends of psi and
/// phi agree if the knots close the circle.
fn random(seed: u64, channels: usize, anisotropic: bool, scatter: Scatter) -> specular::Data {
    let mut rng = Pcg32::seed_from_u64(seed);
    let closed = rng.random::<bool>();
    let mut axis = |sizes: [usize; 3], end: f64, closed: bool| -> Vec<f64> {
        let n = sizes[rng.random_range(0..3)];
        let uniform = rng.random_range(0..3) == 0;
        let mut at: Vec<f64> =
            (0..n).map(|i| i as f64 + if uniform { 0.0 } else { rng.random_range(-0.4..0.4) }).collect();
        at[0] = 0.0;
        let span = if closed && n > 1 { at[n - 1] } else { n as f64 };
        at.iter().map(|x| end * x / span).collect()
    };
    let sigma = axis([4, 7, 1], FRAC_PI_2, seed.is_multiple_of(5));
    let psi = if anisotropic { axis([5, 3, 11], TAU, closed) } else { vec![0.0] };
    let theta = axis([9, 19, 40], PI, seed.is_multiple_of(2));
    let phi = axis([13, 6, 36], TAU, closed);

    let sizes = [sigma.len(), psi.len(), theta.len(), phi.len()];
    let mut values = Vec::new();
    for node in 0..sizes.iter().product::<usize>() {
        let (phi_index, psi_index) = (node % sizes[3], node / (sizes[3] * sizes[2]) % sizes[1]);
        // If a circle closes, its last values are its first.
        let mut source = node;
        if closed && phi_index + 1 == sizes[3] {
            source -= phi_index;
        }
        if closed && psi_index > 0 && psi_index + 1 == sizes[1] {
            source -= psi_index * sizes[2] * sizes[3];
        }
        for channel in 0..channels {
            let first: Option<f32> = (source < node).then(|| values[source * channels + channel]);
            values.push(first.unwrap_or_else(|| rng.random_range(-0.2..1.0)));
        }
    }
    let channels = match channels {
        1 => Channels::Mono,
        3 => Channels::Rgb,
        n => Channels::Spectral((0..n).map(|k| 400.0 + 10.0 * k as f64).collect()),
    };
    let offsets: Vec<f64> = sigma.iter().map(|s| (s.sin() / 1.5).asin() - s).collect();
    let samples = specular::Data::new(scatter, [sigma, psi, theta, phi], channels, values).expect("valid samples");
    match scatter {
        Scatter::Reflection => samples,
        Scatter::Transmission => samples.with_refraction(offsets).expect("one offset per knot"),
    }
}

pub(super) fn workload(input: Input) -> Queries {
    let pairs: Pairs = input.pairs(QUERIES);
    let (wi, wo) = pairs.vectors();
    Queries { wi, wo }
}

/// All pairs of the normal and its neighbours, grazing directions, mirror images, directions below the horizon, and
/// invalid directions.
pub(super) fn adversarial() -> Queries {
    let mut directions = vec![
        [0.0, 0.0, 1.0],
        [-0.0, -0.0, 1.0],
        [1e-20, -1e-20, 1.0],
        [1e-7, 0.0, 1.0],
        [-3e-4, 2e-4, 1.0],
        [1.0, 0.0, 0.0],
        [1.0, 0.0, -0.0],
        [0.0, -1.0, 1e-40],
        [-1.0, 0.0, 1e-7],
        [0.0, 0.0, -1.0],
        [0.0, 0.0, 0.0],
        [f32::NAN, 0.0, 1.0],
        [0.0, f32::NAN, 1.0],
        [0.6, 0.0, f32::NAN],
        [f32::INFINITY, 0.0, 1.0],
        [0.0, f32::NEG_INFINITY, 0.5],
        [0.0, 0.0, f32::INFINITY],
        [f32::MAX, f32::MAX, f32::MAX],
    ];
    for (sigma, psi) in [(0.3, 0.0), (0.6, 1.0), (1.1, 2.5), (1.4, 4.0), (1.57, 6.2)] {
        let (sin, cos) = (f64::sin(sigma), f64::cos(sigma));
        let [x, y, z] = [sin * f64::cos(psi), sin * f64::sin(psi), cos].map(|c| c as f32);
        // The direction, its mirror image exactly and nearly, its reverse below the horizon, and across.
        directions.extend([[x, y, z], [-x, -y, z], [-x.next_up(), -y, z], [-x, -y, -z], [-y, x, z]]);
    }
    let mut queries = Queries::default();
    for &wi in &directions {
        for &wo in &directions {
            queries.wi.push(wi);
            queries.wo.push(wo);
        }
    }
    queries
}

/// Vectors of any length, for which nothing is promised except the bits of the strict form.
pub(super) fn not_unit() -> Queries {
    let mut rng = Pcg32::seed_from_u64(5);
    let mut vector = || {
        let scale = 10f32.powi(rng.random_range(-3..2));
        std::array::from_fn(|k| scale * rng.random_range(if k == 2 { -0.1..1.0 } else { -1.0..1.0 }))
    };
    let (wi, wo) = (0..QUERIES).map(|_| (vector(), vector())).unzip();
    Queries { wi, wo }
}
