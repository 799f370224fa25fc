//! Grids in spherical coordinates whose values are relative to a total that their file states.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

use lobe_table::spherical;

use crate::{FormatError, Place};

/// Scales each slice of a grid so that its integral of `f cos` over the hemisphere equals its total in
/// `[theta_i][phi_i][channel]`.
pub(crate) fn scale(file: &Path, grid: &spherical::Data, totals: &[f32]) -> Result<spherical::Data, FormatError> {
    let channels = grid.channels().count();
    let [_, _, thetas, phis] = grid.knots();
    let (by_theta, by_phi) = (polar(thetas), azimuthal(phis, grid.is_mirrored()));
    let mut values = grid.values().to_vec();
    for (slice, totals) in
        values.chunks_exact_mut(by_theta.len() * by_phi.len() * channels).zip(totals.chunks_exact(channels))
    {
        for (channel, total) in totals.iter().enumerate() {
            let of_channel = slice.iter().skip(channel).step_by(channels);
            let weights = by_theta.iter().flat_map(|theta| by_phi.iter().map(move |phi| theta * phi));
            let integral: f64 = of_channel.zip(weights).map(|(value, weight)| f64::from(*value) * weight).sum();
            let factor = f64::from(*total) / integral;
            let is_black = slice.iter().skip(channel).step_by(channels).all(|value| *value == 0.0);
            if is_black && *total == 0.0 {
                continue;
            }
            if !factor.is_finite() || factor < 0.0 {
                let found = format!("values with an integral of {integral}");
                let expected = format!("some that can be scaled to the stated total integrated scatter {total}");
                return Err(FormatError::new(file, Place::File, found, expected));
            }
            for value in slice.iter_mut().skip(channel).step_by(channels) {
                *value = (f64::from(*value) * factor) as f32;
            }
        }
    }
    let invalid = |error: lobe_table::GridError| FormatError::new(file, Place::File, error.to_string(), "a grid");
    let scaled = spherical::Data::new(grid.scatter(), grid.knots().clone(), grid.channels().clone(), values);
    scaled.and_then(|scaled| if grid.is_mirrored() { scaled.mirrored() } else { Ok(scaled) }).map_err(invalid)
}

/// The integrals of `f cos` over the hemisphere, `[theta_i][phi_i][channel]`.
pub(crate) fn integrals(grid: &spherical::Data) -> Vec<f64> {
    let channels = grid.channels().count();
    let [_, _, thetas, phis] = grid.knots();
    let (by_theta, by_phi) = (polar(thetas), azimuthal(phis, grid.is_mirrored()));
    let mut integrals = Vec::new();
    for slice in grid.values().chunks_exact(by_theta.len() * by_phi.len() * channels) {
        let mut sums = vec![0.0; channels];
        let weights = by_theta.iter().flat_map(|theta| by_phi.iter().map(move |phi| theta * phi));
        for (texel, weight) in slice.chunks_exact(channels).zip(weights) {
            sums.iter_mut().zip(texel).for_each(|(sum, value)| *sum += weight * f64::from(*value));
        }
        integrals.extend(sums);
    }
    integrals
}

/// The weight of each knot of the viewer's polar angle: values are linear between knots and constant beyond them.
fn polar(knots: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; knots.len()];
    let last = knots.len() - 1;
    let cells = knots.windows(2).enumerate().map(|(i, pair)| ([pair[0], pair[1]], [i, i + 1]));
    for ([from, to], [a, b]) in cells.chain([([0.0, knots[0]], [0, 0]), ([knots[last], FRAC_PI_2], [last, last])]) {
        const STEPS: u32 = 64;
        let width = (to - from) / f64::from(STEPS);
        for step in 0..STEPS {
            let share = (f64::from(step) + 0.5) / f64::from(STEPS);
            let (sin, cos) = (from + share * (to - from)).sin_cos();
            weights[a] += (1.0 - share) * sin * cos * width;
            weights[b] += share * sin * cos * width;
        }
    }
    weights
}

/// The weight of each knot of the viewer's azimuth; a mirrored half circle counts twice.
fn azimuthal(knots: &[f64], is_mirrored: bool) -> Vec<f64> {
    let mut weights = vec![0.0; knots.len()];
    for (i, pair) in knots.windows(2).enumerate() {
        weights[i] += 0.5 * (pair[1] - pair[0]);
        weights[i + 1] += 0.5 * (pair[1] - pair[0]);
    }
    let last = knots.len() - 1;
    let rest = if is_mirrored { 0.5 * TAU } else { TAU } - (knots[last] - knots[0]);
    // Across the seam, or beyond both ends of the half circle.
    weights[0] += 0.5 * rest;
    weights[last] += 0.5 * rest;
    weights.into_iter().map(|weight| if is_mirrored { 2.0 * weight } else { weight }).collect()
}

#[cfg(test)]
mod tests {
    use lobe_table::{Channels, Scatter};

    use super::*;

    #[test]
    fn a_constant_has_the_integral_pi() {
        let degrees = |angles: &[f64]| angles.iter().map(|angle| f64::to_radians(*angle)).collect::<Vec<f64>>();
        for (thetas, phis) in
            [(vec![0.0, 30.0, 90.0], vec![0.0, 90.0, 180.0, 270.0]), (vec![10.0, 80.0], vec![0.0, 180.0, 360.0])]
        {
            let knots = [degrees(&[0.0, 40.0]), vec![0.0], degrees(&thetas), degrees(&phis)];
            let values = vec![7.0; 2 * thetas.len() * phis.len() * 3];
            let grid = spherical::Data::new(Scatter::Reflection, knots, Channels::Xyz, values).expect("a grid");
            let scaled = scale(Path::new("file"), &grid, &[0.5, 0.25, 0.0, 1.0, 0.5, 0.125]).expect("scaled");
            let of_slice = |slice: usize| &scaled.values()[slice * thetas.len() * phis.len() * 3..][..3];
            for (found, total) in of_slice(0).iter().chain(of_slice(1)).zip([0.5, 0.25, 0.0, 1.0, 0.5, 0.125]) {
                assert!((f64::from(*found) * TAU / 2.0 - total).abs() < 1e-4, "{found}, not {total} / pi");
            }
        }
    }
}
