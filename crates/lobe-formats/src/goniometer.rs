//! Tables of people's own goniometers: CSV or JSON with named columns.
//!
//! Columns of angles are `theta_i`, `phi_i`, `theta_o`, `phi_o`, or in specular coordinates `sigma`, `psi`, `theta`, `phi`;
//! `phi_i` and `psi` may be left out if they make no difference. Each may end in `_deg` or `_rad`; without that, the
//! unit is that of [`Options`]. All other columns are channels of `f` in 1/sr, without the cosine: `R`, `G`, `B`; `X`,
//! `Y`, `Z`; wavelengths in nm such as `550` or `550nm`; or one of any name.
//!
//! CSV has a line of names, `#` comments, and commas, semicolons or tabs; a comment `# scatter: transmission` before the
//! names says that it is a BTDF. JSON has an object with a list of numbers a
//! column. Rows may be in any order: if they are all nodes of a grid over more than half a turn they become a grid,
//! else scattered samples.

mod write;

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

use lobe_table::{Channels, Data, Scatter, specular, spherical};

pub use write::write;

use crate::columns::channels;
use crate::lines::shown;
use crate::records::Records;
use crate::spec::{FormatSpec, Writer, either, unfit};
use crate::{Document, FormatError, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "table with named columns",
    word: "csv",
    extensions: &["csv", "json"],
    matches,
    read: Some(|bytes, path| Ok(Document::new(read(bytes, path)?))),
    writer: Some(Writer {
        extensions: &["csv"],
        holds_channels: |channels| !matches!(channels, Channels::Named(_)),
        channels: "one channel, R G B, X Y Z or wavelengths",
        holds: |document| matches!(document.only(), Some(Data::Specular(_) | Data::Spherical(_) | Data::Scattered(_))),
        holds_sheets: false,
        scatter: either,
        resampled_as: Ok(specular::KIND),
        write: |document, path| match document.only() {
            Some(data) => write(data, path),
            None => Err(unfit(document, path, "one measurement")),
        },
    }),
};

/// What a table does not say itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Whether angles without `_deg` or `_rad` are in degrees.
    pub is_in_degrees: bool,
    /// Reflection or transmission.
    pub scatter: Scatter,
}

impl Default for Options {
    fn default() -> Self {
        Options { is_in_degrees: true, scatter: Scatter::Reflection }
    }
}

const SPHERICAL: [&str; 4] = ["theta_i", "phi_i", "theta_o", "phi_o"];
const SPECULAR: [&str; 4] = ["sigma", "psi", "theta", "phi"];

/// The comment, before the names, that distinguishes a BTDF from a BRDF.
const TRANSMISSION: &str = "scatter: transmission";

/// `true` for CSV or JSON with the names of these columns of angles.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 16)]);
    let head = head.trim_start_matches('\u{feff}').trim_start();
    let has = |names: &[String]| {
        let base: Vec<&str> = names.iter().map(|name| base(name).0).collect();
        [&SPHERICAL, &SPECULAR].iter().any(|axes| [0, 2, 3].iter().all(|&axis| base.contains(&axes[axis])))
    };
    if head.starts_with('{') {
        let quoted: Vec<String> = head.split('"').skip(1).step_by(2).map(str::to_lowercase).collect();
        return has(&quoted);
    }
    let line = head.lines().find(|line| !line.starts_with('#')).unwrap_or_default();
    has(&line.split([',', ';', '\t']).map(|name| name.trim().trim_matches('"').to_lowercase()).collect::<Vec<_>>())
}

/// Reads a table with the default [`Options`]: a grid if all nodes of one are present, else scattered samples, of which
/// those in specular coordinates that are below the horizon are left out.
///
/// # Errors
/// See [`read_with`].
pub fn read(bytes: &[u8], file: &Path) -> Result<Data, FormatError> {
    read_with(bytes, file, Options::default())
}

/// Reads a table. `file` only names it in errors.
///
/// # Errors
/// [`FormatError`] with the line of CSV, or the column of JSON: columns that are missing or twice there, channels that are
/// neither colours nor wavelengths nor one, rows of another length, and words that are not finite numbers.
pub fn read_with(bytes: &[u8], file: &Path, options: Options) -> Result<Data, FormatError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if bytes.trim_ascii_start().starts_with(b"{") {
        return json(bytes, file)?.goniometer(file, options);
    }
    let mut comments = bytes.split(|&b| b == b'\n').take_while(|line| line.starts_with(b"#"));
    let is_transmission = comments.any(|line| line[1..].trim_ascii().eq_ignore_ascii_case(TRANSMISSION.as_bytes()));
    let scatter = if is_transmission { Scatter::Transmission } else { options.scatter };
    csv(bytes, file)?.goniometer(file, Options { scatter, ..options })
}

