//! Surfaces as Mueller matrices over half and difference angles.

use std::f64::consts::{FRAC_PI_2, PI};

use lobe_table::{Channels, Invalid, mueller};
use rayon::prelude::*;

use super::lift;
use crate::Surface;

/// The elements of a matrix.
const ELEMENTS: usize = 16;

/// Knots of `phi_d`, `theta_d` and `theta_h` in radians that suit most materials: every 10 and every 2 degrees, and
/// squares of equal steps, which are dense near the peak.
pub fn knots() -> [Vec<f64>; 3] {
    let even = |steps: u32| (0..=steps).map(move |step| f64::from(step) / f64::from(steps));
    [
        even(36).map(|share| PI * (2.0 * share - 1.0)).collect(),
        even(45).map(|share| FRAC_PI_2 * share).collect(),
        even(45).map(|share| FRAC_PI_2 * share * share).collect(),
    ]
}

/// Measures an isotropic surface at knots of `phi_d`, `theta_d` and `theta_h` in radians. The polarisation of its light
/// is not known; the matrices are those of an ideal depolariser, whose only element other than 0 is the first.
///
/// Directions near the horizon and below it are lifted, see [`lift`]. The knots of `phi_d` are divided among the
/// threads of rayon; `progress` is called after each of them.
///
/// # Errors
/// [`Invalid`] if the channels are not wavelengths, the knots do not ascend, or a value is not finite.
pub fn measure(
    surface: &dyn Surface,
    knots: &[Vec<f64>; 3],
    progress: impl Fn() + Sync,
) -> Result<mueller::Data, Invalid> {
    let Channels::Spectral(wavelengths) = surface.channels() else {
        return Err(Invalid::new("channels", surface.channels().names().join(" "), "wavelengths"));
    };
    let [turns, differences, halves] = knots;
    let planes: Vec<Vec<f32>> = turns
        .par_iter()
        .map(|phi_d| {
            let mut plane = Vec::with_capacity(differences.len() * halves.len() * wavelengths.len() * ELEMENTS);
            let mut values = vec![0.0; wavelengths.len()];
            for theta_d in differences {
                for theta_h in halves {
                    let (wi, wo) = directions([*phi_d, *theta_d, *theta_h]);
                    surface.f(lift(wi), &[lift(wo)], &mut values);
                    for f in &values {
                        plane.push(*f as f32);
                        plane.extend([0.0; ELEMENTS - 1]);
                    }
                }
            }
            progress();
            plane
        })
        .collect();
    let narrow = |knots: &[f64]| knots.iter().map(|knot| *knot as f32).collect::<Vec<f32>>();
    let knots = [narrow(turns), narrow(differences), narrow(halves), narrow(wavelengths)];
    mueller::Data::new(knots, planes.concat())
}

/// The directions to the light and to the viewer of `phi_d`, `theta_d` and `theta_h`, with the half vector at azimuth 0.
pub fn directions([phi_d, theta_d, theta_h]: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let ((sin, cos), (sin_d, cos_d)) = (theta_h.sin_cos(), theta_d.sin_cos());
    let (sin_p, cos_p) = phi_d.sin_cos();
    let place = |x: f64, y: f64| [cos * x + sin * cos_d, y, cos * cos_d - sin * x];
    (place(sin_d * cos_p, sin_d * sin_p), place(-sin_d * cos_p, -sin_d * sin_p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vec3::Vec3;

    #[test]
    fn angles_survive_a_round_trip() {
        for at in [[0.4, 0.3, 0.5], [-2.0, 0.7, 0.2], [1.2, 0.1, 0.9]] {
            let (wi, wo) = directions(at);
            let is_unit = |w: Vec3| (w[0] * w[0] + w[1] * w[1] + w[2] * w[2] - 1.0).abs() < 1e-12;
            assert!(is_unit(wi) && is_unit(wo));
            let [phi_d, theta_d, theta_h] = mueller::coordinates(wi, wo);
            assert!((theta_d - at[1]).abs() < 1e-9 && (theta_h - at[2]).abs() < 1e-9);
            let apart = (phi_d - at[0]).rem_euclid(2.0 * PI);
            assert!(apart.min(2.0 * PI - apart) < 1e-9, "{phi_d}, not {}", at[0]);
        }
    }

    /// A value that depends on all three angles, and on which direction is that of the light.
    struct Ramp(Channels);

    impl Surface for Ramp {
        fn channels(&self) -> &Channels {
            &self.0
        }

        fn f(&self, wi: Vec3, viewers: &[Vec3], out: &mut [f64]) {
            for (out, wo) in out.chunks_exact_mut(2).zip(viewers) {
                let dot = wi[0] * wo[0] + wi[1] * wo[1] + wi[2] * wo[2];
                out.copy_from_slice(&[0.3 + 0.1 * dot + 0.2 * wi[2] - 0.05 * wo[2], wo[2]]);
            }
        }
    }

    #[test]
    fn nodes_hold_the_surface_and_depolarise() {
        let ramp = Ramp(Channels::Spectral(vec![450.0, 650.0]));
        let matrices = measure(&ramp, &knots(), || {}).expect("matrices");
        let knots = matrices.knots();
        for (p, d, h) in [(0, 3, 5), (20, 10, 12), (30, 1, 0)] {
            let (wi, wo) = directions([knots[0][p], knots[1][d], knots[2][h]].map(f64::from));
            let found = matrices.in_plane(wi, wo, 450.0).expect("above the surface");
            let mut expected = [0.0; 2];
            ramp.f(wi, &[wo], &mut expected);
            assert!((found[0][0] - expected[0]).abs() < 1e-5, "{found:?}, not {expected:?}");
            assert!(found.as_flattened()[1..].iter().all(|element| *element == 0.0), "{found:?}");
        }
        assert!(measure(&Ramp(Channels::Rgb), &super::knots(), || {}).is_err());
    }
}
