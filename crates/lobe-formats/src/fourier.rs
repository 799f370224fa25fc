//! Fourier BSDFs of pbrt-v3 and layerlab: `SCATFUN` files, isotropic and without textures.
//!
//! Little-endian: the signature `SCATFUN` and a byte, version 1; then 32-bit integers: flags and the numbers of cosines
//! (n), of coefficients, of those of the longest series, of channels, of bases, of bytes of metadata, of parameters and
//! of their values; the relative refractive index as `f32`, and four more floats. Then n cosines, n x n numbers for
//! sampling, which are ignored, n x n pairs of the index and the number of the coefficients of a series, the
//! coefficients, and metadata.

use std::path::Path;

use lobe_table::Channels;
use lobe_table::fourier::{Data, Parts, Series};

use crate::bytes::Cursor;
use crate::spec::FormatSpec;
use crate::{Document, FormatError};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "Fourier BSDF",
    word: "fourier",
    extensions: &["bsdf"],
    matches,
    read: Some(|bytes, path, _| read(bytes, path)),
    read_set: None,
    writer: None,
};

const SIGNATURE: &[u8] = b"SCATFUN";
/// Flags: the file holds a BSDF; series are extrapolated.
const IS_BSDF: i32 = 1;
const EXTRAPOLATES: i32 = 2;

/// `true` for the signature.
pub fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(SIGNATURE)
}

/// Reads a file. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the byte: another version, textures (several bases), harmonic extrapolation, a number of
/// channels other than one or three, counts for which the file is too short, bytes that are left over, and anything
/// that [`Data::new`] refuses.
pub fn read(bytes: &[u8], file: &Path) -> Result<Document, FormatError> {
    let mut cursor = Cursor::new(bytes, file);
    cursor.signature(SIGNATURE, "SCATFUN")?;
    let [version] = cursor.array("the version")?;
    if version != 1 {
        cursor.at -= 1;
        return Err(cursor.error(format!("version {version}"), "version 1"));
    }
    let flags = integer(&mut cursor, "flags")?;
    if flags & EXTRAPOLATES != 0 || flags & IS_BSDF == 0 {
        cursor.at -= 4;
        let expected = "1: a BSDF without harmonic extrapolation";
        return Err(cursor.error(format!("flags {flags}"), expected));
    }
    let knots = count(&mut cursor, "cosines")?;
    let coefficients = count(&mut cursor, "coefficients")?;
    count(&mut cursor, "coefficients of the longest series")?;
    let channels = match integer(&mut cursor, "the number of channels")? {
        1 => Channels::Mono,
        3 => Channels::Rgb,
        other => {
            cursor.at -= 4;
            return Err(cursor.error(format!("{other} channels"), "1, or 3: luminance, red and blue"));
        }
    };
    let bases = integer(&mut cursor, "the number of bases")?;
    if bases != 1 {
        cursor.at -= 4;
        return Err(cursor.error(format!("{bases} bases"), "one: a material without textures"));
    }
    let metadata = count(&mut cursor, "bytes of metadata")?;
    let parameters = integer(&mut cursor, "the number of parameters")?;
    integer(&mut cursor, "the number of parameter values")?;
    if parameters != 0 {
        cursor.at -= 8;
        return Err(cursor.error(format!("{parameters} parameters"), "none: a material without textures"));
    }
    let eta = f32::from_le_bytes(cursor.array("the refractive index")?);
    cursor.take(16, "four floats that are not used")?;

    let mu = cursor.floats(Some(knots), "cosines")?;
    let pairs = knots.checked_mul(knots);
    let size = |bytes: usize| pairs.and_then(|pairs| pairs.checked_mul(bytes)).unwrap_or(usize::MAX);
    cursor.take(size(4), "numbers for sampling, one per pair of cosines")?;
    let start = cursor.at;
    let (indices, _) =
        cursor.take(size(8), "indices and numbers of coefficients, one pair per pair of cosines")?.as_chunks::<8>();
    let mut series = Vec::with_capacity(indices.len());
    for &[a, b, c, d, e, f, g, h] in indices {
        let numbers = [i32::from_le_bytes([a, b, c, d]), i32::from_le_bytes([e, f, g, h])];
        let [Ok(start), Ok(count)] = numbers.map(u32::try_from) else {
            cursor.at = start + 8 * series.len();
            return Err(cursor.error(
                format!("{} coefficients from {} on", numbers[1], numbers[0]),
                "numbers that are not negative",
            ));
        };
        series.push(Series { start, count });
    }
    let coefficients = cursor.floats(Some(coefficients), "coefficients")?;
    let metadata = cursor.take(metadata, "metadata")?;
    if !cursor.rest().is_empty() {
        return Err(cursor.error(format!("{} more bytes", cursor.rest().len()), "the end of the file"));
    }
    let data = Data::new(Parts { mu, series, coefficients, channels, eta });
    cursor.at = 0;
    let data =
        data.map_err(|invalid| cursor.error(format!("{}: {}", invalid.part, invalid.found), invalid.expected))?;
    let words = String::from_utf8_lossy(metadata);
    let words = words.trim_matches('\0').split_whitespace().collect::<Vec<&str>>().join(" ");
    Ok(Document::new(data).with_source(&[("metadata", words.as_str())]))
}

fn integer(cursor: &mut Cursor<'_, '_>, what: &str) -> Result<i32, FormatError> {
    Ok(i32::from_le_bytes(cursor.array(what)?))
}

/// A non-negative number of items that follow.
fn count(cursor: &mut Cursor<'_, '_>, what: &str) -> Result<usize, FormatError> {
    let number = integer(cursor, &format!("the number of {what}"))?;
    usize::try_from(number).map_err(|_| {
        cursor.at -= 4;
        cursor.error(format!("{number} {what}"), "a number that is not negative")
    })
}
