//! The elements of both kinds of files.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use lobe_table::Scatter;

use crate::lines::shown;
use crate::{FormatError, Place};

/// Below this cosine, an intensity cannot be distinguished from the error of dividing by it.
const LEAST_COSINE: f64 = 1e-3;
/// In degrees.
const ROUNDING: f64 = 1e-3;

/// A text that is read line by line in its head and number by number after it.
pub(super) struct Source<'a> {
    pub(super) file: &'a Path,
    rest: &'a str,
    line: usize,
    /// The size of the whole text in bytes.
    pub(super) size: usize,
}

impl<'a> Source<'a> {
    pub(super) fn new(file: &'a Path, text: &'a str) -> Self {
        Source { file, rest: text, line: 1, size: text.len() }
    }

    fn take(&mut self, end: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(end);
        self.line += taken.bytes().filter(|&byte| byte == b'\n').count();
        self.rest = rest;
        taken
    }

    /// The rest of the line, which may be empty.
    pub(super) fn line(&mut self, expected: &str) -> Result<&'a str, FormatError> {
        if self.rest.is_empty() {
            return Err(self.error("the end of the file", expected));
        }
        let end = self.rest.find('\n').map_or(self.rest.len(), |end| end + 1);
        Ok(self.take(end).trim_end())
    }

    /// Skips a description of `length` characters, which may have several lines, and the rest of its last line.
    pub(super) fn description(&mut self, length: usize) -> Result<(), FormatError> {
        let end = self.rest.char_indices().nth(length).map_or(self.rest.len(), |(end, _)| end);
        self.take(end);
        self.line("the measurement description").map(|_| ())
    }

    /// The next number.
    pub(super) fn number(&mut self, expected: &str) -> Result<f64, FormatError> {
        self.take(self.rest.len() - self.rest.trim_start().len());
        let end = self.rest.find(char::is_whitespace).unwrap_or(self.rest.len());
        let word = self.take(end);
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| {
            let found = if word.is_empty() { "the end of the file".into() } else { shown(word) };
            self.error(found, expected)
        })
    }

    /// The next number as a count of numbers that fit into the rest of the file.
    pub(super) fn count(&mut self, expected: &str) -> Result<usize, FormatError> {
        let number = self.number(expected)?;
        let most = self.rest.len() / 2;
        if number.fract() != 0.0 || number < 1.0 || number > most as f64 {
            return Err(self.error(format!("{number}"), format!("{expected}, 1 to {most} in the rest of the file")));
        }
        Ok(number as usize)
    }

    /// `count` numbers, which fit according to [`count`](Self::count).
    pub(super) fn list(&mut self, count: usize, expected: &str) -> Result<Vec<f64>, FormatError> {
        (0..count).map(|_| self.number(expected)).collect()
    }

    /// The next number as 0 or 1.
    pub(super) fn flag(&mut self, expected: &str) -> Result<bool, FormatError> {
        match self.number(expected)? {
            0.0 => Ok(false),
            1.0 => Ok(true),
            other => Err(self.error(format!("{other}"), format!("{expected}, 0 or 1"))),
        }
    }

    pub(super) fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        FormatError::new(self.file, Place::Line(self.line), found, expected)
    }
}

/// A table of polar angle by azimuth. Angles in radians; polar ones from the normal on the side of the outgoing light.
pub(super) struct Table {
    thetas: Vec<f64>,
    phis: Vec<f64>,
    values: Vec<f64>,
    is_intensity: bool,
}

