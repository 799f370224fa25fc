//! Tables as JSON: an object with a list of numbers per column.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, Visitor};

use super::chosen::meanings;
use super::facts::Facts;
use super::layout::{Layout, Values};
use super::meaning::Meaning;
use super::names::meaning;
use super::raw::Raw;
use super::source::Source;
use super::trouble::Trouble;
use crate::angle::Angle;
use crate::lines::shown;
use crate::reading::ReadOptions;
use crate::{FormatError, Place};

/// `true` if the quoted words at the start include the names of the angles.
pub(super) fn matches(head: &str) -> bool {
    let found: Vec<Angle> = head
        .split('"')
        .skip(1)
        .step_by(2)
        .filter_map(|word| match meaning(word) {
            Meaning::Angle(angle, _) => Some(angle),
            _ => None,
        })
        .collect();
    let has = |angles: &[Angle]| angles.iter().all(|angle| found.contains(angle));
    has(&[Angle::ThetaI, Angle::ThetaO]) || has(&[Angle::Sigma, Angle::Theta, Angle::Phi])
}

/// The columns by name. The last of several with one name would hide the others, so it is an error.
struct Columns(BTreeMap<String, Vec<Option<f64>>>);

impl<'de> Deserialize<'de> for Columns {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Each;
        impl<'de> Visitor<'de> for Each {
            type Value = Columns;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object with a list of numbers for each column")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Columns, A::Error> {
                let mut columns = BTreeMap::new();
                while let Some((name, column)) = map.next_entry::<String, Vec<Option<f64>>>()? {
                    let shown = shown(&name);
                    if columns.insert(name, column).is_some() {
                        return Err(A::Error::custom(format!("a second column {shown}")));
                    }
                }
                Ok(Columns(columns))
            }
        }
        deserializer.deserialize_map(Each)
    }
}

/// Reads the columns; `null` means "not measured".
pub(super) fn read(bytes: &[u8], file: &Path, options: &ReadOptions) -> Result<Raw, FormatError> {
    let Columns(columns) = serde_json::from_slice(bytes).map_err(|error| {
        let expected = "an object with a list of numbers for each column";
        FormatError::new(file, Place::Line(error.line()), error.to_string(), expected)
    })?;
    let rows = columns.values().next().map_or(0, Vec::len);
    if let Some((name, column)) = columns.iter().find(|(_, column)| column.len() != rows) {
        let found = format!("{} numbers in column {name}", column.len());
        return Err(FormatError::new(file, Place::File, found, format!("{rows}, as in the others")));
    }
    // The order of names in an object is arbitrary; colours have an order.
    let mut columns: Vec<(String, Vec<Option<f64>>)> = columns.into_iter().collect();
    let rank = |name: &str| ["r", "g", "b"].iter().position(|colour| name.eq_ignore_ascii_case(colour)).unwrap_or(0);
    let wavelength = |name: &str| name.trim_end_matches("nm").parse::<f64>().unwrap_or(0.0);
    columns.sort_by(|(a, _), (b, _)| rank(a).cmp(&rank(b)).then(wavelength(a).total_cmp(&wavelength(b))));
    let names: Vec<String> = columns.iter().map(|(name, _)| name.clone()).collect();
    let failed = |trouble: Trouble| FormatError::new(file, Place::Line(1), trouble.found, trouble.expected);
    let facts = Facts::default();
    let meanings = meanings(&names, names.len(), options).map_err(failed)?;
    let layout = Layout::new(&names, meanings, &[], &facts, options).map_err(failed)?;
    let wide = |found: &str| FormatError::new(file, Place::File, found, "a column per channel in JSON");
    let Values::Channels(channels, _) = &layout.values else {
        return Err(wide("a column per angle, or of wavelengths"));
    };
    let mut raw = Raw {
        rows: Vec::with_capacity(rows),
        lines: vec![1; rows],
        values: Vec::with_capacity(rows * channels.len()),
        wavelengths: Vec::new(),
        notes: Vec::new(),
        names_line: 1,
        facts,
        layout: layout.clone(),
    };
    for row in 0..rows {
        let mut angles = [0.0; 4];
        for (angle, source) in angles.iter_mut().zip(&layout.angles) {
            *angle = match *source {
                Source::Column(column, _) => columns[column].1[row].ok_or_else(|| {
                    FormatError::new(file, Place::File, format!("no {} in row {}", names[column], row + 1), "an angle")
                })?,
                Source::Fixed(value, _) => value,
                Source::Wide | Source::Missing => 0.0,
            };
        }
        raw.rows.push(angles);
        raw.values.extend(channels.iter().map(|&column| columns[column].1[row].map_or(f32::NAN, |value| value as f32)));
    }
    Ok(raw)
}
