//! NVIDIA MDL `.mbsdf` files: isotropic reflection and transmission on uniform grids.
//!
//! A line `NVIDIA ARC MBSDF V1`, any lines of metadata, then one or two blocks. A block is a line
//! `MBSDF_DATA_REFLECTION=` (or `MBSDF_DATA=`, the same) or `MBSDF_DATA_TRANSMISSION=`, reflection first; the type (0
//! scalar, 1 RGB), the number of zenith angles and the number of azimuths as little-endian `u32`; and the values as
//! 32-bit floats, `[theta_in][theta_out][phi][channel]`. Lines end with a single line feed.
//!
//! The zenith angles are documented as uniform in `[0, pi/2)`, and the azimuths (angles between the azimuths of the two
//! directions) as uniform in `[0, pi]`. Measured files confirm the first: at `theta_out` index 0, their values do not
//! depend on the azimuth, so it is the pole itself.

use crate::Document;
use crate::Sides;
use crate::bytes::Cursor;
use crate::facts::Facts;
use crate::spec::{FormatSpec, Writer, either, resampled, unfit};
use lobe_files::FormatError;
use lobe_files::{unwritable, write_whole};
use lobe_table::{Channels, Data, Kind, Scatter, spherical};
use std::f64::consts::{FRAC_PI_2, PI};
use std::io;
use std::path::Path;

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "MDL MBSDF",
    word: "mbsdf",
    extensions: &["mbsdf"],
    matches,
    read: Some(|bytes, path, _| Ok(Document::of_parts(read(bytes, path)?.into_parts()).with_facts(facts(bytes)))),
    read_set: None,
    writer: Some(Writer {
        extensions: &["mbsdf"],
        holds_channels: |channels| matches!(channels, Channels::Mono | Channels::Rgb),
        channels: "one channel or R G B",
        holds: |document| sides(document).is_some_and(|sides| to_bytes(&sides).is_ok()),
        holds_sheets: true,
        scatter: either,
        resampled_as: Ok(UNIFORM_HALF),
        write: |document, path| match sides(document) {
            Some(sides) => write_with(&sides, resampled(document), path),
            None => Err(unfit(document, path, "one grid of spherical coordinates for each kind of scatter")),
        },
    }),
};

/// The grids of this format, one half of an isotropic material with equal steps: see [`Nodes`].
pub const UNIFORM_HALF: Kind = Kind::new("uniform half of a spherical grid");

const MAGIC: &[u8] = b"NVIDIA ARC MBSDF V1\n";
const DATA: &[u8] = b"MBSDF_DATA=\n";
const REFLECTION: &[u8] = b"MBSDF_DATA_REFLECTION=\n";
const TRANSMISSION: &[u8] = b"MBSDF_DATA_TRANSMISSION=\n";

/// `true` if `bytes` begin like a file of this format.
pub fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// The positions of `n` values on an axis over `[0, end]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nodes {
    /// At `i / n` of the range: the end is not a node.
    LowerEdge,
    /// At `(i + 1/2) / n`: the middles of equal bins.
    Middle,
    /// At `i / (n - 1)`: both ends are nodes.
    Closed,
}

impl Nodes {
    fn knots(self, n: usize, end: f64) -> Vec<f64> {
        let (first, steps) = match self {
            Nodes::LowerEdge => (0.0, n),
            Nodes::Middle => (0.5, n),
            Nodes::Closed => (0.0, n.max(2) - 1),
        };
        (0..n).map(|i| end * (i as f64 + first) / steps as f64).collect()
    }
}

/// Reads both sides, with zenith angles as [`Nodes::LowerEdge`] and azimuths as [`Nodes::Closed`].
///
/// # Errors
/// The same as for [`read_with`].
pub fn read(bytes: &[u8], file: &Path) -> Result<Sides<spherical::Data>, FormatError> {
    read_with(bytes, file, [Nodes::LowerEdge, Nodes::Closed])
}

/// Reads both sides, with the positions `nodes` of values on the zenith axes and on the azimuth axis.
///
/// # Errors
/// [`FormatError`] if the signature or all data are missing, a block is cut off, or something follows the last one.
pub fn read_with(bytes: &[u8], file: &Path, nodes: [Nodes; 2]) -> Result<Sides<spherical::Data>, FormatError> {
    let mut cursor = Cursor::new(bytes, file);
    cursor.signature(MAGIC, MAGIC.trim_ascii().escape_ascii().to_string().as_str())?;
    let mut sides = Sides { reflection: None, transmission: None };
    let mut heading = metadata(&mut cursor)?;
    if heading != TRANSMISSION {
        sides.reflection = Some(block(&mut cursor, Scatter::Reflection, nodes)?);
        // The specification ends a block with a line feed, but real files do not.
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
    sides.transmission = Some(block(&mut cursor, Scatter::Transmission, nodes)?);
    match cursor.rest() {
        b"" | b"\n" => Ok(sides),
        rest => Err(cursor.error(format!("{} bytes more", rest.len()), "the end of the file")),
    }
}

/// The lines of metadata.
fn facts(bytes: &[u8]) -> Facts {
    let lines = bytes.split_inclusive(|&byte| byte == b'\n').skip(1);
    let text = lines.take_while(|line| ![DATA, REFLECTION, TRANSMISSION].contains(line));
    let text = text.map(|line| String::from_utf8_lossy(line.trim_ascii()).into_owned());
    text.filter(|line| !line.is_empty()).map(|line| ("metadata".into(), line)).collect()
}

/// Skips the metadata, and returns the first heading.
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

/// The next line with its line feed, or the rest of the file.
fn line<'a>(cursor: &mut Cursor<'a, '_>) -> &'a [u8] {
    let rest = cursor.rest();
    let end = rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |at| at + 1);
    cursor.at += end;
    &rest[..end]
}

