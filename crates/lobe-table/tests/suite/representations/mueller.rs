//! Mueller matrices, for unpolarised light and whole.

use std::f64::consts::PI;

use lobe_backend::Backend;
use lobe_table::{Directions, mueller};

use super::common::{COUNT, Evaluate, NOWHERE, Pairs, evaluate};

impl Evaluate for mueller::Table {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

impl Evaluate for mueller::Matrices {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

/// `phi_d`, `theta_d` and `theta_h`, the first two equally spaced.
fn knots(sizes: [usize; 3], wavelengths: usize) -> [Vec<f32>; 4] {
    let part = |i: usize, n: usize| i as f32 / (n.max(2) - 1) as f32;
    let [p, d, h] = sizes;
    [
        (0..p).map(|i| (2.0 * part(i, p) - 1.0) * PI as f32).collect(),
        (0..d).map(|i| 1.5 * part(i, d)).collect(),
        (0..h).map(|i| 1.4 * part(i, h) * part(i, h)).collect(),
        (0..wavelengths).map(|i| 450.0 + 50.0 * i as f32).collect(),
    ]
}

fn material(sizes: [usize; 3], wavelengths: usize, value: impl Fn(usize) -> f32) -> mueller::Data {
    let count = sizes.iter().product::<usize>() * wavelengths * 16;
    mueller::Data::new(knots(sizes, wavelengths), (0..count).map(value).collect()).expect("matrices")
}

fn reference(data: &mueller::Data, wi: [f64; 3], wo: [f64; 3], channel: usize) -> f64 {
    data.in_plane(wi, wo, f64::from(data.knots()[3][channel])).map_or(0.0, |matrix| matrix[0][0])
}

#[test]
fn values_agree_with_the_reference() {
    let pairs = Pairs::new(false);
    for (sizes, wavelengths) in [([22, 9, 9], 5), ([5, 40, 7], 1), ([3, 2, 1], 8), ([1, 1, 1], 11), ([4, 3, 36], 9)] {
        let data = material(sizes, wavelengths, |i| ((i / 16 * 37) % 101) as f32 / 101.0);
        let table = mueller::Table::new(&data).expect("a small table");
        for (form, values) in evaluate(&table, &pairs, wavelengths) {
            let mut worst = 0.0_f64;
            for query in 0..COUNT - NOWHERE {
                let (wi, wo) = pairs.exact(query);
                let bound = data.bound(wi, wo);
                for channel in 0..wavelengths {
                    let found = f64::from(values[query * wavelengths + channel]);
                    let error = (found - reference(&data, wi, wo, channel)).abs();
                    assert!(error <= bound, "{sizes:?} {form} {query}: {error:e} > {bound:e}: {wi:?} {wo:?}");
                    worst = worst.max(error / bound);
                }
            }
            println!("{sizes:?} {form}: at most {worst:.2} of the bound");
        }
    }
}

#[test]
fn whole_matrices_agree_with_the_reference() {
    let pairs = Pairs::new(false);
    for (sizes, wavelengths) in [([22, 9, 9], 4), ([5, 40, 7], 1), ([1, 1, 1], 3)] {
        // Sixteen arbitrary numbers: the first is an intensity, and the others have signs.
        let value = |i: usize| {
            let part = ((i * 37) % 101) as f32 / 101.0;
            if i.is_multiple_of(16) { part } else { 0.5 - part }
        };
        let data = material(sizes, wavelengths, value);
        let matrices = mueller::Matrices::new(&data).expect("a small table");
        let width = 16 * wavelengths;
        for (form, values) in evaluate(&matrices, &pairs, width) {
            let (mut worst, mut close) = (0.0_f64, 0);
            for query in 0..COUNT - NOWHERE {
                let (wi, wo) = pairs.exact(query);
                // Elements are at most 1 in magnitude, so a rotation by an angle changes them by up to twice the angle
                // for each of two frames.
                let bound = data.bound(wi, wo) + 4.0 * mueller::turned(wi, wo);
                for (channel, found) in values[query * width..][..width].chunks_exact(16).enumerate() {
                    let expected = data.eval(wi, wo, f64::from(data.knots()[3][channel]));
                    for (at, (found, expected)) in found.iter().zip(expected.as_flattened()).enumerate() {
                        let error = (f64::from(*found) - expected).abs();
                        assert!(
                            error <= bound,
                            "{sizes:?} {form} {query}, element {at}: {error:e} > {bound:e}: {wi:?} {wo:?}"
                        );
                        worst = worst.max(error / bound);
                        close += usize::from(error < 2e-5);
                    }
                }
            }
            println!("{sizes:?} {form}: at most {worst:.2} of the bound");
            // Neighbouring matrices are unrelated, so the last digits of an angle matter.
            assert!(close > (COUNT - NOWHERE) * width * 85 / 100, "{sizes:?} {form}: {close} within 2e-5");
        }
    }
}

#[test]
fn an_unmeasured_matrix_is_dark_in_all_elements() {
    let pairs = Pairs::new(false);
    let data = material([6, 5, 4], 3, |i| if i / 48 % 5 == 0 { f32::NAN } else { 0.5 });
    let matrices = mueller::Matrices::new(&data).expect("a small table");
    for (form, values) in evaluate(&matrices, &pairs, 48) {
        let dark = values.chunks_exact(16).filter(|matrix| matrix.iter().all(|element| *element == 0.0)).count();
        assert!(dark > 3 * COUNT / 4 && dark < 3 * COUNT * 9 / 10, "{form}: {dark} dark");
        for matrix in values.chunks_exact(16) {
            assert!(matrix[0] == 0.0 || (matrix[0] - 0.5).abs() < 1e-5, "{form}: {matrix:?}");
            assert!(matrix[0] > 0.0 || matrix.iter().all(|element| *element == 0.0), "{form}: {matrix:?}");
        }
    }
    // A negative intensity becomes 0, and the other elements stay, as in the reference.
    let negative = mueller::Matrices::new(&material([6, 5, 4], 1, |i| if i.is_multiple_of(16) { -1.0 } else { 0.25 }));
    let found = &evaluate(&negative.expect("a small table"), &pairs, 16)[0].1;
    assert!(found[0] == 0.0 && found[15] == 0.25, "{:?}", &found[..16]);
}

#[test]
fn unmeasured_matrices_are_dark() {
    let pairs = Pairs::new(false);
    let data = material([6, 5, 4], 3, |i| if i / 48 % 5 == 0 { f32::NAN } else { 0.5 });
    let table = mueller::Table::new(&data).expect("a small table");
    for (form, values) in evaluate(&table, &pairs, 3) {
        let (mut differing, mut dark) = (0, 0);
        for query in 0..COUNT - NOWHERE {
            let (wi, wo) = pairs.exact(query);
            let found = f64::from(values[3 * query + 1]);
            assert!(found == 0.0 || (found - 0.5).abs() < 1e-5, "{form} {query}: {found}");
            differing += usize::from((found - reference(&data, wi, wo, 1)).abs() > 1e-5);
            dark += usize::from(found == 0.0);
        }
        assert!(dark > COUNT / 4 && dark < COUNT * 9 / 10, "{form}: {dark} dark");
        assert!(differing < COUNT / 200, "{form}: {differing} differ");
    }
    let negative = mueller::Table::new(&material([6, 5, 4], 3, |_| -1.0)).expect("a small table");
    assert!(evaluate(&negative, &pairs, 3)[0].1.iter().all(|value| *value == 0.0));
}
