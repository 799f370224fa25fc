//! Conversion of measured channels to bands.

use lobe_colour::{Channels, Reduction};

use crate::Bands;

impl Bands {
    /// The conversion of channels to bands: wavelengths are interpolated; all other channels are colours, which become
    /// sums of three smooth spectra. `None` if the channels are already the bands.
    pub fn resampling(&self, channels: &Channels) -> Option<Resampling> {
        if let Channels::Spectral(wavelengths) = channels {
            if *wavelengths == self.wavelengths() {
                return None;
            }
            let mut order: Vec<usize> = (0..wavelengths.len()).collect();
            order.sort_by(|&a, &b| wavelengths[a].total_cmp(&wavelengths[b]));
            let parts = self.wavelengths().iter().map(|nm| {
                let upper = order.partition_point(|&index| wavelengths[index] < *nm);
                let (a, b) = (order[upper.saturating_sub(1)], order[upper.min(order.len() - 1)]);
                let width = wavelengths[b] - wavelengths[a];
                let share = if width > 0.0 { ((nm - wavelengths[a]) / width).clamp(0.0, 1.0) } else { 0.0 };
                vec![(a, (1.0 - share) as f32), (b, share as f32)]
            });
            return Some(Resampling { channels: wavelengths.len(), parts: parts.collect() });
        }
        let reduction = Reduction::for_display(channels);
        let primaries = self.primaries();
        let parts = (0..self.count()).map(|band| {
            let weight = |colour: &[f64; 3]| (0..3).map(|k| colour[k] * primaries[k][band]).sum::<f64>() as f32;
            reduction.weights().iter().map(weight).enumerate().collect()
        });
        Some(Resampling { channels: channels.count(), parts: parts.collect() })
    }

    /// Three spectra whose sum is 1 everywhere, with the colours of red, green and blue under D65. They may be slightly
    /// below 0 in places.
    fn primaries(&self) -> [Vec<f64>; 3] {
        let [red, green, blue] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|rgb| self.fit(rgb));
        // The difference of their sum from white is divided among the three in proportion, which keeps them smooth.
        let mut parts = [red, green, blue];
        for band in 0..self.count() {
            let sum: f64 = parts.iter().map(|part| part[band]).sum();
            parts.iter_mut().for_each(|part| part[band] /= sum.max(1e-9));
        }
        // Mixed so that each has its colour; white, their sum, stays white.
        let colour = |part: &Vec<f64>| {
            let mut sum = [0.0; 3];
            for (value, weights) in part.iter().zip(&self.reduction) {
                sum.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * value);
            }
            sum
        };
        let colours = [colour(&parts[0]), colour(&parts[1]), colour(&parts[2])];
        let Some(mix) = inverse(&colours) else { return parts };
        mix.map(|shares| {
            let of = |band: usize| (0..3).map(|k| shares[k] * parts[k][band]).sum();
            (0..self.count()).map(of).collect()
        })
    }
}

/// A linear map from channels to bands.
#[derive(Clone, Debug, PartialEq)]
pub struct Resampling {
    channels: usize,
    /// For each band, the channels with weights, and the weights.
    parts: Vec<Vec<(usize, f32)>>,
}

impl Resampling {
    /// The number of channels.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// For each band, the channels with weights, and the weights: two for wavelengths.
    pub fn parts(&self) -> &[Vec<(usize, f32)>] {
        &self.parts
    }

    /// Converts a value to bands, into the first numbers of `out`.
    pub fn apply(&self, texel: &[f32], out: &mut [f32]) {
        for (out, parts) in out.iter_mut().zip(&self.parts) {
            *out = 0.0;
            for &(channel, weight) in parts {
                *out += weight * texel[channel];
            }
        }
    }
}

/// The inverse of a matrix, unless it is nearly singular, as for few bands.
fn inverse(m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let cofactor = |i: usize, j: usize| {
        let at = |di: usize, dj: usize| m[(i + di) % 3][(j + dj) % 3];
        at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    (determinant.abs() > 0.05).then(|| [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(j, i) / determinant)))
}