fn shown(line: &[u8]) -> String {
    format!("\"{}\"", line[..line.len().min(40)].escape_ascii())
}

fn block(
    cursor: &mut Cursor<'_, '_>,
    scatter: Scatter,
    [zeniths, azimuths]: [Nodes; 2],
) -> Result<spherical::Data, FormatError> {
    let start = cursor.at;
    let mut number = |what| Ok::<_, FormatError>(u32::from_le_bytes(cursor.array(what)?) as usize);
    let (kind, thetas, phis) = (number("the type")?, number("the zenith angles")?, number("the azimuths")?);
    let channels = match kind {
        0 => Channels::Mono,
        1 => Channels::Rgb,
        _ => {
            cursor.at = start;
            return Err(cursor.error(format!("type {kind}"), "0 for scalars or 1 for RGB"));
        }
    };
    if thetas == 0 || phis == 0 {
        cursor.at = start;
        return Err(cursor.error(format!("{thetas} thetas and {phis} phis"), "at least one of each"));
    }
    let count = [thetas, phis, channels.count()].into_iter().try_fold(thetas, |count, n| count.checked_mul(n));
    let values = cursor.floats(count, &format!("{thetas} x {thetas} x {phis} x {} values", channels.count()))?;
    let theta = zeniths.knots(thetas, FRAC_PI_2);
    let knots = [theta.clone(), vec![0.0], theta, azimuths.knots(phis, PI)];
    spherical::Data::new(scatter, knots, channels, values).and_then(spherical::Data::mirrored).map_err(|error| {
        cursor.at = start;
        cursor.error(error.to_string(), "angles and values of a grid")
    })
}

/// The bytes of an `.mbsdf` file.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] if there is neither side, and for grids other than the mirrored ones that
/// [`read_with`] makes.
pub fn to_bytes(sides: &Sides<spherical::Data>) -> io::Result<Vec<u8>> {
    let mut bytes = MAGIC.to_vec();
    let invalid = |why| io::Error::new(io::ErrorKind::InvalidInput, why);
    for (heading, side) in [(REFLECTION, &sides.reflection), (TRANSMISSION, &sides.transmission)] {
        let Some(side) = side else { continue };
        bytes.extend_from_slice(heading);
        let [thetas, _, theta_o, phis] = side.knots();
        let kind = match side.channels() {
            Channels::Mono => 0,
            Channels::Rgb => 1,
            _ => return Err(invalid("channels other than one or RGB")),
        };
        let fits = |knots: &[f64], end| {
            let all = [Nodes::LowerEdge, Nodes::Middle, Nodes::Closed];
            all.into_iter().any(|nodes| nodes.knots(knots.len(), end) == knots)
        };
        if !side.is_mirrored() || thetas != theta_o || !fits(thetas, FRAC_PI_2) || !fits(phis, PI) {
            return Err(invalid(
                "a grid that is not uniform in the zenith angles of both and the azimuth between them",
            ));
        }
        for n in [kind, thetas.len(), phis.len()] {
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

/// Writes an `.mbsdf` file, replacing an existing one atomically.
///
/// # Errors
/// [`FormatError`] as [`to_bytes`], and if the file system refuses.
pub fn write(sides: &Sides<spherical::Data>, path: &Path) -> Result<(), FormatError> {
    write_with(sides, None, path)
}

/// Like [`write`], with a line of metadata.
fn write_with(sides: &Sides<spherical::Data>, metadata: Option<String>, path: &Path) -> Result<(), FormatError> {
    let mut bytes = to_bytes(sides).map_err(|error| unwritable(path, &error))?;
    if let Some(metadata) = metadata {
        bytes.splice(MAGIC.len()..MAGIC.len(), format!("{metadata}\n").into_bytes());
    }
    write_whole(path, &bytes)
}

/// The grids of a document, if it has at most one per scatter and does not distinguish sides.
fn sides(document: &Document) -> Option<Sides<spherical::Data>> {
    let mut sides = Sides { reflection: None, transmission: None };
    for part in &document.parts {
        let Data::Spherical(grid) = &part.data else { return None };
        let side = match grid.scatter() {
            Scatter::Reflection => &mut sides.reflection,
            Scatter::Transmission => &mut sides.transmission,
        };
        if part.side.is_some() || side.replace(grid.clone()).is_some() {
            return None;
        }
    }
    Some(sides)
}
