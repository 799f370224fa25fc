//! MERL `.binary` files: isotropic RGB materials in half and difference angles.
//!
//! Little-endian: the numbers of bins of `theta_h`, `theta_d` and `phi_d` as `i32`, 90, 90 and 180 in the database and
//! 360 for `phi_d` in similar files of materials that are not reciprocal; then one `f64` per bin for red, green and
//! blue, one channel after the other, `phi_d` fastest. `f` in 1/sr is the stored number times 1/1500, 1.15/1500,
//! 1.66/1500.

use crate::Document;
use crate::bytes::Cursor;
use crate::spec::{FormatSpec, Writer, reflection, unfit};
use lobe_files::{Content, FormatError};
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
    read_set: None,
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

/// The factors of red, green and blue.
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

/// `true` if the size of the file is the one that its header implies. There is no signature.
pub fn matches(bytes: &[u8]) -> bool {
    header(bytes).is_some_and(|(_, size)| size == bytes.len())
}

/// Describes a file that looks like this format, but has a size other than its header implies, or another byte order.
pub(crate) fn damaged(bytes: &[u8], name: &Path) -> Option<Content> {
    const DATABASE: [[usize; 3]; 2] = [[90, 90, 180], [90, 90, 360]];
    /// No material has more bins along an axis.
    const MOST: usize = 4096;
    let (found, len) = (grouped(bytes.len()), bytes.len());
    let again = "The copy or download failed: fetch the file again";
    if (4..HEADER).contains(&len) && DATABASE[0].map(|dim| (dim as i32).to_le_bytes()).concat().starts_with(bytes) {
        let size = grouped(34_992_012);
        return Some(Content {
            what: format!("a MERL file cut short ({found} of {size} bytes)"),
            advice: again.into(),
        });
    }
    let is_named = name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("binary"));
    let is_likely = |bins: &[usize; 3]| bins.iter().all(|bins| *bins <= MOST) && (is_named || DATABASE.contains(bins));
    if let Some((bins, size)) = header(bytes).filter(|(bins, _)| bins.iter().all(|bins| *bins <= MOST)) {
        let values = (size - HEADER) / size_of::<f64>();
        if len == HEADER + values * size_of::<f32>() && are_single(&bytes[HEADER..]) {
            let what = format!("a MERL file with values of 32 bits ({found} bytes instead of {})", grouped(size));
            let advice =
                "The database has values of 64 bits, and the scale of others is not known: write the values as f64";
            return Some(Content { what, advice: advice.into() });
        }
        if is_likely(&bins) {
            let how = if len < size { "cut short" } else { "with more bytes than its header states" };
            let what = format!("a MERL file {how} ({found} of {} bytes)", grouped(size));
            return Some(Content { what, advice: again.into() });
        }
    }
    let swapped: Vec<u8> = bytes.get(..HEADER)?.chunks_exact(4).flat_map(|word| word.iter().rev().copied()).collect();
    let (bins, size) = header(&swapped)?;
    if bins.iter().any(|bins| *bins > MOST) || !(size == len || is_likely(&bins)) {
        return None;
    }
    let cut = if size == len { String::new() } else { format!(", {found} of {} bytes", grouped(size)) };
    let what = format!("a MERL file in big-endian order{cut}");
    let advice =
        "Reverse the bytes of its 32-bit header and of its 64-bit values; files of the database are little-endian";
    Some(Content { what, advice: advice.into() })
}

/// `true` if these are values of 32 bits, and not the first half of a file of 64-bit values: as 32-bit values, these
/// have arbitrary magnitudes every other time, or zeros if they are round numbers.
fn are_single(values: &[u8]) -> bool {
    const SAMPLE: usize = 1 << 16;
    let (words, _) = values[..values.len().min(SAMPLE)].as_chunks();
    let words: Vec<f32> = words.iter().map(|word| f32::from_le_bytes(*word)).collect();
    let is_likely = |value: &&f32| **value == 0.0 || (1e-9..1e9).contains(&value.abs());
    let likely = words.iter().filter(is_likely).count();
    20 * likely >= 19 * words.len() && words.iter().step_by(2).any(|value| *value != 0.0)
}

/// A number with commas between thousands.
pub(crate) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut out = String::new();
    for (at, digit) in digits.char_indices() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
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

/// Writes a MERL file, replacing an existing one atomically.
///
/// # Errors
/// [`FormatError`] as [`to_bytes`], and if the file system refuses.
pub fn write(material: &half_diff::Data, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(material).map_err(|error| unwritable(path, &error))?)
}
