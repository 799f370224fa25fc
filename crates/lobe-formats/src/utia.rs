//! UTIA `.bin` files: anisotropic RGB materials on the uniform grid of the UTIA database.
//!
//! No header: 3 x 288 x 288 little-endian `f64`, `[channel][theta_i][phi_i][theta_v][phi_v]`, 1,990,656 bytes.

use crate::Document;
use crate::bytes::Cursor;
use crate::merl::grouped;
use crate::spec::{FormatSpec, Writer, reflection, unfit};
use lobe_files::{Content, FormatError, write_whole};
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
        let unit = ("unit", "not documented; values are as stored");
        Ok(Document::new(read(bytes, path)?).with_source(&[unit]))
    }),
    read_set: None,
    writer: Some(Writer {
        extensions: &["bin"],
        holds_channels: |channels| matches!(channels, Channels::Rgb),
        channels: "R G B",
        holds: |document| matches!(document.only(), Some(Data::Utia(_))),
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Ok(utia::KIND),
        write: |document, path| match document.only() {
            Some(Data::Utia(data)) => write(data, path),
            _ => Err(unfit(document, path, "the grid of the UTIA database")),
        },
    }),
};

const SIZE: usize = 3 * PLANE * size_of::<f64>();

/// `true` if the file has the size of a UTIA file, which is the only way to recognise it.
pub fn matches(bytes: &[u8]) -> bool {
    bytes.len() == SIZE
}

/// Describes a file that may be in this format but has another size: the format has no signature, only an extension and
/// 64-bit numbers in the range of values.
pub(crate) fn damaged(bytes: &[u8], name: &Path) -> Option<Content> {
    const LOOKED_AT: usize = 4096;
    let is_named = name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("bin"));
    let (numbers, _) = bytes.as_chunks();
    let is_value = |bytes: &[u8; 8]| {
        let value = f64::from_le_bytes(*bytes).abs();
        value == 0.0 || (1e-9..1e6).contains(&value)
    };
    let values = numbers.iter().take(LOOKED_AT).filter(|bytes| is_value(bytes)).count();
    if !is_named || values < 2 || values * 10 < numbers.len().min(LOOKED_AT) * 9 {
        return None;
    }
    let how = if bytes.len() < SIZE { "cut short" } else { "with more bytes" };
    Some(Content {
        what: format!("possibly a UTIA file {how} ({} of {} bytes)", grouped(bytes.len()), grouped(SIZE)),
        advice: "If it is, fetch the file again; other files of numbers need names of columns (CSV)".into(),
    })
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

/// Writes a UTIA file, replacing an existing one atomically.
///
/// # Errors
/// [`FormatError`] if the file system refuses.
pub fn write(material: &utia::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(material))
}
