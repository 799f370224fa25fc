//! Measures surfaces on grids of spherical coordinates.

use std::f64::consts::PI;

use lobe_table::{GridError, Scatter, spherical};
use rayon::prelude::*;

use super::{at_pole, closes_circle, lift};
use crate::Surface;
use crate::vec3::spherical as direction;

/// Measures a surface at every node of `knots`: `theta_i`, `phi_i`, `theta_o` and `phi_o` in radians, as in
/// [`spherical::Data`]. With `is_half` the grid is one half of an isotropic material, and its last axis is the angle
/// between the azimuths, from 0 to half a turn.
///
/// Directions near the horizon are lifted, see [`lift`]. The incident directions are distributed over the threads of
/// rayon. `progress` is called after each of them, so as many times as there are `theta_i` knots times `phi_i` knots.
///
/// # Errors
/// [`GridError`] if the knots do not form a grid.
pub fn measure(
    surface: &dyn Surface,
    scatter: Scatter,
    knots: [Vec<f64>; 4],
    is_half: bool,
    progress: impl Fn() + Sync,
) -> Result<spherical::Data, GridError> {
    let [theta_i, phi_i, theta_o, phi_o] = &knots;
    let lights: Vec<[f64; 2]> = theta_i.iter().flat_map(|theta| phi_i.iter().map(move |phi| [*theta, *phi])).collect();
    let measured: Vec<Vec<f32>> = lights
        .par_iter()
        .map(|&[theta, phi]| {
            let phi = if closes_circle(phi, phi_i) { phi_i[0] } else { phi };
            let slice = viewers(surface, scatter, [theta, phi], theta_o, phi_o, is_half);
            progress();
            slice
        })
        .collect();
    let grid = spherical::Data::new(scatter, knots, surface.channels().clone(), measured.concat())?;
    if is_half { grid.mirrored() } else { Ok(grid) }
}

/// The values for all viewers of one light, `[theta_o][phi_o][channel]`.
pub(super) fn viewers(
    surface: &dyn Surface,
    scatter: Scatter,
    [theta, phi]: [f64; 2],
    theta_o: &[f64],
    phi_o: &[f64],
    is_half: bool,
) -> Vec<f32> {
    let mut seen = Vec::new();
    let mut viewer_of_node = Vec::new();
    for &polar in theta_o {
        let first = seen.len();
        for (index, &azimuth) in phi_o.iter().enumerate() {
            let is_known = index > 0 && (at_pole(polar) || closes_circle(azimuth, phi_o));
            if !is_known {
                let [x, y, z] = lift(direction(polar, if is_half { phi + azimuth } else { azimuth }));
                seen.push([x, y, if scatter == Scatter::Reflection { z } else { -z }]);
            }
            viewer_of_node.push(if is_known { first } else { seen.len() - 1 });
        }
    }
    let channels = surface.channels().count();
    let mut values = vec![0.0; seen.len() * channels];
    surface.f(lift(direction(theta, phi)), &seen, &mut values);
    let texel = |viewer: usize| values[viewer * channels..][..channels].iter().map(|&f| f as f32);
    viewer_of_node.into_iter().flat_map(texel).collect()
}

/// The knots of half a grid in the MDL format: `zeniths` polar angles of both directions, without the horizon, and
/// `azimuths` azimuths from 0 to half a turn, including both ends, all in equal steps.
pub fn uniform_half(zeniths: usize, azimuths: usize) -> [Vec<f64>; 4] {
    let thetas: Vec<f64> = (0..zeniths).map(|i| 0.5 * PI * (i as f64) / zeniths as f64).collect();
    let steps = azimuths.max(2) - 1;
    [thetas.clone(), vec![0.0], thetas, (0..azimuths).map(|i| PI * (i as f64) / steps as f64).collect()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Phong, Rgb};

    #[test]
    fn nodes_hold_the_surface() {
        let model = Rgb(Phong { specular: [1.0, 0.5, 0.2], exponent: 20.0 });
        let degrees = |list: &[f64]| list.iter().map(|angle| angle.to_radians()).collect::<Vec<f64>>();
        let knots =
            [degrees(&[0.0, 30.0]), vec![0.0], degrees(&[0.0, 30.0, 50.0]), degrees(&[0.0, 90.0, 180.0, 270.0, 360.0])];
        let grid = measure(&model, Scatter::Reflection, knots.clone(), false, || {}).expect("a grid");
        let half = [knots[0].clone(), vec![0.0], knots[2].clone(), degrees(&[0.0, 90.0, 180.0])];
        let half = measure(&model, Scatter::Reflection, half, true, || {}).expect("half a grid");
        for theta in [0.0_f64, 30.0, 50.0] {
            for phi in [0.0_f64, 90.0, 180.0] {
                let wi = direction(30_f64.to_radians(), 0.0);
                let wo = direction(theta.to_radians(), phi.to_radians());
                let mut expected = [0.0; 3];
                model.f(wi, &[wo], &mut expected);
                for found in [grid.eval(wi, wo), half.eval(wi, wo)] {
                    assert!(
                        (found[1] - expected[1]).abs() < 1e-6,
                        "{found:?} instead of {expected:?} at {theta} {phi}"
                    );
                }
            }
        }
    }

    #[test]
    fn light_may_pass_through() {
        struct Through;
        impl Surface for Through {
            fn channels(&self) -> &lobe_table::Channels {
                &lobe_table::Channels::Mono
            }
            fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]) {
                out.iter_mut().zip(viewers).for_each(|(out, wo)| *out = if wi[2] * wo[2] < 0.0 { 0.3 } else { 0.0 });
            }
        }
        let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 1.0], vec![0.0, 2.0, 4.0]];
        let grid = measure(&Through, Scatter::Transmission, knots, false, || {}).expect("a grid");
        assert!(grid.values().iter().all(|f| (*f - 0.3).abs() < 1e-6));
    }
}
