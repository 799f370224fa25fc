//! What a file holds: the data, and what the file says about them.

use std::path::Path;

use lobe_table::{Samples, Scatter};

use crate::{Format, FormatError, Place, Specular, ddr, sdr, sniff, zemax};

/// The content of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured<T> {
    /// The data.
    pub data: T,
    /// Names and values of the header in the order of the file, for people to read. Comments have the name `comment`.
    /// What became part of the data (knots, channels) is left out.
    pub source: Vec<(String, String)>,
    /// Total integrated scatter, the hemispherical integral of `f cos`, as the file states it for each block of its
    /// data, in the order of the file. Empty where it states none. Nothing is computed from it.
    pub tis: Vec<f32>,
}

/// What was found in a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Document {
    /// A BRDF or BTDF on a grid of specular coordinates.
    Table(Measured<Samples>),
    /// The mirror reflectance, or the transmittance straight through, of a smooth surface.
    Specular(Measured<Specular>),
}

/// Reads a file of any supported format, which is told from the content. Only formats that do not say whether they hold
/// reflection or transmission are asked for their extension: `.ddt` and `.sdt` are transmission, others reflection.
///
/// # Errors
/// [`FormatError`] where the file cannot be read, is of no known format, or is damaged.
pub fn open(path: &Path) -> Result<(Format, Document), FormatError> {
    let bytes = std::fs::read(path)
        .map_err(|error| FormatError::new(path, Place::File, error.to_string(), "a file that can be read"))?;
    let format = sniff(&bytes).ok_or_else(|| {
        let known: Vec<&str> = Format::ALL.iter().map(Format::name).collect();
        FormatError::new(path, Place::File, "content of no known format", format!("one of {}", known.join(", ")))
    })?;
    let document = match format {
        Format::Ddr => Document::Table(ddr::read(&bytes, path, scatter_of_extension(path))?),
        Format::Sdr => Document::Specular(sdr::read(&bytes, path, scatter_of_extension(path))?),
        Format::Zemax => Document::Table(zemax::read(&bytes, path)?),
    };
    Ok((format, document))
}

/// Integra's extensions: a `t` at the end is transmission.
pub(crate) fn scatter_of_extension(path: &Path) -> Scatter {
    let is = |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
    if is("ddt") || is("sdt") { Scatter::Transmission } else { Scatter::Reflection }
}
