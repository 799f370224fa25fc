//! Conversion of the quantities in DDR files to `f` in 1/sr.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use lobe_table::specular::coords::angles_to_directions;
use lobe_table::specular::reference::zenith;
use lobe_table::{Edges, specular};

use super::grid::{Grid, from_samples};
use crate::{FormatError, Place};

/// The smallest cosine by which an intensity is divided: that of 89.9 degrees. Closer to the horizon, a measurement is
/// noise, which the division would amplify 600 times.
const HORIZON: f64 = 1.745e-3;

/// Divides intensities, `f cos(theta_out)`, by the cosine.
///
/// `block` is `[psi][sigma][phi][theta]`, and `zeniths` is the polar angle of the frame at each sigma. At and below the
/// horizon, the quotient is undefined: such a node takes the `f` of the nearest node above the horizon in its row of
/// theta, which keeps the interpolation across the horizon reasonable, and 0 if the whole row is below.
pub(crate) fn divide_by_cosine(grid: &Grid, zeniths: &[f64], block: &mut [f64]) {
    let [sigmas, psis, thetas, phis] = grid.degrees.each_ref().map(Vec::len);
    let theta = super::grid::radians(&grid.degrees[2]);
    let phi = super::grid::radians(&grid.degrees[3]);
    let rows = block.chunks_exact_mut(thetas);
    for (row, values) in rows.enumerate().take(psis * sigmas * phis) {
        let (s, h) = (row / phis % sigmas, row % phis);
        let cosines: Vec<f64> =
            theta.iter().map(|&t| angles_to_directions([zeniths[s], 0.0, t, phi[h]], |z| z).1[2]).collect();
        divide_row(&cosines, values);
    }
}

/// The values of one row of theta.
fn divide_row(cosines: &[f64], values: &mut [f64]) {
    let above = |cosine: &f64| *cosine > HORIZON;
    // Along a row, the direction leaves the upper side only once, so the nodes above the horizon are contiguous.
    let (Some(first), Some(last)) = (cosines.iter().position(above), cosines.iter().rposition(above)) else {
        return values.fill(0.0);
    };
    for (value, cosine) in values[first..=last].iter_mut().zip(&cosines[first..=last]) {
        *value /= cosine;
    }
    let (lowest, highest) = (values[first], values[last]);
    values[..first].fill(lowest);
    values[last + 1..].fill(highest);
}

/// The same for a table whose values were read as `f`.
pub(crate) fn divide_nodes_by_cosine(file: &Path, samples: &specular::Data) -> Result<specular::Data, FormatError> {
    let knots = samples.knots();
    let [sigmas, psis, thetas, phis] = knots.each_ref().map(Vec::len);
    let channels = samples.channels().count();
    let mut values = samples.values().to_vec();
    let mut row = vec![0.0; thetas];
    for (incidence, slice) in values.chunks_exact_mut(thetas * phis * channels).enumerate().take(sigmas * psis) {
        let zenith = zenith(samples, &Edges::default(), knots[0][incidence / psis]);
        for h in 0..phis {
            let cosine = |theta: &f64| angles_to_directions([zenith, 0.0, *theta, knots[3][h]], |zenith| zenith).1[2];
            let cosines: Vec<f64> = knots[2].iter().map(cosine).collect();
            for c in 0..channels {
                let node = |t: usize| (t * phis + h) * channels + c;
                row.iter_mut().enumerate().for_each(|(t, value)| *value = f64::from(slice[node(t)]));
                divide_row(&cosines, &mut row);
                row.iter().enumerate().for_each(|(t, value)| slice[node(t)] = *value as f32);
            }
        }
    }
    let divided = specular::Data::new(samples.scatter(), knots.clone(), samples.channels().clone(), values);
    let divided = divided.map_err(|error| from_samples(file, &error))?;
    match samples.refraction() {
        Some(offsets) => divided.with_refraction(offsets.to_vec()).map_err(|error| from_samples(file, &error)),
        None => Ok(divided),
    }
}

/// Scales each slice, a pair of sigma and psi knots in one channel, to a given directional-hemispherical reflectance.
///
/// `targets` holds one number per channel and pair, `[psi][sigma]`, which errors call by the name in the file.
pub(crate) fn scale_slices(
    file: &Path,
    samples: &specular::Data,
    targets: &[Vec<f64>],
    name: &str,
) -> Result<specular::Data, FormatError> {
    let [sigmas, psis, thetas, phis] = samples.knots().each_ref().map(Vec::len);
    let channels = samples.channels().count();
    let mut values = samples.values().to_vec();
    let quadrature = Quadrature::new(samples);
    for s in 0..sigmas {
        let weights = quadrature.weights(zenith(samples, &Edges::default(), samples.knots()[0][s]));
        for p in 0..psis {
            let slice = &mut values[(s * psis + p) * thetas * phis * channels..][..thetas * phis * channels];
            for (c, targets) in targets.iter().enumerate() {
                let target = targets[p * sigmas + s];
                let of_channel = slice.iter().skip(c).step_by(channels);
                let reflectance: f64 = of_channel.clone().zip(&weights).map(|(&f, weight)| f64::from(f) * weight).sum();
                let scale = target / reflectance;
                let blank = of_channel.clone().all(|&v| v == 0.0);
                let possible = if blank { target == 0.0 } else { scale.is_finite() && scale >= 0.0 };
                if !possible {
                    let degrees = samples.knots()[0][s].to_degrees();
                    let found = format!(
                        "relative values with a reflectance of {reflectance} at sigma {degrees:.6} in channel {c}"
                    );
                    let expected = format!("one that can be scaled to {name} {target}");
                    return Err(FormatError::new(file, Place::File, found, expected));
                }
                for value in slice.iter_mut().skip(c).step_by(channels).filter(|_| !blank) {
                    *value = (f64::from(*value) * scale) as f32;
                }
            }
        }
    }
    let scaled = specular::Data::new(samples.scatter(), samples.knots().clone(), samples.channels().clone(), values);
    let scaled = scaled.map_err(|error| from_samples(file, &error))?;
    match samples.refraction() {
        Some(offsets) => scaled.with_refraction(offsets.to_vec()).map_err(|error| from_samples(file, &error)),
        None => Ok(scaled),
    }
}

