//! Resampling of Mueller matrices from one grid to another.

use std::f64::consts::{FRAC_PI_2, PI};

use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{Edges, GridError, Invalid, mueller, polarised};

/// Resamples matrices over half and difference angles at knots of sigma, psi, theta and phi, in radians. Unmeasured
/// ones, and those below the surface, are 0.
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

/// Resamples isotropic matrices in specular coordinates on a grid of half and difference angles with equal steps: phi_d
/// over a full turn, theta_d and theta_h over a quarter turn. Pairs below the surface are marked as not measured.
///
/// # Errors
/// If there are no steps.
pub fn to_half_difference(data: &polarised::Data, steps: [u16; 3]) -> Result<mueller::Data, Invalid> {
    let even = |steps: u16, low: f64, high: f64| -> Vec<f32> {
        (0..=steps).map(|k| (low + (high - low) * f64::from(k) / f64::from(steps.max(1))) as f32).collect()
    };
    let wavelengths: Vec<f32> = data.wavelengths().iter().map(|nm| *nm as f32).collect();
    let knots = [even(steps[0], -PI, PI), even(steps[1], 0.0, FRAC_PI_2), even(steps[2], 0.0, FRAC_PI_2), wavelengths];
    let mut values = Vec::new();
    for phi_d in &knots[0] {
        for theta_d in &knots[1] {
            for theta_h in &knots[2] {
                let (wi, wo) = directions([*phi_d, *theta_d, *theta_h].map(f64::from));
                for nm in &knots[3] {
                    match data.in_plane(&Edges::default(), wi, wo, f64::from(*nm)) {
                        Some(matrix) => values.extend(matrix.as_flattened().iter().map(|element| *element as f32)),
                        None => values.extend([f32::NAN; 16]),
                    }
                }
            }
        }
    }
    mueller::Data::new(knots, values)
}

/// The directions to the light and to the viewer of half and difference angles, with the half vector at azimuth 0.
fn directions([phi_d, theta_d, theta_h]: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let ((sin, cos), (sin_d, cos_d)) = (theta_h.sin_cos(), theta_d.sin_cos());
    let (sin_p, cos_p) = phi_d.sin_cos();
    let place = |x: f64, y: f64| [cos * x + sin * cos_d, y, cos * cos_d - sin * x];
    (place(sin_d * cos_p, sin_d * sin_p), place(-sin_d * cos_p, -sin_d * sin_p))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_survive_a_round_trip() {
        for at in [[0.4, 0.3, 0.5], [-2.0, 0.7, 0.2], [1.2, 0.1, 0.9]] {
            let (wi, wo) = directions(at);
            let turned = |w: [f64; 3]| (w[0] * w[0] + w[1] * w[1] + w[2] * w[2] - 1.0).abs() < 1e-12;
            assert!(turned(wi) && turned(wo));
            let [_, theta_d, theta_h] = mueller::coordinates(wi, wo);
            assert!((theta_d - at[1]).abs() < 1e-9 && (theta_h - at[2]).abs() < 1e-9);
            let found = mueller::coordinates(wi, wo)[0];
            let apart = (found - at[0]).rem_euclid(2.0 * PI);
            assert!(apart.min(2.0 * PI - apart) < 1e-9, "{found}, not {}", at[0]);
        }
    }

    #[test]
    fn matrices_survive_both_ways() {
        let mirrors = |theta_d: f64, element: usize| ((element as f64 * 0.7 + theta_d).sin() * 0.2 + 0.5) as f32;
        let knots = |n: usize| (0..n).map(|k| (FRAC_PI_2 * k as f64 / (n - 1) as f64) as f32).collect::<Vec<f32>>();
        let turn: Vec<f32> = (0..9).map(|k| (-PI + 2.0 * PI * f64::from(k) / 8.0) as f32).collect();
        let axes = [turn, knots(10), knots(5), vec![450.0, 650.0]];
        let mut values = Vec::new();
        for _ in &axes[0] {
            for theta_d in &axes[1] {
                for _ in 0..axes[2].len() * 2 {
                    values.extend((0..16).map(|element| mirrors(f64::from(*theta_d), element)));
                }
            }
        }
        let data = mueller::Data::new(axes, values).expect("matrices");
        let even = |n: usize, most: f64| (0..n).map(|k| most * k as f64 / (n - 1) as f64).collect::<Vec<f64>>();
        let specular =
            to_specular(&data, [even(17, 1.5), vec![0.0], even(40, PI), even(25, 2.0 * PI)]).expect("a grid");
        let back = to_half_difference(&specular, [24, 18, 18]).expect("a grid");
        let (wi, wo) = ([0.48, 0.36, 0.8], [-0.36, 0.1, 0.92763]);
        let length = wo.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
        let wo = wo.map(|x| x / length);
        let [first, second] = [&data, &back].map(|data| data.in_plane(wi, wo, 550.0).expect("measured"));
        for (a, b) in first.as_flattened().iter().zip(second.as_flattened()) {
            assert!((a - b).abs() < 5e-3, "{first:?} {second:?}");
        }
    }
}
