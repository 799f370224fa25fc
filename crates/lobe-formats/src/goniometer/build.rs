//! From the rows of a table to data: missing values, wavelengths, quantities, both sides of a sheet.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use lobe_table::{Channels, Scatter};

use super::grid::{Of, data};
use super::layout::Values;
use super::raw::Raw;
use super::samples::Samples;
use super::{plane, unit};
use crate::reading::{Holds, Quantity, ReadOptions};
use crate::records::Records;
use crate::{Document, FormatError, Part, Place};

/// The largest distance of a polar angle, rounded in its file, beyond the horizon, in radians.
const ROUNDING: f64 = 1e-3;
/// The smallest cosine by which a value is divided: that of 89.9 degrees.
const HORIZON: f64 = 1.745e-3;

/// Builds a document from the rows that were read.
pub(super) fn document(mut raw: Raw, file: &Path, options: &ReadOptions) -> Result<Document, FormatError> {
    let mut notes = std::mem::take(&mut raw.notes);
    notes.append(&mut raw.layout.notes);
    let units = unit::of(&raw, file, options, &mut notes)?.map(|unit| unit.radians());
    let mut samples = Samples {
        angles: std::mem::take(&mut raw.rows),
        lines: std::mem::take(&mut raw.lines),
        values: std::mem::take(&mut raw.values),
        channels: Channels::Mono,
        is_specular: raw.layout.is_specular,
    };
    for angles in &mut samples.angles {
        angles.iter_mut().zip(units).for_each(|(angle, unit)| *angle *= unit);
    }
    if let Values::Channels(_, channels) = &raw.layout.values {
        samples.channels = channels.clone();
    }
    if !raw.wavelengths.is_empty() {
        samples.by_wavelength(&raw.wavelengths, file)?;
    }
    samples.leave_out_missing(file, &mut notes)?;
    let holds = options.holds.or(raw.layout.holds).or(raw.facts.holds);
    if !samples.is_specular {
        plane::place(&mut samples, &raw.layout, options, file, &mut notes)?;
    }
    samples.quantify(&raw, options, file, &mut notes)?;
    let through = samples.through(holds, file)?;
    let (mut parts, mut doubts) = (Vec::new(), Vec::new());
    for scatter in [Scatter::Reflection, Scatter::Transmission] {
        let is_of_part = |index: usize| through[index] == (scatter == Scatter::Transmission);
        if let Some(records) = samples.records(is_of_part) {
            let of = Of { scatter, channels: samples.channels.clone(), is_specular: samples.is_specular };
            parts.push(Part::new("", data(records, of, raw.facts.rows, file)?));
        }
    }
    if !samples.is_specular {
        doubts.extend(plane::doubt(&samples, &raw.layout, options));
    }
    let mut document = Document::of_parts(parts);
    document.source = raw.facts.source;
    document.notes = notes;
    document.doubts = doubts;
    Ok(document)
}

impl Samples {
    fn count(&self) -> usize {
        self.channels.count()
    }

    /// Keeps the rows for which this is true.
    fn keep(&mut self, is_kept: impl Fn(&[f64; 4], &[f32]) -> bool) {
        let count = self.count();
        let mut kept = 0;
        for row in 0..self.angles.len() {
            let of_row = row * count..(row + 1) * count;
            if is_kept(&self.angles[row], &self.values[of_row.clone()]) {
                self.angles[kept] = self.angles[row];
                self.lines[kept] = self.lines[row];
                self.values.copy_within(of_row, kept * count);
                kept += 1;
            }
        }
        self.angles.truncate(kept);
        self.lines.truncate(kept);
        self.values.truncate(kept * count);
    }

    fn leave_out_missing(&mut self, file: &Path, notes: &mut Vec<String>) -> Result<(), FormatError> {
        let before = self.angles.len();
        self.keep(|_, texel| texel.iter().all(|value| !value.is_nan()));
        let left_out = before - self.angles.len();
        if self.angles.is_empty() {
            let found = format!("empty cells in each of {before} rows");
            let expected =
                "a row with all of its values; empty columns can be left out by naming the others with columns";
            return Err(FormatError::new(file, Place::File, found, expected));
        }
        if left_out > 0 {
            notes.push(format!(
                "{left_out} of {before} pairs of directions left out, for which a value was not measured"
            ));
        }
        Ok(())
    }