/// Names and `[row][column]`.
struct Table {
    names: Vec<String>,
    values: Vec<f64>,
}

fn csv(bytes: &[u8], file: &Path) -> Result<Table, FormatError> {
    let names_line = bytes.split(|&b| b == b'\n').find(|line| !line.starts_with(b"#")).unwrap_or_default();
    let delimiter = [b';', b'\t'].into_iter().find(|delimiter| names_line.contains(delimiter)).unwrap_or(b',');
    let mut reader =
        csv::ReaderBuilder::new().delimiter(delimiter).comment(Some(b'#')).trim(csv::Trim::All).from_reader(bytes);
    let failed = |error: csv::Error| {
        let line = error.position().map_or(1, |position| position.line() as usize);
        FormatError::new(file, Place::Line(line), error.to_string(), "rows with a value for each column")
    };
    let names = reader.byte_headers().map_err(failed)?;
    let names: Vec<String> = names.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect();
    let mut values = Vec::new();
    for record in reader.byte_records() {
        let record = record.map_err(failed)?;
        let line = record.position().map_or(1, |position| position.line() as usize);
        for word in &record {
            let word = String::from_utf8_lossy(word);
            let value = word.parse().ok().filter(|value: &f64| value.is_finite());
            let value = value.ok_or_else(|| FormatError::new(file, Place::Line(line), shown(&word), "a finite number"));
            values.push(value?);
        }
    }
    Ok(Table { names, values })
}

fn json(bytes: &[u8], file: &Path) -> Result<Table, FormatError> {
    let columns: BTreeMap<String, Vec<f64>> = serde_json::from_slice(bytes).map_err(|error| {
        let expected = "an object with a list of numbers for each column";
        FormatError::new(file, Place::Line(error.line()), error.to_string(), expected)
    })?;
    let rows = columns.values().next().map_or(0, Vec::len);
    if let Some((name, column)) = columns.iter().find(|(_, column)| column.len() != rows) {
        let found = format!("{} numbers in column {name}", column.len());
        return Err(FormatError::new(file, Place::File, found, format!("{rows}, as in the others")));
    }
    // An object has no order; colours do.
    let mut columns: Vec<(String, Vec<f64>)> = columns.into_iter().collect();
    let rank = |name: &str| ["r", "g", "b"].iter().position(|colour| name.eq_ignore_ascii_case(colour)).unwrap_or(0);
    let wavelength = |name: &str| name.trim_end_matches("nm").parse::<f64>().unwrap_or(0.0);
    columns.sort_by(|(a, _), (b, _)| rank(a).cmp(&rank(b)).then(wavelength(a).total_cmp(&wavelength(b))));
    let values = (0..rows).flat_map(|row| columns.iter().map(move |(_, column)| column[row])).collect();
    Ok(Table { names: columns.into_iter().map(|(name, _)| name).collect(), values })
}

/// A name without its unit, and whether the unit is degrees.
fn base(name: &str) -> (&str, Option<bool>) {
    match name.strip_suffix("_deg") {
        Some(base) => (base, Some(true)),
        None => name.strip_suffix("_rad").map_or((name, None), |base| (base, Some(false))),
    }
}

