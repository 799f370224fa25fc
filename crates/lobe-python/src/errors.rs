//! Errors as exceptions, whose classes are in `lobe_bsdf/_errors.py`.

use std::path::Path;

use lobe::OpenError;
use lobe_formats::{FormatError, Place};
use lobe_ops::certificate::DraftError;
use lobe_render::scene::SceneError;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// An error that occurred while the lock of the interpreter was not held.
#[derive(Debug)]
pub enum Failure {
    /// A file cannot be read or written.
    Format(FormatError),
    /// A scene has a mistake.
    Scene(SceneError),
    /// An argument is invalid.
    Value(String),
}

impl Failure {
    /// Describes an error of an argument.
    pub fn value(message: impl std::fmt::Display) -> Self {
        Failure::Value(message.to_string())
    }
}

impl From<FormatError> for Failure {
    fn from(error: FormatError) -> Self {
        Failure::Format(error)
    }
}

impl From<OpenError> for Failure {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::Format(error) => Failure::Format(error),
            // The content of the file is not as expected.
            OpenError::NotAMaterial { file: Some(file), found, expected } => {
                Failure::Format(FormatError::new(&file, Place::File, found, expected))
            }
            other => Failure::Value(other.to_string()),
        }
    }
}

impl From<DraftError> for Failure {
    fn from(error: DraftError) -> Self {
        match error {
            DraftError::Write(error) => error.into(),
            DraftError::Read(error) => error.into(),
            other => Failure::value(other),
        }
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Value(message) => PyValueError::new_err(message),
            Failure::Format(error) => {
                let message = error.to_string();
                let FormatError { file, place, found, expected } = error;
                let (line, byte) = match place {
                    Place::File => (None, None),
                    Place::Line(line) => (Some(line), None),
                    Place::Byte(byte) => (None, Some(byte)),
                };
                made("FormatError", |py| {
                    (message, file.to_string_lossy(), line, byte, found, expected).into_pyobject(py)
                })
            }
            Failure::Scene(error) => {
                let message = error.to_string();
                let SceneError { file, line, key, .. } = error;
                made("SceneError", |py| (message, file.to_string_lossy(), line, key).into_pyobject(py))
            }
        }
    }
}

/// An exception of the package.
fn made(class: &str, arguments: impl for<'py> FnOnce(Python<'py>) -> PyResult<Bound<'py, PyTuple>>) -> PyErr {
    Python::attach(|py| {
        let class = py.import("lobe_bsdf._errors").and_then(|module| module.getattr(class));
        let made = class.and_then(|class| class.call1(arguments(py)?));
        made.map_or_else(|error| error, PyErr::from_value)
    })
}

/// The exception of the system for a file that is missing or must not be read, such as `FileNotFoundError`.
///
/// # Errors
/// If there is nothing to read.
pub fn check_readable(path: &Path) -> PyResult<()> {
    match std::fs::metadata(path) {
        Ok(_) => Ok(()),
        Err(error) => {
            let name = path.to_string_lossy().into_owned();
            match error.raw_os_error() {
                Some(code) => {
                    let text = error.to_string();
                    let text = text.split(" (os error").next().unwrap_or_default().to_owned();
                    Err(PyOSError::new_err((code, text, name)))
                }
                None => Err(PyOSError::new_err(format!("{name}: {error}"))),
            }
        }
    }
}
