//! One error for every reader: which file, where in it, what was found, what was expected.

use std::fmt;
use std::path::{Path, PathBuf};

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line of a text file, counted from 1.
    Line(usize),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
}

/// Why a file could not be read.
///
/// Prints as `FILE:LINE: found X; expected Y` (`FILE: byte N: ...` in binary files).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct FormatError {
    /// The file, as the caller named it.
    pub file: PathBuf,
    /// Where in the file.
    pub place: Place,
    /// What was found there.
    pub found: String,
    /// What the format requires there.
    pub expected: String,
}

impl FormatError {
    /// An error at `place` of `file`.
    pub fn new(file: &Path, place: Place, found: impl Into<String>, expected: impl Into<String>) -> Self {
        FormatError { file: file.into(), place, found: found.into(), expected: expected.into() }
    }
}

impl fmt::Display for FormatError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let FormatError { file, place, found, expected } = self;
        write!(f, "{}", file.display())?;
        match place {
            Place::File => write!(f, ": ")?,
            Place::Line(line) => write!(f, ":{line}: ")?,
            Place::Byte(byte) => write!(f, ": byte {byte}: ")?,
        }
        write!(f, "found {found}; expected {expected}")
    }
}
