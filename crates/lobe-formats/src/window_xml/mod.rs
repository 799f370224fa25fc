//! The XML files of WINDOW and Radiance: Klems matrices and tensor trees of shading and glazing layers.
//!
//! A file has up to four blocks (transmission and reflection, front and back) in any number of wavelength bands:
//! `Visible`, `Solar`, `NIR`, `CIE-X`, `CIE-Z`, `CIE-u`, `CIE-v` and others. All bands are kept under their names.
//! Values are `f` in 1/sr, without the cosine, as in the file: no minimum is split off and nothing is dropped.

mod basis;
mod document;
mod tree;
mod words;
mod write;

use std::path::Path;

use lobe_table::window::{self, klems};
use lobe_table::{Channels, Data};

use crate::spec::{FormatSpec, Writer, either, unfit};
use crate::{Document, FormatError, Measured};

pub use write::write;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "WINDOW XML",
    word: "klems",
    extensions: &["xml"],
    matches,
    read: Some(|bytes, path, _| {
        let parsed = document::Document::parse(&document::decode(bytes), path)?;
        Ok(Document { kept: parsed.kept, ..parsed.measured.into() })
    }),
    read_set: None,
    writer: Some(Writer {
        extensions: &["xml"],
        holds_channels: |channels| matches!(channels, Channels::Mono | Channels::Xyz | Channels::Named(_)),
        channels: "one channel, X Y Z or named bands, or averages of wavelengths from 400 to 700 nm and beyond",
        holds: |document| matches!(document.only(), Some(Data::Window(_))),
        holds_sheets: true,
        scatter: either,
        resampled_as: Ok(klems::KIND),
        write: |document, path| match document.only() {
            Some(Data::Window(data)) => write::write_with(data, &document.source, &document.kept, path),
            _ => Err(unfit(document, path, "Klems matrices or tensor trees")),
        },
    }),
};

/// `true` if the file starts like one of these; lines before the XML, which occur in real files, are skipped.
pub fn matches(bytes: &[u8]) -> bool {
    const HEAD: usize = 16 * 1024;
    document::decode(&bytes[..bytes.len().min(HEAD)]).contains("<WindowElement")
}

/// Reads a file; the name of the layer and of its manufacturer are header facts. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: XML that is not well-formed or cut off, an unknown basis or direction, a number of
/// values that does not match the basis, braces that do not form a tree, and values that are not finite numbers.
pub fn read(bytes: &[u8], file: &Path) -> Result<Measured<window::Data>, FormatError> {
    Ok(document::Document::parse(&document::decode(bytes), file)?.measured)
}
