//! MERL `.binary` files: isotropic RGB materials in half and difference angles.
//!
//! Little-endian: the numbers of bins of `theta_h`, `theta_d` and `phi_d` as `i32`, 90, 90 and 180 in the database and
//! 360 for `phi_d` in its relatives that are not reciprocal; then one `f64` a bin for red, green and blue, one channel
//! after the other, `phi_d` fastest. `f` in 1/sr is the stored number times 1/1500, 1.15/1500, 1.66/1500.

use crate::Document;
use crate::bytes::Cursor;
use crate::spec::{FormatSpec, Writer, reflection, unfit};
use lobe_files::FormatError;
use lobe_files::{unwritable, write_whole};
use lobe_table::{Channels, Data, half_diff};
use std::io;
use std::path::Path;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "MERL",
    word: "merl",
    extensions: &["binary"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?))),
    writer: Some(Writer {
        extensions: &["binary"],
        holds_channels: |channels| matches!(channels, Channels::Rgb),
        channels: "R G B",
        holds: |document| matches!(document.only(), Some(Data::HalfDiff(_))),
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Ok(half_diff::KIND),
        write: |document, path| match document.only() {
            Some(Data::HalfDiff(data)) => write(data, path),
            _ => Err(unfit(document, path, "a grid of half and difference angles")),
        },
    }),
};

/// What red, green and blue are multiplied by.
const SCALE: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
const HEADER: usize = 12;

/// The three dimensions in the header, and the size of a file that has them.
fn header(bytes: &[u8]) -> Option<([usize; 3], usize)> {
    let (dims, _) = bytes.get(..HEADER)?.as_chunks();
    let dims = [0, 1, 2].map(|axis| i32::from_le_bytes(dims[axis]));
    let mut bins = [0; 3];
    let mut size = 3 * size_of::<f64>();
    for (bin, dim) in bins.iter_mut().zip(dims) {
        *bin = usize::try_from(dim).ok().filter(|dim| *dim > 0)?;
        size = size.checked_mul(*bin)?;
    }
    Some((bins, size.checked_add(HEADER)?))
}

/// Whether the size of the file is the one that its header implies. There is no signature.
pub fn matches(bytes: &[u8]) -> bool {
    header(bytes).is_some_and(|(_, size)| size == bytes.len())
}

/// Reads a MERL material.
///
/// # Errors
/// [`FormatError`] if the size of the file does not follow from its header or a value is not finite.
pub fn read(bytes: &[u8], file: &Path) -> Result<half_diff::Data, FormatError> {
    let mut cursor = Cursor::new(bytes, file);
    let Some((bins, size)) = header(bytes) else {
        let start = &bytes[..bytes.len().min(HEADER)];
        return Err(cursor.error(format!("the header {start:?}"), "three positive dimensions as 32-bit integers"));
    };
    if size != bytes.len() {
        return Err(cursor.error(format!("{bins:?} bins in {} bytes", bytes.len()), format!("a file of {size} bytes")));
    }
    cursor.at = HEADER;
    let plane = bins.iter().product();
    let (stored, _) = cursor.rest().as_chunks();
    let mut values = Vec::with_capacity(3 * plane);
    for (channel, scale) in stored.chunks_exact(plane).zip(SCALE) {
        for bytes in channel {
            let value = f64::from_le_bytes(*bytes);
            if !value.is_finite() || (value * scale).abs() > f64::from(f32::MAX) {
                cursor.at += values.len() * size_of::<f64>();
                return Err(cursor.error(format!("{value}"), "a finite number"));
            }
            values.push((value * scale) as f32);
        }
    }
    half_diff::Data::new(bins, values).map_err(|invalid| cursor.error(invalid.found, invalid.expected))
}

/// The bytes of a MERL file.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] if a dimension does not fit into `i32`.
pub fn to_bytes(material: &half_diff::Data) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(HEADER + size_of::<f64>() * material.values().len());
    for bins in material.bins() {
        let bins = i32::try_from(bins).map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
        bytes.extend_from_slice(&bins.to_le_bytes());
    }
    let plane = material.bins().iter().product();
    for (channel, scale) in material.values().chunks_exact(plane).zip(SCALE) {
        channel.iter().for_each(|value| bytes.extend_from_slice(&(f64::from(*value) / scale).to_le_bytes()));
    }
    Ok(bytes)
}

/// Writes a MERL file, replacing what was there at once.
///
/// # Errors
/// [`FormatError`] as [`to_bytes`], and if the file system refuses.
pub fn write(material: &half_diff::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(material).map_err(|error| unwritable(path, &error))?)
}
