//! The rows and columns of the histograms, which all slices share, placed where the scattered light varies.

use std::f64::consts::TAU;

use crate::{Axis, AxisError, Edge};

/// Rows in phi and columns in `v`; each number is a power of two.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    pub(crate) row_bits: u32,
    pub(crate) column_bits: u32,
    /// The edges of the rows.
    pub(crate) phi: Axis,
    /// The edges of the columns in the square root of `v`, where they are more even.
    pub(crate) root_v: Axis,
    /// `[lower edge in v, 1 / width]` of each column.
    pub(crate) columns: Vec<[f32; 2]>,
}

impl Grid {
    /// A grid from the edges of the rows in phi and of the columns in the square root of `v`.
    pub(crate) fn new(phi: &[f64], root_v: &[f64]) -> Result<Self, AxisError> {
        let columns = root_v
            .windows(2)
            .map(|ends| [(ends[0] * ends[0]) as f32, (1.0 / (ends[1] * ends[1] - ends[0] * ends[0])) as f32])
            .collect();
        Ok(Grid {
            row_bits: (phi.len() - 1).ilog2(),
            column_bits: (root_v.len() - 1).ilog2(),
            phi: Axis::new(phi, Edge::Clamp)?,
            root_v: Axis::new(root_v, Edge::Clamp)?,
            columns,
        })
    }

    /// Bytes of memory that this holds.
    pub(crate) fn bytes(&self) -> usize {
        self.phi.bytes() + self.root_v.bytes() + size_of_val(self.columns.as_slice())
    }
}

/// The edges of `count` cells over the candidate cells between `edges`: half of them are spread by the mass of the
/// candidates, half evenly over the candidates, so that a peak is resolved and no tail is neglected.
pub(crate) fn spread(edges: &[f64], mass: &[f64], count: usize) -> Vec<f64> {
    let candidates = mass.len();
    let total: f64 = mass.iter().sum();
    let share = |m: f64| 0.5 / candidates as f64 + if total > 0.0 { 0.5 * m / total } else { 0.5 / candidates as f64 };
    let mut result = vec![edges[0]];
    let (mut candidate, mut before) = (0, 0.0);
    for k in 1..count {
        let target = k as f64 / count as f64;
        while candidate + 1 < candidates && before + share(mass[candidate]) < target {
            before += share(mass[candidate]);
            candidate += 1;
        }
        let fraction = ((target - before) / share(mass[candidate])).clamp(0.0, 1.0);
        result.push(edges[candidate] + fraction * (edges[candidate + 1] - edges[candidate]));
    }
    result.push(edges[candidates]);
    result
}

/// Even rows to choose from, at least as fine as the knots of phi.
pub(crate) fn candidate_rows(phis: usize) -> Vec<f64> {
    let count = phis.clamp(64, 256);
    (0..=count).map(|i| TAU * i as f64 / count as f64).collect()
}

/// Columns to choose from, as edges in the square root of `v`: the knots of theta, with the horizon at a right angle,
/// and as many between them as give about 128.
pub(crate) fn candidate_columns(theta: &[f32]) -> Vec<f64> {
    let mut knots = vec![0.0];
    for &theta in theta {
        let root = (1.0 - f64::from(theta).cos()).max(0.0).sqrt();
        let last = knots[knots.len() - 1];
        // Knots that single precision does not distinguish are merged.
        if root > last + 1e-5 && root < 1.0 - 1e-5 {
            knots.push(root);
        }
    }
    knots.push(1.0);
    let parts = 128usize.div_ceil(knots.len() - 1);
    let mut edges = vec![0.0];
    for ends in knots.windows(2) {
        edges.extend((1..=parts).map(|i| ends[0] + (ends[1] - ends[0]) * i as f64 / parts as f64));
    }
    edges
}
