//! The four lists of angles that DDR and Zemax files share, and the order of their values.

use std::path::Path;

use lobe_table::{Channels, GridError, Scatter, specular};

use crate::text::{Text, Token};
use crate::{FormatError, Place};

/// The largest angle of sigma, psi, theta and phi in degrees.
pub(crate) const LIMITS: [f32; 4] = [90.0, 360.0, 180.0, 360.0];
/// The distance beyond its limit that counts as the rounding of an angle, in degrees.
const ROUNDING: f32 = 5e-4;

/// Reads a count and as many strictly ascending angles from 0 to `limit` degrees.
///
/// Angles are rounded to `f32` here, before anything is computed from them, as in the programs that write these files.
pub(crate) fn read_angles(text: &mut Text<'_>, name: &str, limit: f32) -> Result<Vec<f32>, FormatError> {
    let count = text.count(&format!("{name} angles"))?;
    let mut angles: Vec<f32> = Vec::with_capacity(count);
    for _ in 0..count {
        let angle = read_angle(text, name, limit)?;
        if let Some(&last) = angles.last().filter(|&&last| angle <= last) {
            let expected = format!("strictly ascending {name} angles");
            return Err(text.error(text.line(), format!("{angle} after {last}"), expected));
        }
        angles.push(angle);
    }
    match text.peek() {
        Some(token) if token.is_number() => Err(text.unexpected(token, format!("no more than {count} {name} angles"))),
        _ => Ok(angles),
    }
}

/// Reads an angle from 0 to `limit` degrees.
pub(crate) fn read_angle(text: &mut Text<'_>, name: &str, limit: f32) -> Result<f32, FormatError> {
    let expected = format!("a {name} angle from 0 to {limit} degrees");
    let angle = text.number(&expected)? as f32;
    if (0.0..=limit + ROUNDING).contains(&angle) {
        Ok(angle)
    } else {
        Err(text.error(text.line(), angle.to_string(), expected))
    }
}

/// Converts degrees, rounded to `f32` in the file, to radians.
pub(crate) fn radians(degrees: &[f32]) -> Vec<f64> {
    degrees.iter().map(|&angle| f64::from(angle).to_radians()).collect()
}

/// The angle lists of a header while it is read. Axes are in the order sigma, psi, theta, phi.
pub(crate) struct Axes {
    keywords: [&'static str; 4],
    degrees: [Vec<f32>; 4],
    lines: [usize; 4],
}

impl Axes {
    /// No lists yet; their keywords will be these.
    pub fn new(keywords: [&'static str; 4]) -> Self {
        Axes { keywords, degrees: Default::default(), lines: [0; 4] }
    }

    /// The axis whose list starts with this token.
    pub fn find(&self, token: Token<'_>) -> Option<usize> {
        self.keywords.iter().position(|keyword| token.is(keyword))
    }

    /// Reads the list of an axis, after its keyword.
    pub fn read(&mut self, axis: usize, text: &mut Text<'_>) -> Result<(), FormatError> {
        let name = self.keywords[axis];
        if !self.degrees[axis].is_empty() {
            return Err(text.error(text.line(), format!("a second list of {name} angles"), "one"));
        }
        self.lines[axis] = text.line();
        self.degrees[axis] = read_angles(text, name, LIMITS[axis])?;
        Ok(())
    }

    /// The sigma angles read so far.
    pub fn sigma(&self) -> &[f32] {
        &self.degrees[0]
    }

    /// Checks that the lists are complete, and that the rest of the file has room for a block of values.
    ///
    /// A missing psi is a single 0. With `mirrored` the file lists only the half circle of phi.
    pub fn finish(mut self, text: &Text<'_>, mirrored: bool) -> Result<Grid, FormatError> {
        if self.degrees[1].is_empty() {
            self.degrees[1].push(0.0);
        }
        if let Some(missing) = self.degrees.iter().position(Vec::is_empty) {
            let expected = format!("`{}` and its angles before the values", self.keywords[missing]);
            return Err(text.error(text.line(), "the end of the header", expected));
        }
        let mut block = Some(1_usize);
        for list in &self.degrees {
            block = block.and_then(|size| size.checked_mul(list.len()));
        }
        text.room(block, "values", text.line())?;
        let listed = self.degrees[3].len();
        let mut phi_source: Vec<usize> = (0..listed).collect();
        if mirrored {
            let phi = &self.degrees[3];
            if phi[listed - 1] > 180.0 + ROUNDING {
                let expected = format!("{} from 0 to 180 degrees in a plane-symmetrical file", self.keywords[3]);
                return Err(text.error(self.lines[3], phi[listed - 1].to_string(), expected));
            }
            // Every knot off the plane of symmetry has a twin, and so has 0, so that the circle closes. A single knot
            // is constant.
            if listed > 1 {
                phi_source.extend((0..listed).rev().filter(|&i| phi[i] < 180.0 - ROUNDING));
            }
        }
        Ok(Grid { degrees: self.degrees, phi_source })
    }
}

/// Complete angle lists. A block of values in the file is `[psi][sigma][phi][theta]`, theta fastest, phi as listed.
pub(crate) struct Grid {
    /// Sigma, psi, theta and phi in degrees, as listed in the file.
    pub degrees: [Vec<f32>; 4],
    /// The listed phi that each phi of the table comes from; plane-symmetrical files list fewer than the table has.
    phi_source: Vec<usize>,
}

impl Grid {
    /// The number of values of a block.
    pub fn block_len(&self) -> usize {
        self.degrees.iter().map(Vec::len).product()
    }

    /// The number of pairs of psi and sigma.
    pub fn incidences(&self) -> usize {
        self.degrees[0].len() * self.degrees[1].len()
    }

    /// Puts one block per channel into the order of [`specular::Data`], with the second half of a plane-symmetrical
    /// circle.
    pub fn samples(
        &self,
        file: &Path,
        scatter: Scatter,
        channels: Channels,
        blocks: &[Vec<f32>],
    ) -> Result<specular::Data, FormatError> {
        let [sigma, psi, theta, phi] = self.degrees.each_ref().map(Vec::len);
        let mut values = Vec::with_capacity(sigma * psi * theta * self.phi_source.len() * blocks.len());
        for s in 0..sigma {
            for p in 0..psi {
                for t in 0..theta {
                    for &h in &self.phi_source {
                        let node = ((p * sigma + s) * phi + h) * theta + t;
                        values.extend(blocks.iter().map(|block| block[node]));
                    }
                }
            }
        }
        let mut knots = self.degrees.each_ref().map(|list| radians(list));
        knots[3] = (0..self.phi_source.len())
            .map(|i| {
                let listed = f64::from(self.degrees[3][self.phi_source[i]]);
                (if i < phi { listed } else { 360.0 - listed }).to_radians()
            })
            .collect();
        specular::Data::new(scatter, knots, channels, values).map_err(|error| from_samples(file, &error))
    }
}

/// A [`GridError`] about the contents of a file.
pub(crate) fn from_samples(file: &Path, error: &GridError) -> FormatError {
    let message = error.to_string();
    let (found, expected) = message.split_once("; expected ").unwrap_or((&message, "a table that fits together"));
    FormatError::new(file, Place::File, found, expected)
}
