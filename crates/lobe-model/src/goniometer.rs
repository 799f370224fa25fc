//! Virtual goniophotometers: the values of a surface at the nodes of a table.
//!
//! [`measure`] fills a table in specular coordinates; the modules fill the other representations.

pub mod half_diff;
pub mod klems;
pub mod mueller;
pub mod rgl;
pub mod spherical;
pub mod tensor_tree;
pub mod utia;

use std::f64::consts::TAU;

use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{GridError, Scatter, specular};
use rayon::prelude::*;

use crate::{Model, Rgb, Surface};

/// Measures `model` at every node of `knots` (sigma, psi, theta, phi in radians, as in [`specular::Data`]).
///
/// - Nodes at `theta` 0 and `pi` are one direction for all `phi`, and the last `phi` or `psi` knot of a full circle
///   equals the first: they are measured once and get equal values.
/// - Nodes below the surface cannot be measured, but a table needs values there to interpolate toward the horizon. They
///   get the value at the same azimuth just above it: see [`lift`]. The light is lifted in the same way, so `sigma` may
///   be 90 degrees.
///
/// Directions of the light are divided among the threads of rayon; the values do not depend on their number. `progress`
/// is called after each direction of the light, of which there are as many as sigma knots times psi knots.
///
/// # Errors
/// [`GridError`] if the knots do not form a table.
pub fn measure(
    model: &(impl Model + Sync),
    knots: [Vec<f64>; 4],
    progress: impl Fn() + Sync,
) -> Result<specular::Data, GridError> {
    measure_surface(&Rgb(model), Scatter::Reflection, knots, progress)
}

/// Like [`measure`], for any surface, and on either side of it: for transmission, viewers are below.
///
/// # Errors
/// The same as for [`measure`].
pub fn measure_surface(
    surface: &dyn Surface,
    scatter: Scatter,
    knots: [Vec<f64>; 4],
    progress: impl Fn() + Sync,
) -> Result<specular::Data, GridError> {
    let [sigmas, psis, thetas, phis] = &knots;
    let lights: Vec<(f64, f64)> = sigmas.iter().flat_map(|&sigma| psis.iter().map(move |&psi| (sigma, psi))).collect();
    let measured: Vec<Vec<f32>> = lights
        .par_iter()
        .map(|&(sigma, psi)| {
            // The last position of a full turn would only repeat the first.
            let psi = if closes_circle(psi, psis) { psis[0] } else { psi };
            let slice = measure_light(surface, scatter, [sigma, psi], thetas, phis);
            progress();
            slice
        })
        .collect();
    specular::Data::new(scatter, knots, surface.channels().clone(), measured.concat())
}

/// All viewers of one light, `[theta][phi][channel]`.
fn measure_light(
    surface: &dyn Surface,
    scatter: Scatter,
    [sigma, psi]: [f64; 2],
    thetas: &[f64],
    phis: &[f64],
) -> Vec<f32> {
    let mut viewers = Vec::new();
    let mut viewer_of_node = Vec::new();
    let (wi, _) = angles_to_directions([sigma, psi, 0.0, 0.0], |sigma| sigma);
    for &theta in thetas {
        let first = viewers.len();
        for (i, &phi) in phis.iter().enumerate() {
            let known = i > 0 && (at_pole(theta) || closes_circle(phi, phis));
            if !known {
                let [x, y, z] = lift(angles_to_directions([sigma, psi, theta, phi], |sigma| sigma).1);
                viewers.push([x, y, if scatter == Scatter::Reflection { z } else { -z }]);
            }
            viewer_of_node.push(if known { first } else { viewers.len() - 1 });
        }
    }
    let channels = surface.channels().count();
    let mut values = vec![0.0; viewers.len() * channels];
    surface.f(lift(wi), &viewers, &mut values);
    let texel = |viewer: usize| values[viewer * channels..][..channels].iter().map(|&f| f as f32);
    viewer_of_node.into_iter().flat_map(texel).collect()
}