/// The directional-hemispherical reflectance of each slice, one `[psi][sigma]` per channel.
pub(crate) fn reflectances(samples: &specular::Data) -> Vec<Vec<f64>> {
    let [sigmas, psis, ..] = samples.knots().each_ref().map(Vec::len);
    let channels = samples.channels().count();
    let quadrature = Quadrature::new(samples);
    let weigh = |s: usize| quadrature.weights(zenith(samples, &Edges::default(), samples.knots()[0][s]));
    let weights: Vec<Vec<f64>> = (0..sigmas).map(weigh).collect();
    let slice = |p: usize, s: usize| {
        let nodes = weights[s].len() * channels;
        let values = &samples.values()[(s * psis + p) * nodes..][..nodes];
        let channel = |c: usize| {
            let of_channel = values.iter().skip(c).step_by(channels);
            of_channel.zip(&weights[s]).map(|(&f, weight)| f64::from(f) * weight).sum()
        };
        (0..channels).map(channel).collect()
    };
    (0..psis).flat_map(|p| (0..sigmas).map(move |s| (p, s))).map(|(p, s)| slice(p, s)).collect()
}

/// The integral of `f cos(theta_out)` over the hemisphere as a sum over the nodes of a slice: the midpoint rule inside
/// every cell of theta and phi, whose error at these steps is below 1e-4.
///
/// `f` is linear within a cell, clamped beyond the ends of theta, and periodic in phi. Everything that depends on one
/// angle is computed only once, because a file may have a million slices of one value.
struct Quadrature {
    thetas: Vec<Part>,
    phis: Vec<Part>,
    counts: [usize; 2],
}

/// A part of a cell, given by the angle in its middle.
struct Part {
    sin: f64,
    cos: f64,
    width: f64,
    /// The nodes at the ends of the cell, and their weights.
    nodes: [(usize, f64); 2],
}

impl Quadrature {
    fn new(samples: &specular::Data) -> Self {
        const STEPS: [f64; 2] = [1.5 * PI / 180.0, 4.0 * PI / 180.0];
        let [_, _, theta, phi] = samples.knots();
        let (last, end) = (theta.len() - 1, phi[0] + TAU);
        let clamped = [([0.0, theta[0]], [0, 0]), ([theta[last], PI], [last, last])];
        let closing = [([phi[phi.len() - 1], end], [phi.len() - 1, 0])];
        Quadrature {
            thetas: parts(cells(theta).chain(clamped), PI, STEPS[0]),
            phis: parts(cells(phi).chain(closing), end, STEPS[1]),
            counts: [theta.len(), phi.len()],
        }
    }

    /// The weight of each node of a slice, `[theta][phi]`, in a frame with this polar angle.
    fn weights(&self, zenith: f64) -> Vec<f64> {
        let [thetas, phis] = self.counts;
        let (sin_zenith, cos_zenith) = zenith.sin_cos();
        let mut weights = vec![0.0; thetas * phis];
        for theta in &self.thetas {
            for phi in &self.phis {
                let cosine = cos_zenith * theta.cos + sin_zenith * theta.sin * phi.cos;
                if cosine > 0.0 {
                    let weight = cosine * theta.sin * theta.width * phi.width;
                    for (t, of_theta) in theta.nodes {
                        for (h, of_phi) in phi.nodes {
                            weights[t * phis + h] += weight * of_theta * of_phi;
                        }
                    }
                }
            }
        }
        weights
    }
}

/// The ends of the cells between knots, and the nodes there.
fn cells(knots: &[f64]) -> impl Iterator<Item = ([f64; 2], [usize; 2])> {
    knots.windows(2).enumerate().map(|(i, pair)| ([pair[0], pair[1]], [i, i + 1]))
}

/// Divides each cell below `end` into at least two equal parts, none larger than `step`.
fn parts(cells: impl Iterator<Item = ([f64; 2], [usize; 2])>, end: f64, step: f64) -> Vec<Part> {
    let mut parts = Vec::new();
    for ([from, to], nodes) in cells {
        let span = to.min(end) - from;
        if span <= 0.0 {
            continue;
        }
        let count = (span / step).ceil().max(2.0);
        let width = span / count;
        parts.extend((0..count as usize).map(|i| {
            let angle = from + (i as f64 + 0.5) * width;
            let (sin, cos) = angle.sin_cos();
            let share = (angle - from) / (to - from);
            Part { sin, cos, width, nodes: [(nodes[0], 1.0 - share), (nodes[1], share)] }
        }));
    }
    parts
}
