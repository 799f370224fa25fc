//! The lines above the rows of a table: facts for people, and angles, units and scatters that apply to all rows.

use super::claims::Claim;
use super::meaning::Meaning;
use super::names::meaning;
use super::quantities::nanometres;
use super::sheet::{Dialect, Line};
use super::stated::unit_of_angle;
use super::words::OF_NO_VALUE;
use super::{ROWS, Rows};
use crate::angle::{Angle, Unit};
use crate::reading::Holds;

/// The facts in lines above or between the rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Facts {
    /// Names and values, for people.
    pub source: Vec<(String, String)>,
    /// Angles that are the same in all following rows, with the unit if it is stated.
    pub angles: Vec<Fixed>,
    /// The unit of angles.
    pub unit: Option<Unit>,
    pub holds: Option<Holds>,
    /// The kind of the rows, if they do not show it.
    pub rows: Option<Rows>,
    /// The wavelength of the following rows, in nm.
    pub wavelength: Option<f64>,
    /// What the lines say that the options have to settle.
    pub claims: Vec<Claim>,
}

/// An angle in a separate line: `Angle of incidence: 30 deg`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fixed {
    pub angle: Angle,
    pub value: f64,
    pub unit: Option<Unit>,
}

/// `true` for a comment that does not matter to the rows below it: a run, a time.
pub(super) fn says_nothing(line: &Line<'_>) -> bool {
    let text = line.comment().unwrap_or(line.text).to_lowercase();
    let first = text.split(|c: char| !c.is_alphanumeric()).find(|word| !word.is_empty());
    first.is_none_or(|word| OF_NO_VALUE.contains(&word))
}

/// The longest value that is kept.
const LONGEST: usize = 400;

impl Facts {
    /// Keeps what a line says that the options have to settle.
    pub fn claim(&mut self, dialect: Dialect, line: &Line<'_>) {
        let text = line.comment().unwrap_or(line.text).trim();
        if fixed(dialect, line).is_none() {
            let parts = parted(dialect, text);
            let parts = parts.as_ref().map(|(name, value)| (*name, value.as_str()));
            self.claims.extend(Claim::of(line.number, text, parts));
        }
    }

    /// Processes a line.
    pub fn add(&mut self, dialect: Dialect, line: &Line<'_>) {
        let text = line.comment().unwrap_or(line.text).trim();
        if text.chars().all(|c| !c.is_alphanumeric()) {
            return;
        }
        if let Some(fixed) = fixed(dialect, line) {
            self.angles.retain(|other| other.angle != fixed.angle);
            self.angles.push(fixed);
        }
        self.wavelength = wavelength(dialect, line).or(self.wavelength);
        self.claim(dialect, line);
        let (name, value) = parted(dialect, text).unwrap_or(("comment", text.into()));
        let words = (name.to_lowercase(), value.to_lowercase());
        let is_of_angles = ["angle", "angular", "winkel"].iter().any(|part| words.0.contains(part));
        let is_unit = words.0.contains("unit") || words.0.contains("einheit");
        let is_whole = ["unit", "angle", "angles in", "winkel"].contains(&words.0.trim_end_matches('s'));
        if (is_unit && is_of_angles) || is_whole {
            self.unit = words.1.trim().parse().ok().or(self.unit);
        }
        if words.0 == ROWS
            && let Some(rows) = Rows::ALL.into_iter().find(|rows| rows.word() == words.1.trim())
        {
            self.rows = Some(rows);
            return;
        }
        if KINDS.contains(&words.0.as_str()) {
            self.holds = holds(&words.1).or(self.holds);
        }
        self.source.push((shown(name), shown(&value)));
    }
}

/// Names of lines that say whether light is reflected or transmitted.
const KINDS: &[&str] = &[
    "scatter",
    "scattertype",
    "scatter type",
    "scatter_type",
    "type",
    "measurement",
    "measurement type",
    "data type",
    "mode",
    "quantity",
    "measured quantity",
    "function",
    "messung",
    "messart",
];

/// What a line such as `Mode: transmittance (BTDF)` says, in lower case.
fn holds(value: &str) -> Option<Holds> {
    let has = |parts: &[&str]| parts.iter().any(|part| value.contains(part));
    match (has(&["refl", "brdf"]), has(&["transm", "btdf"])) {
        (true, true) => Some(Holds::Both),
        (true, false) => Some(Holds::Reflection),
        (false, true) => Some(Holds::Transmission),
        (false, false) => value.trim().parse().ok(),
    }
}

/// Text from the file for people: not too long, and without control characters.
fn shown(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars().take(LONGEST) {
        match c.is_control() {
            true => out.extend(c.escape_default()),
            false => out.push(c),
        }
    }
    out
}

/// The angle that a line states, if it is such a line.
pub(super) fn fixed(dialect: Dialect, line: &Line<'_>) -> Option<Fixed> {
    let text = line.comment().unwrap_or(line.text).trim();
    let (name, value) = parted(dialect, text)?;
    let Meaning::Angle(angle, unit) = meaning(name) else { return None };
    let digits = value.trim_end_matches(|c: char| c.is_alphabetic() || c == '°' || c == '˚');
    let suffix = match &value[digits.len()..] {
        "" => None,
        // Gons, for instance, are not degrees.
        suffix => Some(suffix.parse().ok()?),
    };
    if suffix.is_none() && unit_of_angle(name).is_some() {
        return None;
    }
    let comma = Dialect { has_decimal_comma: digits.contains(',') && !digits.contains('.'), ..dialect };
    Some(Fixed { angle, value: comma.number(digits.trim())?, unit: suffix.or(unit) })
}

/// The wavelength in nm that a line states for the rows below it: `Wavelength: 550 nm`, or only `550 nm`.
pub(super) fn wavelength(dialect: Dialect, line: &Line<'_>) -> Option<f64> {
    let text = line.comment().unwrap_or(line.text).trim();
    let number = |text: &str, unit: &str| {
        let word: String = text.to_lowercase().chars().filter(|c| !c.is_whitespace() && *c != '"').collect();
        nanometres(&word.trim_end_matches([',', ';']).replace(',', "."), unit)
    };
    let Some((name, value)) = parted(dialect, text) else { return number(text, "") };
    match meaning(name) {
        Meaning::Wavelength(1.0) => number(&value, "nm"),
        Meaning::Wavelength(_) => number(&value, "um"),
        _ => None,
    }
}

/// The name and the value of a line such as `Operator,nobody`, `Operator: nobody` or `theta_i = 30`.
fn parted<'a>(dialect: Dialect, text: &'a str) -> Option<(&'a str, String)> {
    if let Some(delimiter) = dialect.delimiter
        && let Some((name, rest)) = text.split_once(delimiter)
    {
        let trim = |text: &'a str| text.trim().trim_matches('"').trim_end_matches([':', '=']).trim();
        let values: Vec<&str> = rest
            .split(delimiter)
            .map(|value| value.trim().trim_matches('"'))
            .filter(|value| !value.is_empty())
            .collect();
        let name = trim(name);
        return (!name.is_empty() && !values.is_empty()).then(|| (name, values.join(" ")));
    }
    let (name, value) = text.split_once([':', '=', '\t'])?;
    let (name, value) = (name.trim().trim_matches('"'), value.trim().trim_matches([';', ',', '"']).trim());
    (!name.is_empty() && !value.is_empty()).then(|| (name, value.into()))
}
