//! Complete evaluations of all representations except specular tables.

use std::sync::OnceLock;

use lobe_benches::tables::{
    half_difference, klems, mueller, polarised, scattered, spherical, spherical_anisotropic, tensor_tree, utia,
};
use lobe_benches::workload::Input;
use lobe_table::half_diff::{self, Lookup};
use lobe_table::utia::{self, Decode};
use lobe_table::window::tensor_tree::Rank;
use lobe_table::{Channels, Directions, Edges, Scatter, mueller, polarised, scattered, specular, spherical, window};

use super::bound::FusedBound;
use super::machine::{Machine, Pairs};
use super::record::{Bound, Record};
use super::tables::{Queries, adversarial, not_unit, workload};

/// A representation and its queries.
struct Case {
    name: &'static str,
    representation: Representation,
    width: usize,
    /// The bound of the difference between lanes and the exact value, or the values from which they may choose.
    reference: Box<dyn Fn([f64; 3], [f64; 3]) -> f64 + Send + Sync>,
    /// `true` if directions have to be unit vectors.
    needs_unit: bool,
}

enum Representation {
    HalfDiff(half_diff::Table, Lookup),
    Spherical(Box<spherical::Table>),
    Scattered(Box<scattered::Table>),
    Utia(Box<utia::Table>),
    Mueller(Box<mueller::Table>),
    Matrices(Box<mueller::Matrices>),
    Polarised(Box<polarised::Matrices>),
    Window(window::Table),
}

impl Representation {
    fn eval_batch(&self, machine: impl Machine, pairs: Pairs<'_>, out: &mut [f32]) {
        match self {
            Representation::HalfDiff(table, lookup) => machine.half_diff(table, *lookup, pairs, out),
            Representation::Spherical(table) => machine.spherical(table, pairs, out),
            Representation::Scattered(table) => machine.scattered(table, pairs, out),
            Representation::Utia(table) => machine.utia(table, pairs, out),
            Representation::Mueller(table) => machine.mueller(table, pairs, out),
            Representation::Matrices(table) => machine.matrices(table, pairs, out),
            Representation::Polarised(table) => machine.polarised(table, pairs, out),
            Representation::Window(table) => machine.window(table, pairs, out),
        }
    }
}

/// Records the results of a case.
pub(super) fn record(machine: impl Machine) -> Vec<Record> {
    let mut records = Vec::new();
    for case in cases() {
        for (set, queries, bounds) in &case.sets() {
            evaluate(machine, case, set, queries, bounds.as_deref(), &mut records);
        }
    }
    records
}

