//! From the quantities that DDR files hold to `f` in 1/sr.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use lobe_table::coords::angles_to_directions;
use lobe_table::reference::{eval_angles, zenith};
use lobe_table::{Edges, Samples};

use crate::grid::{Grid, from_samples};
use crate::{FormatError, Place};

/// The smallest cosine an intensity is divided by: that of 89.9 degrees. Closer to the horizon a measurement is noise,
/// and the division would make it 600 times as large.
const HORIZON: f64 = 1.745e-3;

/// Divides intensities, `f cos(theta_out)`, by the cosine.
///
/// `block` is `[psi][sigma][phi][theta]`, `zeniths` the polar angle of the frame at each sigma. At and below the horizon
/// there is no quotient: such a node takes the `f` of the nearest node above it in its row of theta, which keeps the
/// interpolation across the horizon sane, and 0 where the whole row is below.
pub(crate) fn divide_by_cosine(grid: &Grid, zeniths: &[f64], block: &mut [f64]) {
    let [sigmas, psis, thetas, phis] = grid.degrees.each_ref().map(Vec::len);
    let theta = crate::grid::radians(&grid.degrees[2]);
    let phi = crate::grid::radians(&grid.degrees[3]);
    let rows = block.chunks_exact_mut(thetas);
    for (row, values) in rows.enumerate().take(psis * sigmas * phis) {
        let (s, h) = (row / phis % sigmas, row % phis);
        let cosines: Vec<f64> =
            theta.iter().map(|&t| angles_to_directions([zeniths[s], 0.0, t, phi[h]], |z| z).1[2]).collect();
        let above = |&t: &usize| cosines[t] > HORIZON;
        // Along a row the direction leaves the upper side once for good, so the nodes above the horizon are neighbours.
        let (Some(first), Some(last)) = ((0..thetas).find(above), (0..thetas).rfind(above)) else {
            values.fill(0.0);
            continue;
        };
        for t in first..=last {
            values[t] /= cosines[t];
        }
        let (lowest, highest) = (values[first], values[last]);
        values[..first].fill(lowest);
        values[last + 1..].fill(highest);
    }
}

/// Scales each slice, a pair of sigma and psi knots in one channel, to a given directional-hemispherical reflectance.
///
/// `targets` holds for each channel one number a pair, `[psi][sigma]`.
pub(crate) fn scale_slices(file: &Path, samples: &Samples, targets: &[Vec<f64>]) -> Result<Samples, FormatError> {
    let [sigmas, psis, thetas, phis] = samples.knots().each_ref().map(Vec::len);
    let channels = samples.channels().count();
    let mut values = samples.values().to_vec();
    let slice_len = thetas * phis * channels;
    for s in 0..sigmas {
        for p in 0..psis {
            let reflectance = slice_reflectance(samples, [s, p]);
            let slice = &mut values[(s * psis + p) * slice_len..][..slice_len];
            for c in 0..channels {
                let target = targets[c][p * sigmas + s];
                let scale = target / reflectance[c];
                let blank = slice.iter().skip(c).step_by(channels).all(|&v| v == 0.0);
                let possible = if blank { target == 0.0 } else { scale.is_finite() && scale >= 0.0 };
                if !possible {
                    let degrees = samples.knots()[0][s].to_degrees();
                    let found = format!(
                        "relative values with a reflectance of {} at sigma {degrees:.6} in channel {c}",
                        reflectance[c]
                    );
                    return Err(FormatError::new(
                        file,
                        Place::File,
                        found,
                        format!("one that can be scaled to kbdf {target}"),
                    ));
                }
                for value in slice.iter_mut().skip(c).step_by(channels).filter(|_| !blank) {
                    *value = (f64::from(*value) * scale) as f32;
                }
            }
        }
    }
    let scaled = Samples::new(samples.scatter(), samples.knots().clone(), samples.channels().clone(), values);
    let scaled = scaled.map_err(|error| from_samples(file, &error))?;
    match samples.refraction() {
        Some(offsets) => scaled.with_refraction(offsets.to_vec()).map_err(|error| from_samples(file, &error)),
        None => Ok(scaled),
    }
}

/// The integral of `f cos(theta_out)` over the hemisphere, a channel each, with the light at a sigma and a psi knot:
/// the midpoint rule inside every cell of theta and phi, whose error at these steps is below 1e-4.
pub(crate) fn slice_reflectance(samples: &Samples, [s, p]: [usize; 2]) -> Vec<f64> {
    const STEPS: [f64; 2] = [1.5 * PI / 180.0, 4.0 * PI / 180.0];
    let knots = samples.knots();
    let edges = Edges { non_negative: false, ..Edges::default() };
    let (sigma, psi) = (knots[0][s], knots[1][p]);
    let mut sum = vec![0.0; samples.channels().count()];
    let mut f = sum.clone();
    let phi_start = knots[3][0];
    let phis = midpoints(&knots[3], [phi_start, phi_start + TAU], STEPS[1]);
    for (theta, theta_width) in midpoints(&knots[2], [0.0, PI], STEPS[0]) {
        for &(phi, phi_width) in &phis {
            let angles = [sigma, psi, theta, phi];
            let cosine = angles_to_directions(angles, |sigma| zenith(samples, &edges, sigma)).1[2];
            if cosine > 0.0 {
                eval_angles(samples, &edges, angles, &mut f);
                let weight = cosine * theta.sin() * theta_width * phi_width;
                for (sum, f) in sum.iter_mut().zip(&f) {
                    *sum += weight * f;
                }
            }
        }
    }
    sum
}

/// Midpoints and widths of the parts of a range, cut at the knots and then into at least two parts, none over `step`.
fn midpoints(knots: &[f64], [start, end]: [f64; 2], step: f64) -> Vec<(f64, f64)> {
    let inside = knots.iter().copied().filter(|knot| (start..end).contains(knot));
    let mut parts = Vec::new();
    let mut from = start;
    for to in inside.chain([end]).filter(|&to| to > start) {
        let count = ((to - from) / step).ceil().max(2.0);
        let width = (to - from) / count;
        parts.extend((0..count as usize).map(|i| (from + (i as f64 + 0.5) * width, width)));
        from = to;
    }
    parts
}
