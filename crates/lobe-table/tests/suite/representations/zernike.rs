//! Expansions in Zernike polynomials.

use lobe_backend::Backend;
use lobe_table::zernike::{Data, MAX_ORDER, Table, Term};
use lobe_table::{Channels, Directions};

use super::common::{COUNT, Evaluate, NOWHERE, Pairs, evaluate};

impl Evaluate for Table {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

/// All terms up to an order, with decreasing coefficients.
fn material(channels: Channels, order: u8) -> Data {
    let powers = if channels == Channels::Mono { 1 } else { 2 };
    let mut terms = Vec::new();
    for n in 0..=order {
        for m in (n % 2..=n).step_by(2) {
            for azimuthal in (m % 2..=m).step_by(2) {
                for power in 0..powers {
                    let sign = if (n + 2 * m + azimuthal + power) % 3 == 0 { -1.0 } else { 1.0 };
                    let coefficient = sign / f64::from(1 + n * m + azimuthal);
                    terms.push(Term { radial: [n, m], azimuthal, power, coefficient });
                }
            }
        }
    }
    Data::new(terms, channels).expect("valid terms")
}

#[test]
fn values_agree_with_the_reference() {
    let pairs = Pairs::new(false);
    for (channels, order) in [
        (Channels::Mono, 0),
        (Channels::Mono, 1),
        (Channels::Mono, 6),
        (Channels::Spectral(vec![351.0, 532.0, 1064.0]), 7),
        (Channels::Mono, MAX_ORDER),
    ] {
        let width = channels.count();
        let data = material(channels, order);
        for (form, values) in evaluate(&Table::new(&data), &pairs, width) {
            let (mut worst, mut lit) = (0.0_f64, 0);
            for query in 0..COUNT - NOWHERE {
                let (wi, wo) = pairs.exact(query);
                let (expected, bounds) = (data.eval(wi, wo), data.bound(wi, wo));
                for channel in 0..width {
                    let (found, bound) = (f64::from(values[query * width + channel]), bounds[channel]);
                    let error = (found - expected[channel]).abs();
                    assert!(error <= bound, "{form} {order} {query}: {error:e} > {bound:e}: {wi:?} {wo:?}");
                    worst = worst.max(if bound > 0.0 { error / bound } else { 0.0 });
                    lit += usize::from(found != 0.0);
                }
            }
            assert!(lit > COUNT / 5, "{lit} values");
            println!("{form} {order}: at most {worst:.2} of the bound");
        }
    }
}
