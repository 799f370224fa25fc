//! The static description of a format, which is in the module of the format.

use std::path::{Path, PathBuf};

use lobe_table::{Channels, Kind, Scatter};

use lobe_files::write_whole;

use crate::{Document, FormatError, Place, ReadOptions};

/// A file format: how it is recognised, read and written.
#[derive(Debug)]
pub struct FormatSpec {
    /// The name for people.
    pub name: &'static str,
    /// The word for it on the command line.
    pub word: &'static str,
    /// The usual extensions of files in the format, in lower case. They are never trusted; see [`sniff`](crate::sniff).
    pub extensions: &'static [&'static str],
    /// `true` if the content looks like this format. Formats later in the registry may look alike.
    pub matches: fn(&[u8]) -> bool,
    /// Reads the content of a file; the path names it in errors. `None` if the format is only written.
    pub read: Option<Read>,
    /// Reads the files of a folder as one material, for formats with one incident direction per file.
    pub read_set: Option<ReadSet>,
    /// The writer; `None` if the format is only read.
    pub writer: Option<Writer>,
}

/// Makes a document from the content of a file; the path names it in errors. Readers use only the options for what
/// their format leaves open: quantities and scales are applied to the result, except for tables with named columns.
pub type Read = fn(&[u8], &Path, &ReadOptions) -> Result<Document, FormatError>;

/// Makes a document from several files, each with the path that names it in errors.
pub type ReadSet = fn(&[(PathBuf, Vec<u8>)]) -> Result<Document, FormatError>;

/// The writer of a format.
#[derive(Debug)]
pub struct Writer {
    /// Extensions of the files, in lower case.
    pub extensions: &'static [&'static str],
    /// `true` if the format supports these channels.
    pub holds_channels: fn(&Channels) -> bool,
    /// The channels that it supports, described for people.
    pub channels: &'static str,
    /// `true` if the format has the representation of a document, so that nothing has to be resampled.
    pub holds: fn(&Document) -> bool,
    /// `true` if one file can hold several measurements of a sheet.
    pub holds_sheets: bool,
    /// The only scatter that a file with this name can hold, if there is one.
    pub scatter: fn(&Path) -> Option<Scatter>,
    /// The representation into which other data are resampled; if that is impossible, the contents of a file, in words.
    pub resampled_as: Result<Kind, &'static str>,
    /// Writes the file whole or not at all.
    pub write: fn(&Document, &Path) -> Result<(), FormatError>,
}

/// For formats whose files may hold either scatter.
pub(crate) fn either(_: &Path) -> Option<Scatter> {
    None
}

/// For formats whose files hold only reflection.
pub(crate) fn reflection(_: &Path) -> Option<Scatter> {
    Some(Scatter::Reflection)
}

/// An error for a document that the format cannot hold.
pub(crate) fn unfit(document: &Document, path: &Path, expected: &'static str) -> FormatError {
    let found = match document.only() {
        Some(data) => data.representation().kind().name(),
        None => "several measurements of a sheet",
    };
    FormatError::new(path, Place::File, found, expected)
}

/// The name of the fact that says how a file was resampled, and gives its error.
pub const RESAMPLED: &str = "resampled";

/// A description of how a file was resampled, on one line.
pub(crate) fn resampled(document: &Document) -> Option<String> {
    let (name, value) = document.source.iter().find(|(name, _)| name == RESAMPLED)?;
    Some(format!("{name} {}", value.split_whitespace().collect::<Vec<_>>().join(" ")))
}

/// Writes a text whose first line is a comment that says how it was resampled.
pub(crate) fn commented(
    mark: &str,
    document: &Document,
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), FormatError>,
) -> Result<(), FormatError> {
    write(path)?;
    let Some(resampled) = resampled(document) else { return Ok(()) };
    let mut bytes = format!("{mark} {resampled}\n").into_bytes();
    bytes.extend_from_slice(&lobe_files::read(path)?);
    write_whole(path, &bytes)
}
