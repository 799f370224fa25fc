//! The grid of the UTIA database.

use lobe_backend::Backend;
use lobe_table::Directions;
use lobe_table::utia::{self, Decode, PLANE};

use super::common::{COUNT, Evaluate, NOWHERE, Pairs, evaluate};

impl Evaluate for utia::Table {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

/// Values between 0 and `largest`.
fn material(largest: f64) -> utia::Data {
    utia::Data::new((0..3 * PLANE).map(|i| largest * ((i * 37) % 1009) as f64 / 1008.0).collect())
        .expect("a valid table")
}

#[test]
fn values_agree_with_the_reference() {
    let pairs = Pairs::new(false);
    let data = material(60.0);
    let table = utia::Table::new(&data, Decode::Raw).expect("a valid table");
    for (form, values) in evaluate(&table, &pairs, 3) {
        let mut worst = 0.0_f64;
        for query in 0..COUNT - NOWHERE {
            let (wi, wo) = pairs.exact(query);
            let (expected, bound) = (data.eval(wi, wo, Decode::Raw), 60.0 * data.bound(wi, wo));
            for channel in 0..3 {
                let error = (f64::from(values[3 * query + channel]) - expected[channel]).abs();
                assert!(error <= bound, "{form} {query}: {error:e} > {bound:e}: {wi:?} {wo:?}");
                worst = worst.max(error / bound);
            }
        }
        println!("{form}: at most {worst:.2} of the bound");
    }
}

#[test]
fn decoded_values_agree_with_the_reference() {
    let pairs = Pairs::new(false);
    let data = material(140.0);
    let table = utia::Table::new(&data, Decode::Srgb).expect("a valid table");
    for (form, values) in evaluate(&table, &pairs, 3) {
        let mut worst = 0.0_f64;
        for query in 0..COUNT - NOWHERE {
            let (wi, wo) = pairs.exact(query);
            let expected = data.eval(wi, wo, Decode::Srgb);
            for channel in 0..3 {
                // The curve is steepest at the value itself; it has a step of 1.2e-4 where its two parts meet.
                let steepest = 240.0 / 1.055 * (expected[channel] / 100.0).abs().powf(1.4 / 2.4) + 8.0;
                let bound = steepest * data.bound(wi, wo) + 1e-6 * expected[channel].abs() + 1.3e-4;
                let error = (f64::from(values[3 * query + channel]) - expected[channel]).abs();
                assert!(error <= bound, "{form} {query}: {error:e} > {bound:e}: {expected:?}");
                worst = worst.max(error / bound);
            }
        }
        println!("{form}: at most {worst:.2} of the bound");
    }
}

#[test]
fn values_beyond_f32_are_refused() {
    let mut values = vec![0.0; 3 * PLANE];
    values[7] = 1e300;
    let error = utia::Table::new(&utia::Data::new(values).expect("finite"), Decode::Raw).expect_err("beyond f32");
    assert_eq!(error.part, "values");
}
