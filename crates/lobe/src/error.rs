//! Errors: a material could not be opened, or slices do not fit together.

use std::path::{Path, PathBuf};

use lobe_formats::FormatError;
use lobe_table::PrepareError;
use thiserror::Error;

use crate::BackendError;

/// Why a material could not be opened.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The file cannot be read.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The file was read but is not a material: it has only mirror reflectances, or parts that do not fit together.
    #[error("{}found {found}; expected {expected}", before(.file))]
    NotAMaterial {
        /// The file, if there is one.
        file: Option<PathBuf>,
        /// What was found.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// The data have no values for pairs of directions, or are too large.
    #[error("{}{source}", before(.file))]
    Data {
        /// The file, if there is one.
        file: Option<PathBuf>,
        /// What is wrong with them.
        source: PrepareError,
    },
    /// `LOBE_BACKEND` does not name a backend of this machine.
    #[error(transparent)]
    Backend(#[from] BackendError),
}

fn before(file: &Option<PathBuf>) -> String {
    file.as_ref().map(|file| format!("{}: ", file.display())).unwrap_or_default()
}

impl From<PrepareError> for OpenError {
    fn from(source: PrepareError) -> Self {
        OpenError::Data { file: None, source }
    }
}

impl OpenError {
    pub(crate) fn not_a_material(found: impl Into<String>) -> Self {
        OpenError::NotAMaterial { file: None, found: found.into(), expected: "a BRDF or BTDF" }
    }

    /// The same error, with the file that the document or the data came from.
    pub fn in_file(mut self, path: &Path) -> Self {
        match &mut self {
            OpenError::NotAMaterial { file, .. } | OpenError::Data { file, .. } => *file = Some(path.into()),
            // These errors name their source themselves.
            OpenError::Format(_) | OpenError::Backend(_) => {}
        }
        self
    }
}

/// Slices that do not fit together.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("found {found} {what}; expected {expected}")]
#[non_exhaustive]
pub struct ShapeError {
    /// The name of what is counted, such as `values`.
    pub what: &'static str,
    /// The number that was found.
    pub found: usize,
    /// The expected number.
    pub expected: usize,
}

/// Checks a count.
pub(crate) fn expect(what: &'static str, found: usize, expected: usize) -> Result<(), ShapeError> {
    if found == expected { Ok(()) } else { Err(ShapeError { what, found, expected }) }
}

/// The value, or a panic with a message that says what does not fit.
#[track_caller]
pub(crate) fn fitting<T>(result: Result<T, ShapeError>) -> T {
    match result {
        Ok(value) => value,
        Err(error) => panic!("{error}"),
    }
}
