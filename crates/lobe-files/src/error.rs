//! One error type for all readers: the file, the place in it, what was found, and what was expected.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::printable;

/// The place of an error in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line of a text file, counted from 1.
    Line(usize),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
}

/// A file could not be read.
///
/// Prints as `FILE:LINE: found X; expected Y` (`FILE: byte N: ...` in binary files), with control characters escaped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct FormatError {
    /// The file, as the caller named it.
    pub file: PathBuf,
    /// The place in the file.
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

/// Text from a file as an error shows it: control characters are escaped, and text longer than `most` characters is cut
/// and ends in dots.
pub fn excerpt(text: &str, most: usize) -> String {
    let mut shown: String = text.chars().take(most).flat_map(char::escape_debug).collect();
    if text.chars().nth(most).is_some() {
        shown.push_str("...");
    }
    shown
}

/// What was found and what was expected. If the error of a part already says what it expected, the expectation for the
/// whole is omitted.
pub fn sentence(found: &str, expected: &str) -> String {
    let found = found.strip_prefix("found ").unwrap_or(found);
    if found.contains("; expected ") { format!("found {found}") } else { format!("found {found}; expected {expected}") }
}

impl fmt::Display for FormatError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let FormatError { file, place, found, expected } = self;
        write!(f, "{}", printable(&file.display().to_string()))?;
        match place {
            Place::File => write!(f, ": ")?,
            Place::Line(line) => write!(f, ":{line}: ")?,
            Place::Byte(byte) => write!(f, ": byte {byte}: ")?,
        }
        f.write_str(&printable(&sentence(found, expected)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_text_is_cut_and_ends_in_dots() {
        assert_eq!(excerpt("a word", 6), "a word");
        assert_eq!(excerpt("a \u{1b}[31mword", 4), "a \\u{1b}[...");
    }

    #[test]
    fn expectations_are_stated_once() {
        let error = |found: &str| FormatError::new(Path::new("a"), Place::Line(2), found, "a table").to_string();
        assert_eq!(error("a word"), "a:2: found a word; expected a table");
        assert_eq!(error("found 3 knots; expected 4"), "a:2: found 3 knots; expected 4");
    }
}
