//! Mueller matrices in specular coordinates.

use std::f64::consts::{PI, TAU};

use lobe_backend::Backend;
use lobe_table::{Directions, Edges, Options, Representation, mueller, polarised};

use super::common::{COUNT, Evaluate, NOWHERE, Pairs, evaluate};

impl Evaluate for polarised::Matrices {
    fn run(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.eval_batch(backend, wi, wo, out);
    }
}

/// Matrices that change slowly, like those of measurements.
fn data(psis: usize, wavelengths: usize) -> polarised::Data {
    let even = |n: usize, most: f64| (0..n).map(|i| most * i as f64 / (n.max(2) - 1) as f64).collect::<Vec<f64>>();
    let knots = [even(9, 1.5), even(psis, TAU), even(14, PI), even(13, TAU)];
    let nm: Vec<f64> = (0..wavelengths).map(|i| 450.0 + 50.0 * i as f64).collect();
    let mut values = Vec::new();
    for sigma in &knots[0] {
        for psi in &knots[1] {
            for theta in &knots[2] {
                for phi in &knots[3] {
                    for nm in &nm {
                        for element in 0..16 {
                            let wave =
                                (f64::from(element) + sigma + 2.0 * psi.sin() + theta + phi.cos() + nm / 300.0).sin();
                            values.push(if element == 0 { 0.6 + 0.4 * wave } else { 0.5 * wave } as f32);
                        }
                    }
                }
            }
        }
    }
    polarised::Data::new(knots, nm, values).expect("matrices")
}

#[test]
fn whole_matrices_agree_with_the_reference() {
    let (pairs, edges) = (Pairs::new(false), Edges::default());
    for (psis, wavelengths) in [(1, 4), (5, 3)] {
        let data = data(psis, wavelengths);
        let matrices = polarised::Matrices::new(&data, &edges).expect("a small table");
        let width = 16 * wavelengths;
        for (form, values) in evaluate(&matrices, &pairs, width) {
            let mut far = 0;
            for query in 0..COUNT - NOWHERE {
                // As for every specular table, directions have to be unit vectors.
                let is_unit = |w: [f32; 3]| (w.iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-5;
                if !is_unit(pairs.wi[query]) || !is_unit(pairs.wo[query]) {
                    continue;
                }
                let (wi, wo) = pairs.exact(query);
                // Slopes are at most 2 per radian.
                let allowed = 2e-5 + 4.0 * mueller::turned(wi, wo);
                for (channel, found) in values[query * width..][..width].chunks_exact(16).enumerate() {
                    let expected = data.eval(&edges, wi, wo, data.wavelengths()[channel]);
                    let worst = found
                        .iter()
                        .zip(expected.as_flattened())
                        .map(|(found, expected)| (f64::from(*found) - expected).abs())
                        .fold(0.0, f64::max);
                    far += usize::from(worst > allowed);
                }
            }
            // Near the normal and the mirror direction, psi and phi are known to only a few digits.
            assert!(far <= COUNT / 200, "{psis} psi, {form}: {far} far from the reference");
        }
    }
}

#[test]
fn unpolarised_values_are_the_first_elements() {
    let data = data(1, 3);
    let bsdf = data.prepare(&Options::default()).expect("a small table");
    assert!(bsdf.is_polarised() && bsdf.is_isotropic() && bsdf.channels().count() == 3);
    let (wi, wo) = ([[0.48f32, 0.36, 0.8]; 5], [[-0.6f32, 0.0, 0.8]; 5]);
    let (mut values, mut matrices) = ([0.0; 15], [0.0; 240]);
    bsdf.eval_batch(Backend::best(), (&wi).into(), (&wo).into(), &mut values);
    assert!(bsdf.mueller_batch(Backend::best(), (&wi).into(), (&wo).into(), &mut matrices));
    for (value, matrix) in values.iter().zip(matrices.chunks_exact(16)) {
        assert!((value - matrix[0]).abs() < 1e-6 && *value > 0.0, "{value}, {matrix:?}");
    }
    let one = bsdf.mueller(wi[0], wo[0], 475.0).expect("a matrix");
    let expected = 0.5 * (f64::from(values[0]) + f64::from(values[1]));
    assert!((one[0][0] - expected).abs() < 1e-6, "between two wavelengths");
}
