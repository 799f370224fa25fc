//! Materials of the EPFL database: values, densities and samples.

use std::sync::OnceLock;

use lobe_benches::tables;
use lobe_benches::workload::Input;
use lobe_table::rgl::{self, Drawn, Wanted};

use super::machine::Machine;
use super::record::{Bound, Record};
use super::sampling::numbers;
use super::tables::{Queries, adversarial, workload};

/// The largest difference between either form and `f64`: of values and densities, relative to the larger of the value
/// and one, and of directions; of densities and weights of samples. `docs/accuracy.md` says which tests check this.
const VALUE: f64 = 2e-5;
const DIRECTION: f64 = 2e-5;
const SAMPLE: f64 = 1e-4;

/// An isotropic and an anisotropic material.
fn materials() -> &'static [(&'static str, rgl::Table)] {
    static MATERIALS: OnceLock<Vec<(&str, rgl::Table)>> = OnceLock::new();
    MATERIALS.get_or_init(|| {
        let table = |rgl| rgl::Table::new(&rgl, rgl::Options::default()).expect("a small material");
        vec![("isotropic", table(tables::rgl())), ("anisotropic", table(tables::rgl_anisotropic()))]
    })
}

/// Both materials and all queries.
pub(super) fn record(machine: impl Machine) -> Vec<Record> {
    let sets = [
        ("incoherent", workload(Input::Incoherent)),
        ("coherent", workload(Input::Coherent)),
        ("adversarial", adversarial()),
    ];
    let mut records = Vec::new();
    for (kind, table) in materials() {
        for (set, queries) in &sets {
            records.extend(evaluate(machine, &format!("{kind}, {set}"), table, queries));
            records.extend(sample(machine, &format!("{kind}, {set}"), table, queries));
        }
    }
    records
}

fn evaluate(machine: impl Machine, name: &str, table: &rgl::Table, Queries { wi, wo }: &Queries) -> [Record; 3] {
    let values = || vec![f32::NAN; wi.len() * table.channel_count()];
    let (mut f, mut cos, mut pdf) = (values(), values(), vec![f32::NAN; wi.len()]);
    machine.rgl(table, [wi.into(), wo.into()], Wanted::ValuesAndPdf(&mut f, &mut pdf));
    machine.rgl(table, [wi.into(), wo.into()], Wanted::ValuesCos(&mut cos));
    let bounds = |values: &[f32], unit: &dyn Fn(usize) -> f64| {
        let each = values.len() / wi.len();
        let bound = |(at, value): (usize, &f32)| 2.0 * VALUE * f64::from(value.abs()).max(unit(at / each));
        Bound::Each(values.iter().enumerate().map(bound).collect())
    };
    // A value without the cosine is the value with it, divided by the cosine.
    let f_bound = bounds(&f, &|query| 1.0 / f64::from(wo[query][2].abs()));
    let (cos_bound, pdf_bound) = (bounds(&cos, &|_| 1.0), bounds(&pdf, &|_| 1.0));
    [
        Record::bounded(format!("{name}: values"), f, f_bound),
        Record::bounded(format!("{name}: values with the cosine"), cos, cos_bound),
        Record::bounded(format!("{name}: densities"), pdf, pdf_bound),
    ]
}

fn sample(machine: impl Machine, name: &str, table: &rgl::Table, Queries { wi, .. }: &Queries) -> [Record; 3] {
    let channels = table.channel_count();
    let mut directions = vec![[f32::NAN; 3]; wi.len()];
    let (mut pdf, mut weights) = (vec![f32::NAN; wi.len()], vec![f32::NAN; wi.len() * channels]);
    let drawn = Drawn { wo: &mut directions, pdf: &mut pdf, weights: &mut weights };
    machine.rgl_sample(table, wi.into(), &numbers(wi.len()), drawn);

    // A sample along the surface may lie on either side of it, and is rejected on one of them.
    let along = |query: usize| directions[query][2] < 10.0 * DIRECTION as f32 && wi[query][2] > 0.0;
    let bounds = |values: &[f32], bound: &dyn Fn(f64) -> f64| {
        let each = values.len() / wi.len();
        let bound = |(at, value): (usize, &f32)| {
            if along(at / each) { f64::INFINITY } else { bound(f64::from(value.abs())) }
        };
        Bound::Each(values.iter().enumerate().map(bound).collect())
    };
    let wo_bound = bounds(directions.as_flattened(), &|_| 2.0 * DIRECTION);
    let pdf_bound = bounds(&pdf, &|pdf| 2.0 * SAMPLE * pdf);
    let weights_bound = bounds(&weights, &|weight| 2.0 * SAMPLE * weight.max(1.0));
    [
        Record::bounded(format!("{name}: directions of samples"), directions.into_flattened(), wo_bound),
        Record::bounded(format!("{name}: densities of samples"), pdf, pdf_bound),
        Record::bounded(format!("{name}: weights"), weights, weights_bound),
    ]
}
