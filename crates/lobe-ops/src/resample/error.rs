//! The difference between a table and the material that it was made from.

use std::f64::consts::{PI, TAU};

use lobe::{Material, OpenError, Options};
use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{Edges, specular};
use serde::Serialize;

use crate::directions::quasi_random;
use crate::pairs::eval_pairs;
use crate::{Aspect, OnBackend};

/// The differences between a table and its origin over a set of directions, all channels together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Resampling {
    /// The number of pairs of directions that were compared.
    pub probes: usize,
    /// The largest value of the material among them, in 1/sr.
    pub peak: f64,
    /// The largest difference, in 1/sr.
    pub max: f64,
    /// The root of the mean squared difference, in 1/sr.
    pub rms: f64,
    /// `max / peak`.
    pub relative_to_peak: f64,
    /// The largest difference relative to the value there, among values of at least a thousandth of the peak.
    pub relative_to_value: f64,
    /// The directions of the largest difference: `wi` and `wo`, with z > 0.
    pub worst: [[f64; 3]; 2],
}

/// Elevations below this cosine, 3.4 degrees, are never compared: nodes there are not the material's own values.
pub(super) const LOWEST: f64 = 0.06;

/// Compares a table with its origin at up to `count` pairs of directions that are the same at every call: spread evenly
/// over the four angles, with theta denser toward the mirror direction, within the knots of sigma, and both with polar
/// angles up to `limit` in radians.
///
/// # Errors
/// If the table is too large to be evaluated.
pub fn error<'a>(
    scattering: impl Into<OnBackend<'a>>,
    aspect: Aspect,
    samples: &specular::Data,
    limit: f64,
    count: usize,
) -> Result<Resampling, OpenError> {
    let scattering = scattering.into();
    let lowest = limit.cos().max(LOWEST);
    let sigmas = &samples.knots()[0];
    let (low, high) = (sigmas[0], sigmas[sigmas.len() - 1]);
    let probe = |index: usize| {
        let [a, b, c, d] = quasi_random::<4>(index);
        angles_to_directions([low + a * (high - low), TAU * b, PI * c.powi(3), TAU * d], |sigma| sigma)
    };
    let probes: Vec<_> = (0..count).map(probe).filter(|(wi, wo)| wi[2] >= lowest && wo[2] >= lowest).collect();
    let edges = Edges { non_negative: false, ..Edges::default() };
    let table = Material::from_samples(samples.clone(), &Options { edges, ..Options::default() })?;
    let placed: Vec<_> = probes.iter().map(|&(wi, wo)| aspect.place(wi, wo)).collect();
    let (exact, found) = (eval_pairs(scattering, &placed), eval_pairs(&table, &placed));

    let channels = scattering.channels().count();
    let peak = exact.iter().map(|&value| f64::from(value)).fold(0.0, f64::max);
    let (mut max, mut squares, mut relative, mut worst) = (0.0, 0.0, 0.0_f64, [[0.0, 0.0, 1.0]; 2]);
    for (index, (&exact, &found)) in exact.iter().zip(&found).enumerate() {
        let (exact, difference) = (f64::from(exact), f64::from(exact - found).abs());
        squares += difference * difference;
        if exact.abs() >= 1e-3 * peak && exact != 0.0 {
            relative = relative.max(difference / exact.abs());
        }
        if difference > max {
            let (wi, wo) = probes[index / channels];
            (max, worst) = (difference, [wi, wo]);
        }
    }
    Ok(Resampling {
        probes: probes.len(),
        peak,
        max,
        rms: (squares / exact.len().max(1) as f64).sqrt(),
        relative_to_peak: if peak > 0.0 { max / peak } else { 0.0 },
        relative_to_value: relative,
        worst,
    })
}
