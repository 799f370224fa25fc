//! The content of a material, from which a copy can be made in another process.

use std::path::PathBuf;
use std::time::SystemTime;

use lobe::{Channels, Data};
use lobe_formats::{Document, ReadOptions};
use lobe_ops::Subject;
use numpy::prelude::*;
use numpy::{PyArray1, PyArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

use crate::labels::{channels, scatter};
use crate::options::{Choices, reading_keywords};
use crate::scattered::Scattered;

/// The source of the values of a material.
pub enum Content {
    /// A file, in the state in which it was read.
    File {
        /// Its path.
        path: PathBuf,
        /// Its size and time.
        version: Version,
        /// Facts missing in the file, including those from its sidecar.
        reading: ReadOptions,
    },
    /// Bytes in memory.
    Bytes {
        /// The bytes of the file.
        bytes: Py<PyBytes>,
        /// The name of the file.
        name: PathBuf,
        /// Facts missing in the file.
        reading: ReadOptions,
    },
    /// The data themselves.
    Data,
    /// Scattered samples, as they were given.
    Scattered(Scattered),
}

/// The version of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Version {
    size: u64,
    modified: Option<SystemTime>,
}

impl Version {
    /// The current version of a file.
    ///
    /// # Errors
    /// If there is no such file.
    pub fn of(path: &std::path::Path) -> std::io::Result<Self> {
        let metadata = path.metadata()?;
        Ok(Version { size: metadata.len(), modified: metadata.modified().ok() })
    }
}

/// How to recreate an object: a function and its arguments.
pub type Reduced<'py> = (Bound<'py, PyAny>, Arguments<'py>);

/// The kind of content, and keyword arguments.
pub type Arguments<'py> = (&'static str, Bound<'py, PyDict>);

/// The function of `lobe_bsdf` that recreates the material, and its keyword arguments.
///
/// # Errors
/// If the file of the material has changed, or is a folder.
pub fn remake<'py>(
    py: Python<'py>,
    content: &Content,
    subject: &Subject,
    choices: &Choices,
) -> PyResult<Arguments<'py>> {
    let keywords = PyDict::new(py);
    choices.keywords(&keywords)?;
    match content {
        Content::File { path, version, reading } => {
            let unread = |why: String| {
                PyValueError::new_err(format!(
                    "{}: {why}; expected the file from which the material was read, because pickling refers to it",
                    path.display()
                ))
            };
            if path.is_dir() {
                return Err(unread("found a folder".into()));
            }
            if Version::of(path).map_err(|error| unread(error.to_string()))? != *version {
                return Err(unread("found a file that has changed since".into()));
            }
            let bytes = lobe_files::read(path).map_err(|error| unread(error.to_string()))?;
            keywords.set_item("data", PyBytes::new(py, &bytes))?;
            keywords.set_item("name", path.as_os_str())?;
            reading_keywords(reading, &keywords)?;
            Ok(("from_bytes", keywords))
        }
        Content::Bytes { bytes, name, reading } => {
            keywords.set_item("data", bytes)?;
            keywords.set_item("name", name.as_os_str())?;
            reading_keywords(reading, &keywords)?;
            Ok(("from_bytes", keywords))
        }
        Content::Data | Content::Scattered(_) => {
            match content {
                Content::Scattered(samples) => samples.arrays(py, &keywords)?,
                _ => {
                    let known = arrays(py, &subject.document, &keywords)?;
                    known.then_some(()).ok_or_else(|| PyValueError::new_err("found data that are not arrays"))?;
                }
            }
            let facts = PyTuple::new(py, subject.document.source.iter().map(|(name, value)| (name, value)))?;
            keywords.set_item("facts", facts)?;
            Ok(("from_samples", keywords))
        }
    }
}

/// The data as the arguments of `from_samples`; `false` if they are neither a grid of four angles nor scattered
/// samples.
///
/// # Errors
/// If there is not enough memory.
pub fn arrays(py: Python<'_>, document: &Document, into: &Bound<'_, PyDict>) -> PyResult<bool> {
    match document.only() {
        Some(Data::Specular(table)) => {
            let names = lobe_table::specular::AXIS_NAMES;
            grid(py, names, table.knots(), table.channels(), table.values(), into)?;
            if let Some(offsets) = table.refraction() {
                into.set_item("refraction", PyArray1::from_slice(py, offsets))?;
            }
            scatter(table.scatter(), into)?;
        }
        Some(Data::Spherical(table)) if !table.is_mirrored() => {
            let names = lobe_table::spherical::AXIS_NAMES;
            grid(py, names, table.knots(), table.channels(), table.values(), into)?;
            scatter(table.scatter(), into)?;
        }
        Some(Data::Scattered(samples)) => {
            let count = samples.channels().count();
            let (mut angles, mut values) = (Vec::new(), Vec::new());
            for (of_sample, texel) in samples.samples() {
                angles.push(of_sample);
                values.extend_from_slice(texel);
            }
            for (axis, name) in lobe_table::spherical::AXIS_NAMES.into_iter().enumerate() {
                let angles: Vec<f64> = angles.iter().map(|angles| angles[axis]).collect();
                into.set_item(name, PyArray1::from_vec(py, angles))?;
            }
            into.set_item("values", PyArray1::from_vec(py, values).reshape([angles.len(), count])?)?;
            channels(py, samples.channels(), into)?;
            scatter(samples.scatter(), into)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}

fn grid(
    py: Python<'_>,
    names: [&str; 4],
    knots: &[Vec<f64>; 4],
    of: &Channels,
    values: &[f32],
    into: &Bound<'_, PyDict>,
) -> PyResult<()> {
    for (name, knots) in names.into_iter().zip(knots) {
        into.set_item(name, PyArray1::from_slice(py, knots))?;
    }
    let shape: Vec<usize> = knots.iter().map(Vec::len).chain([of.count()]).collect();
    let values: Bound<'_, PyArrayDyn<f32>> = PyArray1::from_slice(py, values).reshape(shape)?;
    into.set_item("values", values)?;
    channels(py, of, into)
}