impl Table {
    fn goniometer(self, file: &Path, options: Options) -> Result<Data, FormatError> {
        let error = |found: String, expected: &str| FormatError::new(file, Place::Line(1), found, expected);
        let names: Vec<String> = self.names.iter().map(|name| name.to_lowercase()).collect();
        let is_specular = names.iter().any(|name| base(name).0 == SPECULAR[0]);
        let axes = if is_specular { SPECULAR } else { SPHERICAL };
        // Where each angle is, and what makes it radians.
        let mut places: [Option<(usize, f64)>; 4] = [None; 4];
        let mut others = Vec::new();
        for (column, name) in names.iter().enumerate() {
            let (base, is_in_degrees) = base(name);
            let Some(axis) = axes.iter().position(|axis| *axis == base) else {
                others.push(column);
                continue;
            };
            let unit = if is_in_degrees.unwrap_or(options.is_in_degrees) { 1_f64.to_radians() } else { 1.0 };
            if places[axis].replace((column, unit)).is_some() {
                return Err(error(format!("a second column of {base}"), "each angle once"));
            }
        }
        if let Some(missing) = [0, 2, 3].into_iter().find(|&axis| places[axis].is_none()) {
            let expected = "theta_i, theta_o and phi_o, or sigma, theta and phi";
            return Err(error(format!("no column of {}", axes[missing]), expected));
        }
        let channel_names: Vec<&str> = others.iter().map(|&column| self.names[column].as_str()).collect();
        let channels = channels(&channel_names).ok_or_else(|| {
            error(format!("channels {}", shown(&channel_names.join(", "))), "R, G, B or X, Y, Z or wavelengths or one")
        })?;
        let mut records = Records::default();
        for row in self.values.chunks_exact(names.len()) {
            let angles = places.map(|place| place.map_or(0.0, |(column, unit)| row[column] * unit));
            let values = others.iter().map(|&column| row[column]);
            if is_specular {
                // Specular angles have no sign to take off.
                records.angles.push(angles);
                records.values.extend(values.map(|value| value as f32));
            } else {
                records.push(angles, values);
            }
        }
        if let Some((knots, values)) = grid(&records, channels.count()) {
            let refused = |e: lobe_table::GridError| FormatError::new(file, Place::File, e.to_string(), "a grid");
            return match is_specular {
                true => {
                    specular::Data::new(options.scatter, knots, channels, values).map(Data::Specular).map_err(refused)
                }
                false => {
                    let grid = spherical::Data::new(options.scatter, knots, channels, values);
                    grid.map(Data::Spherical).map_err(refused)
                }
            };
        }
        let records = if is_specular { spherical(&records, &channels) } else { records };
        records.scattered(file, options.scatter, channels).map(Data::Scattered)
    }
}

/// Knots and values, if the samples are each node of a grid once. A line of directions is not a grid.
fn grid(records: &Records, channels: usize) -> Option<([Vec<f64>; 4], Vec<f32>)> {
    // Angles that were written with six digits of radians are the same knot.
    let key = |angle: f64| (angle * 1e6).round() as i64;
    let mut knots: [BTreeMap<i64, f64>; 4] = Default::default();
    for angles in &records.angles {
        for (knots, &angle) in knots.iter_mut().zip(angles) {
            knots.insert(key(angle), angle);
        }
    }
    let nodes = knots.iter().try_fold(1_usize, |nodes, knots| nodes.checked_mul(knots.len()))?;
    let (first, last) = (knots[3].values().next()?, knots[3].values().next_back()?);
    // Half a turn is for the scattered samples too, which know that the other half is its mirror image.
    let is_whole_turn = last - first > PI + 1e-6;
    if nodes != records.angles.len() || knots[2].len() < 2 || !is_whole_turn {
        return None;
    }
    let positions: [BTreeMap<i64, usize>; 4] =
        std::array::from_fn(|axis| knots[axis].keys().enumerate().map(|(position, &key)| (key, position)).collect());
    let mut values = vec![None; nodes];
    for (angles, colour) in records.angles.iter().zip(records.values.chunks_exact(channels)) {
        let node = (0..4).fold(0, |at, axis| at * knots[axis].len() + positions[axis][&key(angles[axis])]);
        if values[node].replace(colour).is_some() {
            return None;
        }
    }
    let values = values.into_iter().flatten().flatten().copied().collect();
    Some((knots.map(|knots| knots.into_values().collect()), values))
}

/// The directions of samples in specular coordinates, without those below the horizon.
fn spherical(records: &Records, channels: &Channels) -> Records {
    let mut out = Records::default();
    for (&[sigma, psi, theta, phi], colour) in records.angles.iter().zip(records.values.chunks_exact(channels.count()))
    {
        let ((sin, cos), (sin_t, cos_t), (sin_p, cos_p)) = (sigma.sin_cos(), theta.sin_cos(), phi.sin_cos());
        let (x, y, z) = (cos * sin_t * cos_p - sin * cos_t, sin_t * sin_p, sin * sin_t * cos_p + cos * cos_t);
        if z > 0.0 {
            out.push([sigma, psi, x.hypot(y).atan2(z), y.atan2(x) + psi], colour.iter().map(|value| f64::from(*value)));
        }
    }
    out
}
