//! Cosine series.

use lobe_backend::Backend;
use lobe_table::fourier::{Data, Parts, Series, Table};
use lobe_table::{Channels, Directions};

use super::common::{COUNT, Evaluate, NOWHERE, Pairs, evaluate};

impl Evaluate for Table {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

/// Series of all lengths up to `longest`, with decreasing coefficients.
fn material(channels: Channels, longest: u32) -> Data {
    let mu = vec![-1.0, -0.95, -0.8, -0.5, -0.1, 0.0, 0.0, 0.15, 0.4, 0.75, 0.97, 1.0];
    let count = channels.count();
    let (mut series, mut coefficients) = (Vec::new(), Vec::new());
    for at in 0..mu.len() * mu.len() {
        let length = (at as u32 * 29) % (longest + 1);
        series.push(Series { start: coefficients.len() as u32, count: length });
        for k in 0..length as usize * count {
            let order = k % length as usize;
            let sign = if (at + k) % 3 == 0 { -0.7 } else { 1.0 };
            coefficients.push(sign * (1.0 + (at % 5) as f32) / (1.0 + order as f32));
        }
    }
    Data::new(Parts { mu, series, coefficients, channels, eta: 1.4 }).expect("valid parts")
}

#[test]
fn values_agree_with_the_reference() {
    let pairs = Pairs::new(true);
    // Shorter and longer than the number of cosines that are computed at once.
    for (channels, longest) in [(Channels::Mono, 60), (Channels::Rgb, 21), (Channels::Rgb, 200)] {
        let width = channels.count();
        let data = material(channels, longest);
        for (form, values) in evaluate(&Table::new(&data), &pairs, width) {
            let (mut worst, mut lit) = (0.0_f64, 0);
            for query in 0..COUNT - NOWHERE {
                let (wi, wo) = pairs.exact(query);
                let (expected, bound) = (data.eval(wi, wo), data.bound(wi, wo));
                for channel in 0..width {
                    let found = f64::from(values[query * width + channel]);
                    let error = (found - expected[channel]).abs();
                    assert!(
                        error <= bound + f64::from(f32::EPSILON) * found.abs(),
                        "{form} {query}: {error:e} > {bound:e}: {wi:?} {wo:?}"
                    );
                    worst = worst.max(if bound > 0.0 { error / bound } else { 0.0 });
                    lit += usize::from(found > 0.0);
                }
            }
            assert!(lit > COUNT / 3, "{lit} values above 0");
            println!("{form}: at most {worst:.2} of the bound");
        }
    }
}
