//! The XML files of WINDOW and Radiance: Klems matrices and tensor trees of shading and glazing layers.
//!
//! A file has up to four blocks (transmission and reflection, front and back) in any number of wavelength bands:
//! `Visible`, `Solar`, `NIR`, `CIE-X`, `CIE-Z`, `CIE-u`, `CIE-v` and others. All bands are kept by their names. Values
//! are `f` in 1/sr, without the cosine, as the file has them: a minimum is not split off and nothing is dropped.

mod basis;
mod document;
mod tree;
mod write;

use std::path::Path;

use lobe_table::window;

use crate::FormatError;

pub use write::write;

/// What a file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WindowXml {
    /// Name of the layer; may be empty.
    pub name: String,
    /// Its manufacturer; may be empty.
    pub manufacturer: String,
    /// The blocks by band of wavelengths, in the order of the file. No two bands have names that differ in case only.
    pub bands: Vec<Band>,
}

/// The blocks of one band of wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// The name in the file, such as `Visible`, or a wavelength in nm.
    pub wavelength: String,
    /// The values.
    pub window: window::Blocks,
}

impl WindowXml {
    /// The values of a band by its name, in any case.
    pub fn band(&self, wavelength: &str) -> Option<&window::Blocks> {
        self.bands.iter().find(|band| band.wavelength.eq_ignore_ascii_case(wavelength)).map(|band| &band.window)
    }
}

/// `true` where the file starts like one of these; lines before the XML are let pass, which real files have.
pub fn matches(bytes: &[u8]) -> bool {
    const HEAD: usize = 16 * 1024;
    document::decode(&bytes[..bytes.len().min(HEAD)]).contains("<WindowElement")
}

/// Reads a file. `file` only names it in errors.
///
/// # Errors
/// [`FormatError`] with the line: XML that is not well-formed or cut off, an unknown basis or direction, a count of
/// values that does not fit the basis, braces that make no tree, and values that are no finite numbers.
pub fn read(bytes: &[u8], file: &Path) -> Result<WindowXml, FormatError> {
    document::Document::parse(&document::decode(bytes), file)
}
