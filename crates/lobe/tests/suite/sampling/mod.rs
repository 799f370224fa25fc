//! Importance sampling of every kind of material: samples follow their density, and estimates are right.

mod chi_square;
mod estimates;
mod extremes;
mod materials;
mod sheets;

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

fn numbers(seed: u64, count: usize) -> Vec<[f32; 2]> {
    let mut rng = Pcg32::seed_from_u64(seed);
    (0..count).map(|_| [rng.random(), rng.random()]).collect()
}

/// A direction from its polar angle and azimuth in degrees.
fn direction(sigma: f64, psi: f64) -> [f32; 3] {
    let ((sin, cos), (sin_psi, cos_psi)) = (sigma.to_radians().sin_cos(), psi.to_radians().sin_cos());
    [sin * cos_psi, sin * sin_psi, cos].map(|x| x as f32)
}

/// At, near and far from the normal, on knots and between them, for several rotations of the sample.
fn incidents() -> Vec<[f32; 3]> {
    let mut incidents = vec![direction(0.0, 0.0), direction(0.001, 77.0), direction(1.0, 10.0), direction(88.0, 31.0)];
    for (k, sigma) in [30.0, 47.0, 60.0, 80.0, 85.0].into_iter().enumerate() {
        incidents.extend([0.0, 100.0, 215.0].map(|psi| direction(sigma, psi + 13.0 * k as f64)));
    }
    incidents
}

/// The same directions, from below.
fn below(incidents: &[[f32; 3]]) -> Vec<[f32; 3]> {
    incidents.iter().map(|&[x, y, z]| [x, y, -z]).collect()
}

/// A direction drawn in proportion to the cosine, on the side of `z`.
fn cosine([u, w]: [f32; 2], z: f32) -> [f32; 3] {
    let (sin, cos) = (f64::from(w) * TAU).sin_cos();
    let radius = f64::from(u).sqrt();
    [(radius * cos) as f32, (radius * sin) as f32, (1.0 - f64::from(u)).sqrt() as f32 * z.signum()]
}
