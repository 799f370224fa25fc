//! The meaning of values, as arguments of `from_samples`.

use lobe::{Channels, Scatter};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// The meaning of the channels, as arguments of `from_samples`.
///
/// # Errors
/// If there is not enough memory.
pub fn channels(py: Python<'_>, of: &Channels, into: &Bound<'_, PyDict>) -> PyResult<()> {
    match of {
        Channels::Spectral(wavelengths) => into.set_item("wavelengths", PyArray1::from_slice(py, wavelengths)),
        Channels::Mono => into.set_item("channels", "mono"),
        Channels::Rgb => into.set_item("channels", "rgb"),
        Channels::Xyz => into.set_item("channels", "xyz"),
        Channels::Named(names) => into.set_item("channels", PyTuple::new(py, names)?),
    }
}

/// The kind of scatter, as an argument of `from_samples`.
///
/// # Errors
/// If there is not enough memory.
pub fn scatter(scatter: Scatter, into: &Bound<'_, PyDict>) -> PyResult<()> {
    into.set_item("scatter", if scatter == Scatter::Reflection { "reflection" } else { "transmission" })
}
