//! Searches of axes of every kind: cells, weights and functions of one variable.

use std::f64::consts::TAU;

use lobe_lane::{Kernel, Lanes};
use lobe_table::{Axis, Edge, Function};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::lanes::{floats, ints};
use super::record::{Bound, Record};
use lobe_testing::patterns;

const EDGES: [Edge; 4] = [Edge::Clamp, Edge::Extrapolate, Edge::Zero, Edge::Periodic];

/// Axes of every kind of search, with every policy.
pub(super) struct Searches;

impl Kernel for Searches {
    type Out = Vec<Record>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<Record> {
        let mut records = Vec::new();
        for (kind, knots) in knots() {
            for edge in EDGES {
                let mut rng = Pcg32::seed_from_u64(knots.len() as u64);
                let values: Vec<f64> = knots.iter().map(|_| rng.random_range(-1.0..1.0)).collect();
                let function = Function::new(&knots, &values, edge).expect("valid knots");
                search(lanes, kind, &function, &mut records);
            }
        }
        records
    }
}

/// Named lists of knots, ascending, in `[0, 2 pi]`.
fn knots() -> Vec<(&'static str, Vec<f64>)> {
    let mut rng = Pcg32::seed_from_u64(33);
    let mut random = |n: usize, from: f64, to: f64| -> Vec<f64> {
        let mut position = 0.0;
        let mut steps: Vec<f64> = (0..n).map(|_| rng.random_range(0.05..1.0)).collect();
        for step in &mut steps {
            position += *step;
            *step = position;
        }
        steps.iter().map(|step| from + (to - from) * (step - steps[0]) / (position - steps[0])).collect()
    };
    let mut all = vec![("constant", vec![0.7])];
    for n in [2, 3, 4, 10, 91, 361] {
        let step = TAU / f64::from(n - 1);
        all.push(("uniform", (0..n).map(|i| f64::from(i) * step).collect()));
    }
    for n in 2..=33 {
        all.push(("few knots", random(n, 0.01 * n as f64, TAU - 0.02 * n as f64)));
    }
    for n in [34, 35, 64, 100, 300, 700] {
        all.push(("many knots", random(n, 0.0, TAU)));
    }
    // So close together that a bucket of the guide table holds several.
    let mut crowded = random(60, 1.0, 1.0005);
    crowded.extend(random(20, 2.0, 6.0));
    all.push(("crowded knots", crowded));
    all
}

/// Queries at the knots and one step to either side, between them, just outside and far outside, and with adversarial
/// bits.
fn queries(axis: &Axis) -> Vec<f32> {
    let knots = axis.knots();
    let mut queries: Vec<f32> = knots.iter().flat_map(|&knot| [knot, knot.next_down(), knot.next_up()]).collect();
    queries.extend(knots.windows(2).flat_map(|ends| [0.01, 0.3, 0.5, 0.99].map(|t| ends[0] + t * (ends[1] - ends[0]))));
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    queries.extend([9e-7, 1.1e-6, 1e-3, 0.5, 7.0, 100.0, 1e10].into_iter().flat_map(|by| [first - by, last + by]));
    queries.extend(patterns::floats());
    patterns::padded(queries)
}

#[inline(always)]
fn search<L: Lanes>(lanes: L, kind: &str, function: &Function, records: &mut Vec<Record>) {
    let axis = function.axis();
    let queries = queries(axis);
    let (mut cells, mut fractions) = (Vec::new(), Vec::new());
    let (mut indices, mut lower, mut upper) = (Vec::new(), Vec::new(), Vec::new());
    let mut values = Vec::new();
    let mut at = 0;
    while at < queries.len() {
        let x = lanes.load(&queries[at..]);
        let cell = axis.cell(lanes, x);
        ints(lanes, cell.index, &mut cells);
        floats(lanes, cell.fraction, &mut fractions);
        let (index, [low, high]) = axis.weights(lanes, x);
        ints(lanes, index, &mut indices);
        floats(lanes, low, &mut lower);
        floats(lanes, high, &mut upper);
        floats(lanes, function.eval(lanes, x), &mut values);
        at += L::LANES;
    }
    let right = queries.iter().zip(&cells).map(|(&x, &cell)| is_cell_of(axis, kind, x, cell)).collect::<Vec<bool>>();
    let bounds = values.iter().map(|&value| function_bound(value)).collect();
    records.push(Record::exact(format!("{kind}: cell is right"), right));
    records.push(Record::exact(format!("{kind}: cell"), cells));
    records.push(Record::exact(format!("{kind}: fraction"), fractions));
    records.push(Record::exact(format!("{kind}: weights index"), indices));
    records.push(Record::exact(format!("{kind}: lower weight"), lower));
    records.push(Record::exact(format!("{kind}: upper weight"), upper));
    records.push(Record::bounded(format!("{kind}: function"), values, Bound::Each(bounds)));
}

/// `true` if `cell` contains `x`: exactly, or up to the rounding of a cell if the position is computed and not searched
/// for. Queries outside belong to the outermost cells.
fn is_cell_of(axis: &Axis, kind: &str, x: f32, cell: u32) -> bool {
    let knots = axis.knots();
    let last = knots.len().saturating_sub(2);
    let cell = cell as usize;
    if x.is_nan() || knots.len() == 1 {
        return cell <= last;
    }
    let expected = knots[1..knots.len() - 1].partition_point(|&knot| knot <= x);
    if kind == "uniform" {
        let slack = 1e-6;
        return cell <= last
            && (cell == expected || (x - knots[cell]).abs() < slack || (x - knots[cell + 1]).abs() < slack);
    }
    cell == expected
}

/// `value + t slope` with the product rounded or not: half an ulp of the product and half an ulp of the sum in each
/// form. The product is at most the result and the first value together, and values are at most 1.
fn function_bound(value: f32) -> f64 {
    const UNIT: f64 = 1.0 / (1 << 24) as f64;
    if value.is_finite() { 4.0 * UNIT * (1.0 + f64::from(value.abs())) } else { 0.0 }
}
