//! Surfaces on the grid of the UTIA database.

use lobe_table::utia::{PHIS, THETAS};
use lobe_table::{Channels, Invalid, Scatter, utia};
use rayon::prelude::*;

use super::spherical::viewers;
use crate::Surface;

/// The number of directions of the light.
pub const LIGHTS: usize = THETAS * PHIS;
/// Degrees between two polar angles, and between two azimuths.
const STEPS: [f64; 2] = [15.0, 7.5];

/// Measures a surface at every node of the grid, in 1/sr, although the database states no unit.
///
/// Directions of the light are divided among the threads of rayon; `progress` is called after each of them,
/// [`LIGHTS`] times.
///
/// # Errors
/// [`Invalid`] if the channels are not RGB, or a value is not finite.
pub fn measure(surface: &dyn Surface, progress: impl Fn() + Sync) -> Result<utia::Data, Invalid> {
    if *surface.channels() != Channels::Rgb {
        return Err(Invalid::new("channels", surface.channels().names().join(" "), "R G B"));
    }
    let even = |count: usize, step: f64| (0..count).map(|i| (step * i as f64).to_radians()).collect::<Vec<f64>>();
    let (thetas, phis) = (even(THETAS, STEPS[0]), even(PHIS, STEPS[1]));
    let lights: Vec<[f64; 2]> = thetas.iter().flat_map(|theta| phis.iter().map(move |phi| [*theta, *phi])).collect();
    let slices: Vec<Vec<f32>> = lights
        .into_par_iter()
        .map(|light| {
            let slice = viewers(surface, Scatter::Reflection, light, &thetas, &phis, false);
            progress();
            slice
        })
        .collect();
    let channel = |channel: usize| slices.iter().flatten().skip(channel).step_by(3).map(|f| f64::from(*f));
    utia::Data::new((0..3).flat_map(channel).collect())
}

#[cfg(test)]
mod tests {
    use lobe_table::utia::Decode;

    use super::*;
    use crate::vec3::spherical;
    use crate::{Conductor, Ggx, Model, Rgb};

    #[test]
    fn nodes_hold_an_anisotropic_model() {
        let model = Conductor { ggx: Ggx { alpha: [0.3, 0.6] }, eta: [0.143, 0.375, 1.442], k: [3.983, 2.386, 1.603] };
        let grid = measure(&Rgb(&model), || {}).expect("a grid");
        for [theta_i, phi_i, theta_o, phi_o] in
            [[30.0, 15.0, 45.0, 202.5], [0.0, 0.0, 60.0, 90.0], [75.0, 352.5, 75.0, 172.5]]
        {
            let degrees = |theta: f64, phi: f64| [theta.to_radians(), phi.to_radians()];
            let (light, viewer) = (degrees(theta_i, phi_i), degrees(theta_o, phi_o));
            let expected = model.f(spherical(light[0], light[1]), spherical(viewer[0], viewer[1]));
            let found = grid.eval_angles(light, viewer, Decode::Raw);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-5, "{found}, not {expected}, at {theta_i} {phi_i}");
            }
        }
    }
}
