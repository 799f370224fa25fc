//! The errors of a model, and where they occur.

use lobe_table::Bsdf as _;
use serde::Serialize;

use crate::fitted::Fitted;
use crate::measurement::Measurement;

/// The differences between a model and a measurement, all channels together, in 1/sr.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Residuals {
    /// The number of pairs of directions.
    pub pairs: usize,
    /// The largest measured value.
    pub peak: f64,
    /// The largest difference.
    pub max: f64,
    /// The root of the mean squared difference.
    pub rms: f64,
    /// The mean of the model minus the measurement.
    pub bias: f64,
    /// `rms` relative to the root of the mean squared measurement.
    pub relative_rms: f64,
    /// The root of the mean squared difference of natural logarithms, where both are above 0.
    pub log_rms: f64,
    /// The directions of the largest difference: to the light and to the viewer.
    pub worst: [[f64; 3]; 2],
    /// The same by the polar angle of the light.
    pub by_light: Vec<Band>,
    /// The same by the angle between the viewer and the mirror direction.
    pub by_distance: Vec<Band>,
}

/// The differences of the pairs whose angle is in an interval.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Band {
    /// The ends of the interval in degrees.
    pub degrees: [f64; 2],
    /// The number of pairs of directions.
    pub pairs: usize,
    /// The root of the mean squared difference, in 1/sr.
    pub rms: f64,
    /// The same relative to the root of the mean squared measurement of the band.
    pub relative_rms: f64,
    /// The mean of the model minus the measurement, in 1/sr.
    pub bias: f64,
}

#[derive(Clone, Copy, Default)]
struct Sum {
    pairs: usize,
    values: usize,
    squares: f64,
    measured: f64,
    bias: f64,
}

impl Sum {
    fn add(&mut self, modelled: &[f64], measured: &[f64]) {
        self.pairs += 1;
        for (modelled, measured) in modelled.iter().zip(measured) {
            self.values += 1;
            self.squares += (modelled - measured).powi(2);
            self.measured += measured * measured;
            self.bias += modelled - measured;
        }
    }

    fn rms(&self) -> f64 {
        (self.squares / self.values.max(1) as f64).sqrt()
    }

    fn relative(&self) -> f64 {
        if self.measured > 0.0 { (self.squares / self.measured).sqrt() } else { 0.0 }
    }

    fn bias(&self) -> f64 {
        self.bias / self.values.max(1) as f64
    }
}

const LIGHTS: [f64; 7] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0];
const DISTANCES: [f64; 8] = [0.0, 1.0, 3.0, 8.0, 20.0, 45.0, 90.0, 180.0];

/// Compares a model with the pairs of a measurement.
///
/// # Panics
/// If the numbers of channels differ.
pub fn residuals(fitted: &Fitted, measurement: &Measurement) -> Residuals {
    let count = measurement.channels.count();
    assert_eq!(fitted.channels().count(), count, "the same channels");
    let mut all = Sum::default();
    let mut by_light = [Sum::default(); LIGHTS.len() - 1];
    let mut by_distance = [Sum::default(); DISTANCES.len() - 1];
    let (mut max, mut worst, mut peak) = (0.0, [[0.0, 0.0, 1.0]; 2], f64::NEG_INFINITY);
    let (mut logs, mut logged) = (0.0, 0_usize);
    let mut texel = vec![0.0; count];
    let (placed_i, placed_o) = fitted.aspect.place([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
    for (pair, measured) in measurement.pairs.iter().zip(measurement.values.chunks_exact(count)) {
        let [mut wi, mut wo] = [pair.wi, pair.wo];
        (wi[2], wo[2]) = (wi[2] * placed_i[2], wo[2] * placed_o[2]);
        fitted.f(wi, wo, &mut texel);
        all.add(&texel, measured);
        let place = |angle: f64, limits: &[f64]| {
            (limits.partition_point(|limit| *limit <= angle).max(1) - 1).min(limits.len() - 2)
        };
        by_light[place(pair.cos_i().min(1.0).acos().to_degrees(), &LIGHTS)].add(&texel, measured);
        let mirror = pair.wi[2] * pair.wo[2] - pair.wi[0] * pair.wo[0] - pair.wi[1] * pair.wo[1];
        let across = {
            let [x, y, z] = [-pair.wi[0] - pair.wo[0], -pair.wi[1] - pair.wo[1], pair.wi[2] - pair.wo[2]];
            (x * x + y * y + z * z).sqrt()
        };
        // The chord is accurate near the mirror direction, the cosine is not.
        let distance = if mirror > 0.5 { 2.0 * (0.5 * across).min(1.0).asin() } else { mirror.clamp(-1.0, 1.0).acos() };
        by_distance[place(distance.to_degrees(), &DISTANCES)].add(&texel, measured);
        for (modelled, measured) in texel.iter().zip(measured) {
            peak = peak.max(*measured);
            if (modelled - measured).abs() > max {
                (max, worst) = ((modelled - measured).abs(), [pair.wi, pair.wo]);
            }
            if *modelled > 0.0 && *measured > 0.0 {
                logs += (modelled / measured).ln().powi(2);
                logged += 1;
            }
        }
    }
    Residuals {
        pairs: all.pairs,
        peak: if all.pairs > 0 { peak } else { 0.0 },
        max,
        rms: all.rms(),
        bias: all.bias(),
        relative_rms: all.relative(),
        log_rms: (logs / logged.max(1) as f64).sqrt(),
        worst,
        by_light: bands(&by_light, &LIGHTS),
        by_distance: bands(&by_distance, &DISTANCES),
    }
}

fn bands(sums: &[Sum], limits: &[f64]) -> Vec<Band> {
    let band = |(sum, ends): (&Sum, &[f64])| Band {
        degrees: [ends[0], ends[1]],
        pairs: sum.pairs,
        rms: sum.rms(),
        relative_rms: sum.relative(),
        bias: sum.bias(),
    };
    sums.iter().zip(limits.windows(2)).filter(|(sum, _)| sum.pairs > 0).map(band).collect()
}
