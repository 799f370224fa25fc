//! Albedos by roughness and cosine of the direction, which dim the base under a layer.

use crate::real::Real;

const ROWS: usize = 33;
const COLUMNS: usize = 33;

/// A function of both, at evenly spaced roughnesses from `least` to 1 and cosines from 0 to 1.
pub(super) struct Albedo {
    least: f64,
    rows: Vec<[f64; COLUMNS]>,
}

impl Albedo {
    /// The table of a function of cosine and roughness.
    pub fn new(least: f64, value: impl Fn(f64, f64) -> f64) -> Self {
        let roughness = |row: usize| least + (1.0 - least) * row as f64 / (ROWS - 1) as f64;
        let cosine = |column: usize| (column as f64 / (COLUMNS - 1) as f64).max(1e-3);
        let row = |row: usize| std::array::from_fn(|column| value(cosine(column), roughness(row)));
        Albedo { least, rows: (0..ROWS).map(row).collect() }
    }

    /// Interpolates.
    pub fn at<T: Real>(&self, cos: f64, roughness: T) -> T {
        let row = (roughness - self.least) * ((ROWS - 1) as f64 / (1.0 - self.least));
        let below = (row.value() as usize).min(ROWS - 2);
        let column = cos * (COLUMNS - 1) as f64;
        let left = (column as usize).min(COLUMNS - 2);
        let of_row = |row: &[f64; COLUMNS]| row[left] + (row[left + 1] - row[left]) * (column - left as f64);
        let (first, second) = (of_row(&self.rows[below]), of_row(&self.rows[below + 1]));
        T::of(first) + (row - below as f64) * (second - first)
    }
}
