//! Collects the samples of a file for a representation.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

use lobe_table::scattered::ScatteredError;
use lobe_table::{Channels, Scatter, scattered};

use crate::{FormatError, Place};

/// Samples one after the other: `theta_i`, `phi_i`, `theta_o`, `phi_o` in radians, and their channels.
#[derive(Default)]
pub(crate) struct Records {
    pub angles: Vec<[f64; 4]>,
    pub values: Vec<f32>,
    /// The line of each sample, if its reader gives it.
    lines: Vec<usize>,
}

impl Records {
    /// Like [`push`](Self::push), for a line of a text.
    pub(crate) fn push_line(&mut self, line: usize, angles: [f64; 4], values: impl IntoIterator<Item = f64>) {
        self.lines.push(line);
        self.push(angles, values);
    }

    /// Adds a sample. Polar angles may be negative, as goniometers count them within a plane: they mean the opposite
    /// azimuth.
    pub(crate) fn push(&mut self, [theta_i, phi_i, theta_o, phi_o]: [f64; 4], values: impl IntoIterator<Item = f64>) {
        let ((theta_i, phi_i), (theta_o, phi_o)) = (unsigned(theta_i, phi_i), unsigned(theta_o, phi_o));
        self.angles.push([theta_i, phi_i, theta_o, phi_o]);
        self.values.extend(values.into_iter().map(|value| value as f32));
    }

    /// Converts the samples to data.
    pub(crate) fn scattered(
        self,
        file: &Path,
        scatter: Scatter,
        channels: Channels,
    ) -> Result<scattered::Data, FormatError> {
        scattered::Data::new(scatter, channels, &self.angles, &self.values).map_err(|error| {
            let line = match &error {
                ScatteredError::ValueNotFinite { sample, .. } | ScatteredError::Angle { sample, .. } => {
                    self.lines.get(*sample)
                }
                ScatteredError::Empty | ScatteredError::ValueCount { .. } => None,
            };
            let place = line.map_or(Place::File, |line| Place::Line(*line));
            FormatError::new(file, place, error.to_string(), "a measurement")
        })
    }
}

fn unsigned(theta: f64, phi: f64) -> (f64, f64) {
    if theta < 0.0 { (-theta, phi + PI) } else { (theta, phi) }
}

/// Samples that a file lists wavelength by wavelength.
#[derive(Default)]
pub(crate) struct ByWavelength {
    geometries: BTreeMap<[u64; 4], usize>,
    wavelengths: BTreeMap<u64, usize>,
    /// Geometry, wavelength, value.
    samples: Vec<(usize, usize, f64)>,
}

impl ByWavelength {
    /// Adds a sample; the wavelength is in nm, and positive.
    pub(crate) fn push(&mut self, nm: f64, angles: [f64; 4], value: f64) {
        // Positive numbers are ordered like their bits. Adding zero removes the sign of a zero.
        let (geometries, wavelengths) = (self.geometries.len(), self.wavelengths.len());
        let geometry = *self.geometries.entry(angles.map(|angle| (angle + 0.0).to_bits())).or_insert(geometries);
        let wavelength = *self.wavelengths.entry(nm.to_bits()).or_insert(wavelengths);
        self.samples.push((geometry, wavelength, value));
    }

    /// One sample per geometry, with a channel per wavelength. Values of the same geometry and wavelength are averaged.
    pub(crate) fn scattered(self, file: &Path, scatter: Scatter) -> Result<scattered::Data, FormatError> {
        let (geometries, wavelengths) = (self.geometries.len(), self.wavelengths.len());
        let missing = |found: String| {
            let expected = format!("all {wavelengths} wavelengths for each of {geometries} pairs of directions");
            Err(FormatError::new(file, Place::File, found, expected))
        };
        // Checked before memory is allocated: the product may be far larger than the file.
        if geometries.checked_mul(wavelengths).is_none_or(|product| product > self.samples.len()) {
            return missing(format!("{} samples", self.samples.len()));
        }
        let mut sums = vec![(0.0, 0_u32); geometries * wavelengths];
        for (geometry, wavelength, value) in self.samples {
            let (sum, count) = &mut sums[geometry * wavelengths + wavelength];
            *sum += value;
            *count += 1;
        }
        if sums.iter().any(|&(_, count)| count == 0) {
            return missing("one without a value".into());
        }
        let mut records = Records::default();
        for (angles, &geometry) in &self.geometries {
            let of_geometry = &sums[geometry * wavelengths..][..wavelengths];
            let by_wavelength =
                self.wavelengths.values().map(|&index| of_geometry[index].0 / f64::from(of_geometry[index].1));
            records.push(angles.map(f64::from_bits), by_wavelength);
        }
        let nm = self.wavelengths.keys().map(|&bits| f64::from_bits(bits)).collect();
        records.scattered(file, scatter, Channels::Spectral(nm))
    }
}
