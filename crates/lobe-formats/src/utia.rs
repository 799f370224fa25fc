//! UTIA `.bin` files: anisotropic RGB materials on the uniform grid of the UTIA database.
//!
//! No header: 3 x 288 x 288 little-endian `f64`, `[channel][theta_i][phi_i][theta_v][phi_v]`, 1,990,656 bytes.

use crate::Document;
use crate::bytes::Cursor;
use crate::spec::{FormatSpec, Writer, reflection, unfit};
use lobe_files::FormatError;
use lobe_files::write_whole;
use lobe_table::utia::{self, PLANE};
use lobe_table::{Channels, Data};
use std::path::Path;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "UTIA",
    word: "utia",
    extensions: &["bin"],
    matches,
    read: Some(|bytes, path, _| {
        let unit = ("unit", "not documented; values are as they are stored");
        Ok(Document::new(read(bytes, path)?).with_source(&[unit]))
    }),
    writer: Some(Writer {
        extensions: &["bin"],
        holds_channels: |channels| matches!(channels, Channels::Rgb),
        channels: "R G B",
        holds: |document| matches!(document.only(), Some(Data::Utia(_))),
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Err("the grid of the UTIA database"),
        write: |document, path| match document.only() {
            Some(Data::Utia(data)) => write(data, path),
            _ => Err(unfit(document, path, "the grid of the UTIA database")),
        },
    }),
};

const SIZE: usize = 3 * PLANE * size_of::<f64>();

/// Whether the file has the size of a UTIA file, which is the only way to recognise it.
pub fn matches(bytes: &[u8]) -> bool {
    bytes.len() == SIZE
}

/// Reads a UTIA material.
///
/// # Errors
/// [`FormatError`] if the size of the file is wrong or a value is not finite.
pub fn read(bytes: &[u8], file: &Path) -> Result<utia::Data, FormatError> {
    let mut cursor = Cursor::new(bytes, file);
    if !matches(bytes) {
        return Err(cursor.error(format!("{} bytes", bytes.len()), format!("{SIZE} bytes")));
    }
    let (stored, _) = bytes.as_chunks();
    let values: Vec<f64> = stored.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    if let Some(at) = values.iter().position(|value| !value.is_finite()) {
        cursor.at = at * size_of::<f64>();
        return Err(cursor.error(format!("{}", values[at]), "a finite number"));
    }
    utia::Data::new(values).map_err(|invalid| cursor.error(invalid.found, invalid.expected))
}

/// The bytes of a UTIA file.
pub fn to_bytes(material: &utia::Data) -> Vec<u8> {
    material.values().iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Writes a UTIA file, replacing what was there at once.
///
/// # Errors
/// [`FormatError`] if the file system refuses.
pub fn write(material: &utia::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(material))
}