impl Case {
    /// Named queries, and for each the bound of the fused form's difference; `None` if nothing is promised.
    fn sets(&self) -> [(&'static str, Queries, Option<Vec<f64>>); 4] {
        let bounded = |mut queries: Queries| {
            if self.needs_unit {
                queries = of_unit_length(&queries);
            }
            let pairs = queries.wi.iter().zip(&queries.wo);
            // Both forms are this close to the exact value.
            let bound = |(&wi, &wo): (&[f32; 3], &[f32; 3])| {
                unit(wi).zip(unit(wo)).map_or(0.0, |(wi, wo)| 2.0 * (self.reference)(wi, wo))
            };
            let bounds = pairs.map(bound).collect();
            (queries, Some(bounds))
        };
        let (incoherent, a) = bounded(on_all_sides(workload(Input::Incoherent)));
        let (coherent, b) = bounded(workload(Input::Coherent));
        let (adversarial, c) = bounded(adversarial());
        [
            ("incoherent", incoherent, a),
            ("coherent", coherent, b),
            ("adversarial", adversarial, c),
            ("not unit", if self.needs_unit { Queries::default() } else { not_unit() }, None),
        ]
    }
}

fn evaluate(
    machine: impl Machine,
    case: &Case,
    set: &str,
    Queries { wi, wo }: &Queries,
    bounds: Option<&[f64]>,
    records: &mut Vec<Record>,
) {
    let Case { name, representation, width, .. } = case;
    let mut vectors = vec![f32::NAN; wi.len() * width];
    representation.eval_batch(machine, [wi.into(), wo.into()], &mut vectors);
    let mut components = vec![f32::NAN; vectors.len()];
    let [[ix, iy, iz], [ox, oy, oz]] =
        [wi, wo].map(|w| [0, 1, 2].map(|k| w.iter().map(|v| v[k]).collect::<Vec<f32>>()));
    let columns = [Directions::columns(&ix, &iy, &iz), Directions::columns(&ox, &oy, &oz)];
    representation.eval_batch(machine, columns, &mut components);

    let agree = vectors.iter().zip(&components).map(|(a, b)| a.to_bits() == b.to_bits()).collect::<Vec<bool>>();
    records.push(Record::exact(format!("{name}, {set}: components as vectors"), agree));
    let finite = vectors.iter().map(|value| value.is_finite()).collect::<Vec<bool>>();
    records.push(Record::exact(format!("{name}, {set}: finite"), finite));
    let nowhere = vectors.chunks_exact(*width).zip(wi.iter().zip(wo)).filter(|(_, (wi, wo))| {
        let none = |w: &[f32; 3]| unit(*w).is_none() || w[2] == 0.0;
        none(wi) || none(wo)
    });
    let dark = nowhere.map(|(value, _)| value.iter().all(|x| *x == 0.0)).collect::<Vec<bool>>();
    records.push(Record::exact(format!("{name}, {set}: 0 where there is no value"), dark));
    let bound = match bounds {
        None => Bound::StrictOnly,
        Some(bounds) => Bound::Each(bounds.iter().flat_map(|bound| std::iter::repeat_n(*bound, *width)).collect()),
    };
    records.push(Record::bounded(format!("{name}, {set}: values"), vectors, bound));
}

/// All cases, created once. The tables of the benchmarks have values of at most 1, all different from each other.
fn cases() -> &'static [Case] {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    CASES.get_or_init(|| {
        let mut cases = Vec::new();
        let half = half_difference([30, 20, 40]);
        let table = half_diff::Table::new(&half).expect("a small grid");
        for lookup in [Lookup::Nearest, Lookup::Linear] {
            let (name, half) =
                (if lookup == Lookup::Linear { "half-difference, linear" } else { "half-difference" }, half.clone());
            let reference: Box<dyn Fn(_, _) -> f64 + Send + Sync> = match lookup {
                Lookup::Linear => Box::new(move |wi, wo| half.bound(wi, wo).min(0.5)),
                Lookup::Nearest => Box::new(move |wi, wo| {
                    let candidates = half.candidates(wi, wo);
                    (0..3).map(|k| spread(candidates.iter().map(|value| value[k]))).fold(0.0, f64::max)
                }),
            };
            let representation = Representation::HalfDiff(table.clone(), lookup);
            cases.push(Case { name, representation, width: 3, reference, needs_unit: false });
        }
        let grids = [("spherical", spherical()), ("spherical, anisotropic", spherical_anisotropic())];
        for (name, grid) in grids {
            let table = spherical::Table::new(&grid).expect("a small grid");
            cases.push(Case {
                name,
                width: table.channel_count(),
                representation: Representation::Spherical(Box::new(table)),
                reference: Box::new(move |wi, wo| grid.bound(wi, wo)),
                needs_unit: false,
            });
        }
        let samples = scattered();
        let table = scattered::Table::new(&samples).expect("few samples");
        cases.push(Case {
            name: "scattered",
            representation: Representation::Scattered(Box::new(table)),
            width: 3,
            reference: Box::new(move |wi, wo| samples.bound(wi, wo)),
            needs_unit: false,
        });
        let grid = utia();
        let largest = grid.values().iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let table = utia::Table::new(&grid, Decode::Raw).expect("a valid grid");
        cases.push(Case {
            name: "UTIA",
            representation: Representation::Utia(Box::new(table)),
            width: 3,
            reference: Box::new(move |wi, wo| largest * grid.bound(wi, wo)),
            needs_unit: false,
        });
        let matrices = mueller();
        let table = mueller::Table::new(&matrices).expect("a small table");
        cases.push(Case {
            name: "Mueller",
            width: table.channel_count(),
            representation: Representation::Mueller(Box::new(table)),
            reference: Box::new(move |wi, wo| matrices.bound(wi, wo)),
            needs_unit: false,
        });
        let matrices = lobe_benches::tables::matrices();
        let table = mueller::Matrices::new(&matrices).expect("a small table");
        cases.push(Case {
            name: "Mueller matrices",
            width: 16 * table.wavelength_count(),
            representation: Representation::Matrices(Box::new(table)),
            reference: Box::new(move |wi, wo| matrices.bound(wi, wo) + 4.0 * mueller::turned(wi, wo)),
            needs_unit: false,
        });
        let matrices = polarised();
        let edges = Edges::default();
        let table = polarised::Matrices::new(&matrices, &edges).expect("a small table");
        let width = 16 * table.wavelength_count();
        // The same numbers as channels of a specular table.
        let channels = Channels::Spectral((0..width).map(|k| 400.0 + k as f64).collect());
        let (knots, values) = (matrices.knots().clone(), matrices.values().to_vec());
        let elements = specular::Data::new(Scatter::Reflection, knots, channels, values).expect("valid matrices");
        // The cases live as long as the program.
        let bound = FusedBound::new(Box::leak(Box::new(elements)), Box::leak(Box::new(edges)));
        cases.push(Case {
            name: "polarised",
            width,
            representation: Representation::Polarised(Box::new(table)),
            // A rotation of both frames at most doubles an error.
            reference: Box::new(move |wi, wo| {
                bound.at(wi.map(|x| x as f32), wo.map(|x| x as f32)) + 4.0 * mueller::turned(wi, wo)
            }),
            needs_unit: true,
        });
        let sheets = [
            ("Klems", klems()),
            ("tensor tree, 3", tensor_tree(Rank::Three)),
            ("tensor tree, 4", tensor_tree(Rank::Four)),
        ];
        for (name, window) in sheets {
            let table = window::Table::new(vec![window.clone()]).expect("a small sheet");
            let reference = Box::new(move |wi, wo| spread(window.candidates(wi, wo).into_iter()));
            cases.push(Case {
                name,
                representation: Representation::Window(table),
                width: 1,
                reference,
                needs_unit: false,
            });
        }
        cases
    })
}

