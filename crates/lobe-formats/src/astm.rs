//! ASTM E1392 text files of scattered light, as used by the Cornell Program of Computer Graphics.
//!
//! Lines of a keyword and a value, among them `NUM_POINTS`; the last is `VARS` with the names of the columns. Then a
//! comma-separated record per line: `theta_i`, `phi_i`, `theta_s`, `phi_s` in radians, or `theta_i`, `theta_s`, `phi_s`
//! with the light at azimuth 0, and `f` in 1/sr: `R,G,B`, or `X,Y,Z`, or columns such as `400nm`, or one with any name.
//! The file does not say whether it is reflection or transmission.

mod write;

use std::path::Path;

use lobe_table::{Channels, Scatter, scattered, specular};

use crate::columns::channels;
use crate::facts::{Facts, named};
use crate::lines::{Line, lines, shown};
use crate::listed::is_listed;
use crate::records::Records;
use crate::spec::{FormatSpec, Writer, reflection};
use crate::{Document, FormatError, Place};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "ASTM E1392",
    word: "astm",
    extensions: &[],
    matches,
    read: Some(|bytes, path, _| Ok(Document::new(read(bytes, path)?).with_facts(facts(bytes)))),
    read_set: None,
    writer: Some(Writer {
        extensions: &[],
        holds_channels: |channels| !matches!(channels, Channels::Named(_)),
        channels: "one channel, R G B, X Y Z or wavelengths",
        holds: is_listed,
        holds_sheets: false,
        scatter: reflection,
        resampled_as: Ok(specular::KIND),
        write: write::write,
    }),
};

/// `true` if the lines at the start have `NUM_POINTS` and `VARS`.
pub fn matches(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 16)]);
    let has = |key: &str| head.lines().any(|line| line.split_whitespace().next() == Some(key));
    has("NUM_POINTS") && has("VARS")
}

/// The keywords before the names of the columns.
fn facts(bytes: &[u8]) -> Facts {
    let mut facts = named(bytes, |key| (key != "VARS").then(|| key.into()));
    facts.retain(|(key, _)| key != "NUM_POINTS");
    facts
}

/// Reads a file as reflection; see [`read_as`].
///
/// # Errors
/// See [`read_as`].
pub fn read(bytes: &[u8], file: &Path) -> Result<scattered::Data, FormatError> {
    read_as(bytes, file, Scatter::Reflection)
}

/// Reads a file. `file` is only its name in errors.
///
/// # Errors
/// [`FormatError`] with the line: other columns, records of another length, or a number of records that differs from
/// the announced one.
pub fn read_as(bytes: &[u8], file: &Path, scatter: Scatter) -> Result<scattered::Data, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = lines(file, &text);
    let mut announced = None;
    let vars = loop {
        let Some(line) = lines.next() else {
            return Err(FormatError::new(file, Place::File, "no VARS", "VARS with the names of the columns"));
        };
        let (key, value) = line.text.split_once(char::is_whitespace).unwrap_or((line.text, ""));
        match key {
            "VARS" => break (line, value),
            "NUM_POINTS" => {
                let count = value.trim().parse::<usize>();
                announced = Some(count.map_err(|_| line.error(shown(value), "a number of points"))?);
            }
            _ => {}
        }
    };
    let (angles, channels) = columns(vars)?;
    let width = angles + channels.count();
    let mut records = Records::default();
    for line in lines {
        let numbers = line.numbers()?;
        if numbers.len() != width {
            return Err(line.error(format!("{} numbers", numbers.len()), format!("{width}, as VARS has names")));
        }
        let of_record = match angles {
            4 => [numbers[0], numbers[1], numbers[2], numbers[3]],
            _ => [numbers[0], 0.0, numbers[1], numbers[2]],
        };
        records.push_line(line.number, of_record, numbers[angles..].iter().copied());
    }
    match announced {
        Some(count) if count != records.angles.len() => {
            let found = format!("{} records", records.angles.len());
            Err(FormatError::new(file, Place::File, found, format!("NUM_POINTS, {count}")))
        }
        _ => records.scattered(file, scatter, channels),
    }
}

/// The number of angles, and the channels.
fn columns((line, names): (Line<'_>, &str)) -> Result<(usize, Channels), FormatError> {
    let names: Vec<&str> = names.split(',').map(str::trim).collect();
    let starts = |wanted: &[&str]| names.len() > wanted.len() && names.iter().zip(wanted).all(|(a, b)| a == b);
    let angles = match () {
        () if starts(&["theta_i", "phi_i", "theta_s", "phi_s"]) => 4,
        () if starts(&["theta_i", "theta_s", "phi_s"]) => 3,
        () => return Err(line.error(shown(line.text), "VARS theta_i,phi_i,theta_s,phi_s and columns of values")),
    };
    let channels = channels(&names[angles..]).ok_or_else(|| {
        line.error(shown(&names[angles..].join(",")), "R,G,B or X,Y,Z or wavelengths in nm or one column")
    })?;
    Ok((angles, channels))
}