    /// Turns rows with one wavelength each into rows with one channel per wavelength.
    fn by_wavelength(&mut self, wavelengths: &[f64], file: &Path) -> Result<(), FormatError> {
        // Adding zero removes the sign of a zero. Wavelengths are positive, so they are in the order of their bits.
        let key = |angles: &[f64; 4]| angles.map(|angle| (angle + 0.0).to_bits());
        let mut channels: BTreeMap<u64, usize> = wavelengths.iter().map(|nm| (nm.to_bits(), 0)).collect();
        channels.values_mut().enumerate().for_each(|(position, index)| *index = position);
        let mut places: BTreeMap<[u64; 4], usize> = BTreeMap::new();
        let mut rows = Vec::new();
        for (row, angles) in self.angles.iter().enumerate() {
            places.entry(key(angles)).or_insert_with(|| {
                rows.push(row);
                rows.len() - 1
            });
        }
        // Checked before memory is allocated: the product may be far larger than the file.
        if rows.len().checked_mul(channels.len()).is_none_or(|product| product / 2 > self.angles.len()) {
            let found = format!(
                "{} rows for {} pairs of directions and {} wavelengths",
                self.angles.len(),
                rows.len(),
                channels.len()
            );
            return Err(FormatError::new(file, Place::File, found, "the same wavelengths for all pairs of directions"));
        }
        let mut sums = vec![(0.0_f64, 0_u32); rows.len() * channels.len()];
        for ((angles, nm), value) in self.angles.iter().zip(wavelengths).zip(&self.values) {
            if !value.is_nan() {
                let (sum, count) = &mut sums[places[&key(angles)] * channels.len() + channels[&nm.to_bits()]];
                *sum += f64::from(*value);
                *count += 1;
            }
        }
        self.angles = rows.iter().map(|&row| self.angles[row]).collect();
        self.lines = rows.iter().map(|&row| self.lines[row]).collect();
        self.values = sums
            .iter()
            .map(|&(sum, count)| if count == 0 { f32::NAN } else { (sum / f64::from(count)) as f32 })
            .collect();
        self.channels = Channels::Spectral(channels.keys().map(|&bits| f64::from_bits(bits)).collect());
        Ok(())
    }

    /// Converts measured values to `f`.
    fn quantify(
        &mut self,
        raw: &Raw,
        options: &ReadOptions,
        file: &Path,
        notes: &mut Vec<String>,
    ) -> Result<(), FormatError> {
        let stated = options.values.or(raw.layout.quantity);
        let quantity = stated.unwrap_or(Quantity::F);
        let percent = if raw.layout.is_percent { 0.01 } else { 1.0 };
        if raw.layout.is_percent && quantity != Quantity::LuminanceFactor {
            let expected = "f in 1/sr, or values = luminance-factor";
            return Err(FormatError::new(file, Place::Line(raw.names_line.max(1)), "values in %", expected));
        }
        let said = if options.values.is_some() { "as the options say" } else { "by their name" };
        match quantity {
            Quantity::F if stated.is_none() => {
                notes.push("values are assumed to be f in 1/sr, without the cosine".into())
            }
            Quantity::F => notes.push(format!("values are f in 1/sr, without the cosine, {said}")),
            Quantity::LuminanceFactor => {
                notes.push(format!("values are luminance factors, pi f, {said}"));
                self.values.iter_mut().for_each(|value| *value = (f64::from(*value) * percent / PI) as f32);
            }
            Quantity::FCos => {
                notes.push(format!("values are f cos(theta_o), {said}, and were divided by the cosine"));
                let is_specular = self.is_specular;
                let before = self.angles.len();
                self.keep(|angles, _| cosine(angles, is_specular) > HORIZON);
                if self.angles.len() < before {
                    notes.push(format!(
                        "{} rows within 0.1 degrees of the horizon or below it left out",
                        before - self.angles.len()
                    ));
                }
                let count = self.count();
                for (angles, texel) in self.angles.iter().zip(self.values.chunks_exact_mut(count)) {
                    let cosine = cosine(angles, is_specular);
                    texel.iter_mut().for_each(|value| *value = (f64::from(*value) / cosine) as f32);
                }
                if self.angles.is_empty() {
                    return Err(FormatError::new(file, Place::File, "no rows above the horizon", "at least one"));
                }
            }
        }
        Ok(())
    }