impl Table {
    /// Reads the counts, the azimuths, and a row per polar angle. Those of reflected light are up to 90 degrees; all of
    /// transmitted light are on one side.
    pub(super) fn read(source: &mut Source<'_>, is_intensity: bool, scatter: Scatter) -> Result<Self, FormatError> {
        let (rows, columns) = (source.count("the number of polar angles")?, source.count("the number of azimuths")?);
        let phis: Vec<f64> = source.list(columns, "an azimuth")?.into_iter().map(f64::to_radians).collect();
        let (mut thetas, mut values) = (Vec::new(), Vec::new());
        let (mut is_before, mut is_beyond) = (false, false);
        for _ in 0..rows {
            let theta = source.number("a polar angle")?;
            if !(0.0..=180.0).contains(&theta) {
                return Err(source.error(format!("polar angle {theta}"), "0 to 180 degrees"));
            }
            is_beyond |= theta > 90.0 + ROUNDING;
            is_before |= theta < 90.0 - ROUNDING;
            if is_beyond && (is_before || scatter == Scatter::Reflection) {
                let expected = "reflected light up to 90 degrees, and transmitted light on one side of 90";
                return Err(
                    source.error(format!("polar angle {theta} in a table of {scatter:?}").to_lowercase(), expected)
                );
            }
            let theta = theta.to_radians();
            thetas.push(theta.min(PI - theta));
            values.extend(source.list(columns, "a value")?);
        }
        Ok(Table { thetas, phis, values, is_intensity })
    }

    /// A table of values of the BSDF, with angles in degrees as [`read`](Self::read) finds them.
    pub(super) fn of_bsdf(thetas: &[f64], phis: &[f64], values: Vec<f64>) -> Self {
        let thetas = thetas.iter().map(|theta| theta.to_radians()).map(|theta| theta.min(PI - theta)).collect();
        let phis = phis.iter().map(|phi| phi.to_radians()).collect();
        Table { thetas, phis, values, is_intensity: false }
    }

    /// `true` if all values are 0.
    pub(super) fn is_black(&self) -> bool {
        self.values.iter().all(|value| *value == 0.0)
    }

    /// The integral of the values over the hemisphere, with the cosine that gives an albedo, by trapezoids in both
    /// angles. A table of half a turn is half of a symmetric one.
    pub(super) fn integral(&self) -> f64 {
        let columns = self.phis.len();
        let row = |index: usize| -> f64 {
            let row = &self.values[index * columns..][..columns];
            let over_phi = match columns {
                1 => TAU * row[0],
                _ => (1..columns).map(|i| 0.5 * (row[i] + row[i - 1]) * (self.phis[i] - self.phis[i - 1]).abs()).sum(),
            };
            let (sin, cos) = self.thetas[index].sin_cos();
            over_phi * sin * if self.is_intensity { 1.0 } else { cos }
        };
        let pairs = (1..self.thetas.len()).map(|i| (i, (self.thetas[i] - self.thetas[i - 1]).abs()));
        let whole: f64 = pairs.map(|(i, step)| 0.5 * (row(i) + row(i - 1)) * step).sum();
        let is_half = columns > 1 && (self.phis[columns - 1] - self.phis[0]).abs() < PI + 1e-6;
        if is_half { 2.0 * whole } else { whole }
    }

    /// `theta_o`, the azimuth from the direction in which the light continues, and `scale` times `f`.
    pub(super) fn samples(&self, scale: f64) -> impl Iterator<Item = (f64, f64, f64)> {
        let columns = self.phis.len();
        let at = move |index: usize| (self.thetas[index / columns], self.phis[index % columns], self.values[index]);
        (0..self.values.len()).map(at).filter_map(move |(theta, phi, value)| {
            let cosine = if self.is_intensity { libm::cos(theta) } else { 1.0 };
            (cosine >= LEAST_COSINE).then_some((theta, phi, scale * value / cosine))
        })
    }
}

/// Reads incident angles, whose number must be known; checks that they are on a hemisphere.
pub(super) fn incident_angles(source: &mut Source<'_>, count: usize) -> Result<Vec<f64>, FormatError> {
    let angles = source.list(count, "an incident angle")?;
    match angles.iter().find(|angle| !(0.0..=90.0).contains(*angle)) {
        Some(angle) => Err(source.error(format!("incident angle {angle}"), "0 to 90 degrees")),
        None => Ok(angles.into_iter().map(f64::to_radians).collect()),
    }
}
