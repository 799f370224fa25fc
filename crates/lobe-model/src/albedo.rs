//! The share of the light from one direction that a model reflects.

use std::f64::consts::{PI, TAU};

use crate::Model;

/// Directional-hemispherical reflectance, the integral of `f cos(theta_o)` over the hemisphere of viewers.
///
/// Midpoint rule with `rings` x `4 rings` samples of equal projected solid angle: rings in `sin^2 theta_o`, sectors in
/// azimuth. Narrow lobes need many rings: the error is about the change of `f` from one sample to the next.
pub fn albedo(model: &impl Model, wi: [f64; 3], rings: usize) -> [f64; 3] {
    let sectors = 4 * rings;
    let viewers: Vec<_> = (0..rings * sectors)
        .map(|i| {
            let sin2 = ((i / sectors) as f64 + 0.5) / rings as f64;
            let (s, c) = (TAU * ((i % sectors) as f64 + 0.5) / sectors as f64).sin_cos();
            [sin2.sqrt() * c, sin2.sqrt() * s, (1.0 - sin2).sqrt()]
        })
        .collect();
    let mut sum = [0.0; 3];
    for f in model.f_many(wi, &viewers) {
        for (total, value) in sum.iter_mut().zip(f) {
            *total += value;
        }
    }
    sum.map(|total| total * PI / viewers.len() as f64)
}
