//! NVIDIA MDL `.mbsdf` files: isotropic reflection and transmission on uniform grids.
//!
//! A line `NVIDIA ARC MBSDF V1`, any lines of metadata, then one or two blocks. A block is a line
//! `MBSDF_DATA_REFLECTION=` (or `MBSDF_DATA=`, the same) or `MBSDF_DATA_TRANSMISSION=`, reflection first; the type (0
//! scalar, 1 RGB), the number of zenith angles and the number of azimuths as little-endian `u32`; and the values as
//! 32-bit floats, `[theta_in][theta_out][phi][channel]`. Lines end with a single line feed.
//!
//! The zenith angles are documented as uniform in `[0, pi/2)` and the azimuths as uniform in `[0, pi]`. Measured files
//! bear out the first: with `theta_out` index 0 their values do not depend on the azimuth, so it is the pole itself.

use crate::bytes::Cursor;
use crate::error::FormatError;
use crate::write::{unwritable, write_whole};
use lobe_table::spherical::{Sides, Spherical};
use std::io;
use std::path::Path;

const MAGIC: &[u8] = b"NVIDIA ARC MBSDF V1\n";
const DATA: &[u8] = b"MBSDF_DATA=\n";
const REFLECTION: &[u8] = b"MBSDF_DATA_REFLECTION=\n";
const TRANSMISSION: &[u8] = b"MBSDF_DATA_TRANSMISSION=\n";

/// Whether `bytes` begin like a file of this format.
pub fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Reads both sides.
///
/// # Errors
/// [`FormatError`] where the signature or all data are missing, a block is cut off, or something follows the last one.
pub fn read(bytes: &[u8], file: &Path) -> Result<Sides, FormatError> {
    let mut cursor = Cursor::new(bytes, file);
    cursor.signature(MAGIC, MAGIC.trim_ascii().escape_ascii().to_string().as_str())?;
    let mut sides = Sides { reflection: None, transmission: None };
    let mut heading = metadata(&mut cursor)?;
    if heading != TRANSMISSION {
        sides.reflection = Some(block(&mut cursor)?);
        // The format's description ends a block with a line feed, its files do not.
        if cursor.rest().starts_with(b"\n") {
            cursor.at += 1;
        }
        if cursor.rest().is_empty() {
            return Ok(sides);
        }
        heading = line(&mut cursor);
        if heading != TRANSMISSION {
            cursor.at -= heading.len();
            return Err(cursor.error(shown(heading), format!("{} or the end", shown(TRANSMISSION))));
        }
    }
    sides.transmission = Some(block(&mut cursor)?);
    match cursor.rest() {
        b"" | b"\n" => Ok(sides),
        rest => Err(cursor.error(format!("{} bytes more", rest.len()), "the end of the file")),
    }
}

/// Passes over the metadata and the first heading, which is returned.
fn metadata<'a>(cursor: &mut Cursor<'a, '_>) -> Result<&'a [u8], FormatError> {
    loop {
        let line = line(cursor);
        if [DATA, REFLECTION, TRANSMISSION].contains(&line) {
            return Ok(line);
        }
        if line.is_empty() {
            return Err(
                cursor.error("the end of the file", "a line MBSDF_DATA=, or that of reflection or transmission")
            );
        }
    }
}

/// The next line with its line feed, or what is left of the file.
fn line<'a>(cursor: &mut Cursor<'a, '_>) -> &'a [u8] {
    let rest = cursor.rest();
    let end = rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |at| at + 1);
    cursor.at += end;
    &rest[..end]
}

fn shown(line: &[u8]) -> String {
    format!("\"{}\"", line[..line.len().min(40)].escape_ascii())
}

fn block(cursor: &mut Cursor<'_, '_>) -> Result<Spherical, FormatError> {
    let start = cursor.at;
    let mut number = |what| Ok::<_, FormatError>(u32::from_le_bytes(cursor.array(what)?) as usize);
    let (kind, thetas, phis) = (number("the type")?, number("the zenith angles")?, number("the azimuths")?);
    let channels = match kind {
        0 => 1,
        1 => 3,
        _ => {
            cursor.at = start;
            return Err(cursor.error(format!("type {kind}"), "0 for scalars or 1 for RGB"));
        }
    };
    let count = [thetas, phis, channels].into_iter().try_fold(thetas, |count, n| count.checked_mul(n));
    let values = cursor.floats(count, &format!("{thetas} x {thetas} x {phis} x {channels} values"))?;
    Spherical::new([thetas, phis, channels], values).map_err(|invalid| {
        cursor.at = start;
        cursor.error(format!("{}: {}", invalid.part, invalid.found), invalid.expected)
    })
}

/// The bytes of an `.mbsdf` file.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] where a resolution does not fit into `u32`, or there is neither side.
pub fn to_bytes(sides: &Sides) -> io::Result<Vec<u8>> {
    let mut bytes = MAGIC.to_vec();
    let invalid = |why| io::Error::new(io::ErrorKind::InvalidInput, why);
    for (heading, side) in [(REFLECTION, &sides.reflection), (TRANSMISSION, &sides.transmission)] {
        let Some(side) = side else { continue };
        bytes.extend_from_slice(heading);
        let [thetas, phis, channels] = side.resolution();
        for n in [usize::from(channels == 3), thetas, phis] {
            let n = u32::try_from(n).map_err(|_| invalid("a resolution above that of u32"))?;
            bytes.extend_from_slice(&n.to_le_bytes());
        }
        side.values().iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
    }
    if bytes.len() == MAGIC.len() {
        return Err(invalid("neither reflection nor transmission"));
    }
    Ok(bytes)
}

/// Writes an `.mbsdf` file, replacing what was there at once.
///
/// # Errors
/// [`FormatError`] as [`to_bytes`], and where the file system refuses.
pub fn write(sides: &Sides, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(sides).map_err(|error| unwritable(path, &error))?)
}
