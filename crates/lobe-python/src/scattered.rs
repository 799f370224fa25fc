//! Scattered samples, as they were given.

use lobe::{Channels, Scatter};
use numpy::prelude::*;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::labels::{channels, scatter};

/// Scattered samples as they were given.
#[derive(Clone, Debug)]
pub struct Scattered {
    pub scatter: Scatter,
    pub channels: Channels,
    /// `theta_i`, `phi_i`, `theta_o`, `phi_o` of each sample, in radians.
    pub angles: Vec<[f64; 4]>,
    /// `[sample][channel]`.
    pub values: Vec<f32>,
}

impl Scattered {
    /// The arguments of `from_samples`.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn arrays(&self, py: Python<'_>, into: &Bound<'_, PyDict>) -> PyResult<()> {
        for (axis, name) in lobe_table::spherical::AXIS_NAMES.into_iter().enumerate() {
            let angles: Vec<f64> = self.angles.iter().map(|angles| angles[axis]).collect();
            into.set_item(name, PyArray1::from_vec(py, angles))?;
        }
        let values: Bound<'_, PyArray2<f32>> =
            PyArray1::from_slice(py, &self.values).reshape([self.angles.len(), self.channels.count()])?;
        into.set_item("values", values)?;
        channels(py, &self.channels, into)?;
        scatter(self.scatter, into)
    }
}