    /// Checks the ranges of polar angles. Returns one value per row, `true` if the row is transmitted light.
    fn through(&self, holds: Option<Holds>, file: &Path) -> Result<Vec<bool>, FormatError> {
        let error = |row: usize, axis: usize, expected: &str| {
            let name = if self.is_specular {
                ["sigma", "psi", "theta", "phi"]
            } else {
                ["theta_i", "phi_i", "theta_o", "phi_o"]
            }[axis];
            let found = format!("{name} of {:.6} degrees", self.angles[row][axis].to_degrees());
            Err(FormatError::new(file, Place::Line(self.lines[row] as usize), found, expected))
        };
        if let Some(row) = self.angles.iter().position(|angles| angles[0].abs() > FRAC_PI_2 + ROUNDING) {
            return error(row, 0, "light from the side of the normal, 0 to 90 degrees");
        }
        let is_beyond = |angles: &[f64; 4]| !self.is_specular && angles[2].abs() > FRAC_PI_2 + ROUNDING;
        let beyond = self.angles.iter().position(is_beyond);
        if let Some(row) = self.angles.iter().position(|angles| angles[2].abs() > PI + ROUNDING) {
            return error(row, 2, "an angle of at most 180 degrees");
        }
        match (holds, beyond) {
            (None | Some(Holds::Reflection), Some(row)) => error(
                row,
                2,
                "0 to 90 degrees, or --holds transmission, or --holds both if light beyond 90 degrees is transmitted",
            ),
            (None | Some(Holds::Reflection), None) => Ok(vec![false; self.angles.len()]),
            (Some(Holds::Both), _) => Ok(self.angles.iter().map(is_beyond).collect()),
            (Some(Holds::Transmission), Some(_)) => match self.angles.iter().position(|angles| !is_beyond(angles)) {
                Some(row) => error(row, 2, "all angles beyond 90 degrees, or none, or --holds both"),
                None => Ok(vec![true; self.angles.len()]),
            },
            (Some(Holds::Transmission), None) => Ok(vec![true; self.angles.len()]),
        }
    }

    /// Some of the rows, each with its polar angles on its side of the surface.
    fn records(&self, is_kept: impl Fn(usize) -> bool) -> Option<Records> {
        let mut records = Records::default();
        for (row, (angles, texel)) in self.angles.iter().zip(self.values.chunks_exact(self.count())).enumerate() {
            if !is_kept(row) {
                continue;
            }
            let mut angles = *angles;
            if self.is_specular {
                // Specular angles have no sign to remove.
                records.angles.push(angles);
            } else {
                if angles[2].abs() > FRAC_PI_2 + ROUNDING {
                    angles[2] = (PI - angles[2].abs()).copysign(angles[2]);
                }
                angles[0] = angles[0].clamp(-FRAC_PI_2, FRAC_PI_2);
                angles[2] = angles[2].clamp(-FRAC_PI_2, FRAC_PI_2);
                records.push(angles, std::iter::empty());
            }
            records.values.extend_from_slice(texel);
        }
        (!records.angles.is_empty()).then_some(records)
    }
}

/// The cosine of the viewer's polar angle.
fn cosine([sigma, _, theta, phi]: &[f64; 4], is_specular: bool) -> f64 {
    match is_specular {
        true => sigma.cos() * theta.cos() + sigma.sin() * theta.sin() * phi.cos(),
        false => theta.cos().abs(),
    }
}