/// Knots that were degrees in a file are within this of the pole or the full turn.
const ANGLE_ROUNDING: f64 = 1e-6;

fn at_pole(theta: f64) -> bool {
    theta.sin() < ANGLE_ROUNDING
}

fn closes_circle(angle: f64, knots: &[f64]) -> bool {
    angle - knots[0] > TAU - ANGLE_ROUNDING
}

/// The height of the lowest direction that is measured: 1.1 degrees above the horizon.
const LOWEST: f64 = 0.02;
/// Directions higher than this, 3.4 degrees, are measured unchanged.
const UNTOUCHED: f64 = 0.06;

/// A direction that can be measured, close to `w`: `w` itself if its z is above 0.06, or else the same azimuth at a
/// height that falls smoothly to 0.02. Height and its derivative are continuous.
pub fn lift(w: [f64; 3]) -> [f64; 3] {
    if w[2] >= UNTOUCHED {
        return w;
    }
    let room = UNTOUCHED - LOWEST;
    let z = LOWEST + room * ((w[2] - UNTOUCHED) / room).exp();
    let across = w[0].hypot(w[1]);
    // Straight down, the azimuth comes only from rounding errors, and any azimuth is acceptable.
    let (x, y) = if across > 1e-9 { (w[0] / across, w[1] / across) } else { (1.0, 0.0) };
    let radius = (1.0 - z * z).sqrt();
    [x * radius, y * radius, z]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::cloth::{Cloth, Ply, Weave, Yarn};
    use crate::vec3::{Vec3, dot, reflect};
    use crate::{Lambert, Phong};

    fn degrees(knots: &[f64]) -> Vec<f64> {
        knots.iter().map(|k| k.to_radians()).collect()
    }

    fn close(a: Vec3, b: Vec3) -> bool {
        a.into_iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-4)
    }

    #[test]
    fn geometry_of_known_directions() {
        let at = |theta: f64, phi: f64| {
            angles_to_directions([30f64.to_radians(), 0.0, theta.to_radians(), phi.to_radians()], |sigma| sigma).1
        };
        assert!(close(at(20.0, 0.0), [-0.1736, 0.0, 0.9848]));
        assert!(close(at(20.0, 90.0), [-0.4698, 0.3420, 0.8138]));
        assert!(close(at(20.0, 180.0), [-0.7660, 0.0, 0.6428]));
        assert!(close(at(20.0, 270.0), [-0.4698, -0.3420, 0.8138]));
        assert!(close(at(60.0, 0.0), [0.5, 0.0, 0.8660]));
    }

    #[test]
    fn zenith_is_the_mirror_and_psi_turns_both() {
        for (sigma, psi, theta, phi) in [(0.3, 1.0, 0.7, 2.0), (1.2, 4.0, 1.5, 5.0), (0.0, 2.0, 0.4, 1.0)] {
            let (wi, zenith) = angles_to_directions([sigma, psi, 0.0, phi], |sigma| sigma);
            assert!(close(zenith, reflect(wi, [0.0, 0.0, 1.0])));
            let (_, wo) = angles_to_directions([sigma, psi, theta, phi], |sigma| sigma);
            assert!((dot(wo, zenith) - theta.cos()).abs() < 1e-12);
            let (_, unturned) = angles_to_directions([sigma, 0.0, theta, phi], |sigma| sigma);
            let (s, c) = psi.sin_cos();
            let turned = [c * unturned[0] - s * unturned[1], s * unturned[0] + c * unturned[1], unturned[2]];
            assert!((dot(wo, turned) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn lift_changes_only_directions_that_cannot_be_measured() {
        let w = angles_to_directions([1.0, 0.3, 0.2, 0.4], |sigma| sigma).1;
        assert_eq!(lift(w), w);
        let at = |z: f64| lift([(1.0 - z * z).sqrt(), 0.0, z])[2];
        for z in [-1.0, -0.5, -0.01, 0.0, 0.03, 0.0599] {
            assert!(at(z) >= LOWEST && at(z) <= at(z + 1e-4), "not monotonic at {z}");
        }
        let (below, above) = (at(UNTOUCHED - 1e-6), at(UNTOUCHED + 1e-6));
        assert!((above - below - 2e-6).abs() < 1e-9, "kink of {}", above - below);
    }

    #[test]
    fn nodes_hold_the_model() {
        let model = Phong { specular: [1.0, 0.5, 0.2], exponent: 20.0 };
        let knots =
            [&[0.0, 30.0, 60.0][..], &[0.0], &[0.0, 10.0, 40.0, 180.0], &[0.0, 90.0, 200.0, 360.0]].map(degrees);
        let samples = measure(&model, knots, || {}).expect("a table");
        // At the peak of the lobe: specular (n + 2) / (2 pi).
        for sigma in 0..3 {
            for phi in 0..4 {
                assert!((samples.texel([sigma, 0, 0, phi])[1] - 0.5 * 22.0 / TAU as f32).abs() < 1e-5);
            }
        }
        let expected = 0.5 * 22.0 / TAU * 10f64.to_radians().cos().powi(20);
        assert!((f64::from(samples.texel([1, 0, 1, 2])[1]) - expected).abs() < 1e-5);
        assert_eq!(samples.texel([1, 0, 2, 0]), samples.texel([1, 0, 2, 3]));
    }

    #[test]
    fn nodes_below_the_horizon_continue_those_above() {
        let knots = [&[0.0, 90.0][..], &[0.0], &[0.0, 45.0, 180.0], &[0.0, 180.0, 360.0]].map(degrees);
        let samples = measure(&Lambert { albedo: [0.5; 3] }, knots, || {}).expect("a table");
        assert!(samples.values().iter().all(|&f| (f64::from(f) - 0.5 / PI).abs() < 1e-7));
    }

    #[test]
    fn cloth_is_the_same_on_any_number_of_threads() {
        let weave = Weave { over: 1, under: 1, crimp: 0.2, roundness: 0.3, plies: [Ply::SMOOTH; 2] };
        let yarn = Yarn { body: [0.5; 3], shine: [0.8; 3], share: 0.3, roughness: [0.2, 0.5] };
        let cloth = Cloth::new(&weave, [yarn; 2], 8, 50, 11);
        let knots =
            [&[0.0, 40.0, 80.0][..], &[0.0, 90.0, 360.0], &[0.0, 30.0, 120.0], &[0.0, 120.0, 360.0]].map(degrees);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
            pool.install(|| measure(&cloth, knots.clone(), || {})).expect("a table")
        };
        assert_eq!(on(1), on(3));
    }

    /// A surface that turns the smallest difference into a large one.
    struct Chaos;

    impl Model for Chaos {
        fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
            [0, 1, 2].map(|c| (1e17 * (wi[0] + 2.0 * wi[1] + wo[c])).sin())
        }
    }

    #[test]
    fn one_direction_has_one_value() {
        let mut knots =
            [&[0.0, 40.0, 80.0][..], &[0.0, 90.0, 360.0], &[0.0, 30.0, 180.0], &[0.0, 120.0, 360.0]].map(degrees);
        // A pole that was rounded in its file.
        knots[2][0] = 1e-7;
        let samples = measure(&Chaos, knots, || {}).expect("a table");
        for (theta, phi) in [(0, 0), (1, 0), (1, 1), (2, 2)] {
            assert_eq!(samples.texel([1, 0, theta, phi]), samples.texel([1, 2, theta, phi]), "psi 0 and 360");
        }
        for theta in [0, 2] {
            assert_eq!(samples.texel([1, 1, theta, 0]), samples.texel([1, 1, theta, 1]), "a pole");
        }
        assert_eq!(samples.texel([1, 1, 1, 0]), samples.texel([1, 1, 1, 2]), "phi 0 and 360");
        assert_ne!(samples.texel([1, 1, 1, 0]), samples.texel([1, 1, 1, 1]));
    }
}
