//! Lines of text formats in which each line is a record.

use std::path::Path;

use crate::{FormatError, Place};

/// A line that is not empty.
#[derive(Clone, Copy)]
pub(crate) struct Line<'a> {
    file: &'a Path,
    /// Counted from 1.
    pub number: usize,
    /// The text without white space at its ends.
    pub text: &'a str,
}

/// The lines of `text` that have more than white space, with any line ends.
pub(crate) fn lines<'a>(file: &'a Path, text: &'a str) -> impl Iterator<Item = Line<'a>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let line = move |(index, text): (usize, &'a str)| Line { file, number: index + 1, text: text.trim() };
    text.lines().enumerate().map(line).filter(|line| !line.text.is_empty())
}

impl<'a> Line<'a> {
    /// The words between white space and commas.
    pub(crate) fn words(&self) -> impl Iterator<Item = &'a str> {
        self.text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty())
    }

    /// All words as finite numbers.
    pub(crate) fn numbers(&self) -> Result<Vec<f64>, FormatError> {
        self.words().map(|word| self.number(word)).collect()
    }

    /// All words as exactly `N` finite numbers.
    pub(crate) fn exactly<const N: usize>(&self, expected: &str) -> Result<[f64; N], FormatError> {
        let numbers = self.numbers()?;
        let count = numbers.len();
        numbers.try_into().map_err(|_| self.error(format!("{count} numbers"), expected))
    }

    /// A word as a finite number.
    pub(crate) fn number(&self, word: &str) -> Result<f64, FormatError> {
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| self.error(shown(word), "a finite number"))
    }

    /// An error about this line.
    pub(crate) fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        FormatError::new(self.file, Place::Line(self.number), found, expected)
    }
}

/// Words from a file as an error shows them: quoted and cut short.
pub(crate) fn shown(words: &str) -> String {
    format!("\"{}\"", lobe_files::excerpt(words, 40))
}
