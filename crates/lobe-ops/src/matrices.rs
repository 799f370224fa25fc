//! Resampling of Mueller matrices from one grid to another.

use lobe_model::goniometer::lift;
use lobe_model::goniometer::mueller::directions;
use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{Channels, Edges, GridError, Invalid, mueller, polarised, specular};

/// The elements of a matrix.
const ELEMENTS: usize = 16;

/// Resamples matrices over half and difference angles at knots of sigma, psi, theta and phi, in radians. Unmeasured
/// ones are 0. Directions near the horizon and below it are lifted, see [`lift`].
///
/// # Errors
/// If the knots do not form a grid.
pub fn to_specular(data: &mueller::Data, knots: [Vec<f64>; 4]) -> Result<polarised::Data, GridError> {
    let wavelengths: Vec<f64> = data.knots()[3].iter().map(|nm| f64::from(*nm)).collect();
    let mut values = Vec::new();
    for sigma in &knots[0] {
        for psi in &knots[1] {
            for theta in &knots[2] {
                for phi in &knots[3] {
                    let (wi, wo) = angles_to_directions([*sigma, *psi, *theta, *phi], |sigma| sigma);
                    let (wi, wo) = (lift(wi), lift(wo));
                    for nm in &wavelengths {
                        let matrix = data.in_plane(wi, wo, *nm).unwrap_or_default();
                        values.extend(matrix.as_flattened().iter().map(|element| *element as f32));
                    }
                }
            }
        }
    }
    polarised::Data::new(knots, wavelengths, values)
}

/// Resamples isotropic matrices in specular coordinates at knots of `phi_d`, `theta_d` and `theta_h`, in radians.
/// Directions near the horizon and below it are lifted, see [`lift`].
///
/// # Errors
/// If the knots do not form a grid.
pub fn to_half_difference(data: &polarised::Data, knots: &[Vec<f64>; 3]) -> Result<mueller::Data, Invalid> {
    let narrow = |knots: &[f64]| knots.iter().map(|knot| *knot as f32).collect::<Vec<f32>>();
    let [turns, differences, halves] = knots;
    let mut values = Vec::new();
    for phi_d in turns {
        for theta_d in differences {
            for theta_h in halves {
                let (wi, wo) = directions([*phi_d, *theta_d, *theta_h]);
                let (wi, wo) = (lift(wi), lift(wo));
                for nm in data.wavelengths() {
                    match data.in_plane(&Edges::default(), wi, wo, *nm) {
                        Some(matrix) => values.extend(matrix.as_flattened().iter().map(|element| *element as f32)),
                        None => values.extend([f32::NAN; ELEMENTS]),
                    }
                }
            }
        }
    }
    mueller::Data::new([narrow(turns), narrow(differences), narrow(halves), narrow(data.wavelengths())], values)
}

/// Matrices of an ideal depolariser, whose only element other than 0 is the first, with the values of a table of
/// wavelengths.
///
/// # Errors
/// If the channels are not wavelengths.
pub fn depolarising(table: &specular::Data) -> Result<polarised::Data, GridError> {
    let Channels::Spectral(wavelengths) = table.channels() else {
        let found = table.channels().names().join(" ");
        return Err(GridError::Channels(format!("found {found}; expected wavelengths")));
    };
    let mut values = Vec::with_capacity(table.values().len() * ELEMENTS);
    for f in table.values() {
        values.push(*f);
        values.extend([0.0; ELEMENTS - 1]);
    }
    polarised::Data::new(table.knots().clone(), wavelengths.clone(), values)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn matrices_survive_both_ways() {
        let mirrors = |theta_d: f64, element: usize| ((element as f64 * 0.7 + theta_d).sin() * 0.2 + 0.5) as f32;
        let knots = |n: usize| (0..n).map(|k| (FRAC_PI_2 * k as f64 / (n - 1) as f64) as f32).collect::<Vec<f32>>();
        let turn: Vec<f32> = (0..9).map(|k| (-PI + 2.0 * PI * f64::from(k) / 8.0) as f32).collect();
        let axes = [turn, knots(10), knots(5), vec![450.0, 650.0]];
        let mut values = Vec::new();
        for phi_d in &axes[0] {
            for theta_d in &axes[1] {
                for _ in 0..axes[2].len() * 2 {
                    // Other values if light and viewer are exchanged, which adds half a turn to phi_d.
                    let turned = 0.1 * phi_d.cos();
                    values.extend((0..16).map(|element| mirrors(f64::from(*theta_d), element) + turned));
                }
            }
        }
        let data = mueller::Data::new(axes, values).expect("matrices");
        let even = |n: usize, most: f64| (0..n).map(|k| most * k as f64 / (n - 1) as f64).collect::<Vec<f64>>();
        let specular =
            to_specular(&data, [even(17, 1.5), vec![0.0], even(40, PI), even(25, 2.0 * PI)]).expect("a grid");
        let turns = (0..=24).map(|k| PI * (f64::from(k) / 12.0 - 1.0)).collect();
        let halves = [turns, even(19, FRAC_PI_2), even(19, FRAC_PI_2)];
        let back = to_half_difference(&specular, &halves).expect("a grid");
        let (wi, wo) = ([0.48, 0.36, 0.8], [-0.36, 0.1, 0.92763]);
        let length = wo.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
        let wo = wo.map(|x| x / length);
        let [first, second] = [&data, &back].map(|data| data.in_plane(wi, wo, 550.0).expect("measured"));
        for (a, b) in first.as_flattened().iter().zip(second.as_flattened()) {
            assert!((a - b).abs() < 5e-3, "{first:?} {second:?}");
        }
    }

    #[test]
    fn a_depolariser_has_the_values_and_nothing_else() {
        let even = |n: usize, most: f64| (0..n).map(|k| most * k as f64 / (n - 1) as f64).collect::<Vec<f64>>();
        let knots = [even(3, 1.2), vec![0.0], even(4, PI), even(5, 2.0 * PI)];
        let values: Vec<f32> = (0..3 * 4 * 5 * 2).map(|index| 0.1 + index as f32).collect();
        let channels = Channels::Spectral(vec![450.0, 650.0]);
        let scatter = lobe_table::Scatter::Reflection;
        let table = specular::Data::new(scatter, knots, channels, values.clone()).expect("a table");
        let matrices = depolarising(&table).expect("matrices");
        assert!(matrices.values().iter().step_by(ELEMENTS).eq(&values));
        assert_eq!(matrices.values().iter().filter(|element| **element != 0.0).count(), values.len());
        let grey = specular::Data::new(scatter, table.knots().clone(), Channels::Rgb, vec![0.5; 3 * 4 * 5 * 3]);
        let refused = depolarising(&grey.expect("a table")).expect_err("no wavelengths");
        assert!(matches!(&refused, GridError::Channels(found) if found.contains("expected wavelengths")), "{refused}");
    }
}
