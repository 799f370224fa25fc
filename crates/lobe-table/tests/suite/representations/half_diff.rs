//! Grids of half and difference angles.

use lobe_backend::Backend;
use lobe_table::Directions;
use lobe_table::half_diff::{self, Lookup};

use super::common::{COUNT, Evaluate, NOWHERE, Pairs, evaluate};

struct Look(half_diff::Table, Lookup);

impl Evaluate for Look {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.0.eval_batch(backend, self.1, wi, wo, out);
    }
}

/// A small grid of MERL's shape, one that is not reciprocal, and the smallest possible one.
const SHAPES: [[usize; 3]; 4] = [[45, 45, 90], [9, 7, 30], [1, 1, 1], [2, 3, 1]];

fn grid(bins: [usize; 3], value: impl Fn(usize) -> f32) -> (half_diff::Data, half_diff::Table) {
    let values = (0..3 * bins.iter().product::<usize>()).map(value).collect();
    let data = half_diff::Data::new(bins, values).expect("a grid");
    let table = half_diff::Table::new(&data).expect("a small grid");
    (data, table)
}

/// Every bin has different values, and some are unmeasured.
fn coded(i: usize) -> f32 {
    if i % 11 == 3 { -1.0 } else { 1.0 + i as f32 }
}

#[test]
fn the_nearest_bin_agrees_with_the_reference_within_rounding() {
    let pairs = Pairs::new(false);
    for bins in SHAPES {
        let (data, table) = grid(bins, coded);
        for (form, values) in evaluate(&Look(table, Lookup::Nearest), &pairs, 3) {
            let mut certain = 0;
            for query in 0..COUNT - NOWHERE {
                let (wi, wo) = pairs.exact(query);
                let candidates = data.candidates(wi, wo);
                let found = [0, 1, 2].map(|channel| f64::from(values[3 * query + channel]));
                assert!(candidates.contains(&data.eval_nearest(wi, wo)), "{bins:?} {query}");
                assert!(candidates.contains(&found), "{bins:?} {form} {query}: {found:?} {wi:?} {wo:?}");
                certain += usize::from(candidates.len() == 1);
            }
            println!("{bins:?} {form}: {certain} of {COUNT} far from any border");
            assert!(certain > COUNT * 3 / 4, "{bins:?}: only {certain} queries are conclusive");
        }
    }
}

#[test]
fn linear_lookup_agrees_with_the_reference() {
    let pairs = Pairs::new(false);
    for bins in SHAPES {
        let (data, table) = grid(bins, |i| ((i * 37) % 101) as f32 / 101.0);
        for (form, values) in evaluate(&Look(table, Lookup::Linear), &pairs, 3) {
            let mut worst = 0.0_f64;
            for query in 0..COUNT - NOWHERE {
                let (wi, wo) = pairs.exact(query);
                let expected = data.eval_linear(wi, wo);
                let bound = data.bound(wi, wo);
                for channel in 0..3 {
                    let error = (f64::from(values[3 * query + channel]) - expected[channel]).abs();
                    assert!(error <= bound, "{bins:?} {form} {query}: {error:e} > {bound:e}: {wi:?} {wo:?}");
                    worst = worst.max(error / bound);
                }
            }
            println!("{bins:?} {form}: at most {worst:.2} of the bound");
        }
    }
}

#[test]
fn unmeasured_bins_are_left_out() {
    let pairs = Pairs::new(false);
    let (data, table) = grid([9, 7, 10], |i| if (i / 13) % 3 == 0 { 3.0 } else { -1.0 });
    for (form, values) in evaluate(&Look(table, Lookup::Linear), &pairs, 3) {
        let (mut differing, mut dark) = (0, 0);
        for query in 0..COUNT - NOWHERE {
            let (wi, wo) = pairs.exact(query);
            let (found, expected) = (f64::from(values[3 * query]), data.eval_linear(wi, wo)[0]);
            assert!(found == 0.0 || (found - 3.0).abs() < 1e-5, "{form} {query}: {found}");
            differing += usize::from((found - expected).abs() > 1e-5);
            dark += usize::from(found == 0.0);
        }
        assert!(dark > 100 && differing < COUNT / 200, "{form}: {differing} differ, {dark} dark");
    }
}
