//! The rows of a table as written in the file.

use super::facts::Facts;
use super::layout::Layout;

/// Angles and values as written in the file.
pub(super) struct Raw {
    pub layout: Layout,
    pub facts: Facts,
    /// As written, in the unit of the file: see [`Layout::angles`].
    pub rows: Vec<[f64; 4]>,
    /// The line of each row.
    pub lines: Vec<u32>,
    /// `[row][channel]`, NaN if not measured; for tables with a wavelength per row, one each.
    pub values: Vec<f32>,
    /// The wavelength of each row in nm, if each has its own.
    pub wavelengths: Vec<f64>,
    /// How the table was understood, for people.
    pub notes: Vec<String>,
    /// The line of the names; 0 if there are none.
    pub names_line: usize,
}