/// The pairs of unit vectors.
fn of_unit_length(queries: &Queries) -> Queries {
    let is_unit = |w: &[f32; 3]| (w.iter().map(|x| f64::from(x * x)).sum::<f64>() - 1.0).abs() < 1e-6;
    let pairs = queries.wi.iter().zip(&queries.wo).filter(|(wi, wo)| is_unit(wi) && is_unit(wo));
    let (wi, wo) = pairs.map(|(wi, wo)| (*wi, *wo)).unzip();
    Queries { wi, wo }
}

/// Half the range of the values from which lanes may choose: 0 if they have no choice.
fn spread(candidates: impl Iterator<Item = f64>) -> f64 {
    let (least, most) =
        candidates.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
    0.5 * (most - least)
}

/// Makes some of the queries come from below the horizon, and some go below it.
fn on_all_sides(mut queries: Queries) -> Queries {
    for (query, (wi, wo)) in queries.wi.iter_mut().zip(&mut queries.wo).enumerate() {
        wi[2] *= if query % 5 == 3 { -1.0 } else { 1.0 };
        wo[2] *= if query % 7 == 2 { -1.0 } else { 1.0 };
    }
    queries
}

/// The direction in `f64`; `None` if it is zero or not finite.
fn unit(w: [f32; 3]) -> Option<[f64; 3]> {
    let w = w.map(f64::from);
    let length = w.iter().map(|x| x * x).sum::<f64>().sqrt();
    (1e-15..1e15).contains(&length).then(|| w.map(|x| x / length))
}
