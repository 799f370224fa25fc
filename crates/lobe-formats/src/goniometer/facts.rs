//! The lines above the rows of a table: facts for people, and angles, units and scatters that apply to all rows.

use super::meaning::Meaning;
use super::names::meaning;
use super::sheet::{Dialect, Line};
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
}

/// An angle in a separate line: `Angle of incidence: 30 deg`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fixed {
    pub angle: Angle,
    pub value: f64,
    pub unit: Option<Unit>,
}

/// The longest value that is kept.
const LONGEST: usize = 400;

impl Facts {
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
        let (name, value) = parted(dialect, text).unwrap_or(("comment", text.into()));
        let words = (name.to_lowercase(), value.to_lowercase());
        if words.0.contains("unit") && (words.0.contains("angle") || words.0.trim_end_matches('s') == "unit") {
            self.unit = words.1.trim().parse().ok().or(self.unit);
        }
        if words.0 == ROWS
            && let Some(rows) = Rows::ALL.into_iter().find(|rows| rows.word() == words.1.trim())
        {
            self.rows = Some(rows);
            return;
        }
        let is_kind =
            ["scatter", "scattertype", "scatter type", "scatter_type", "type", "measurement type", "data type", "mode"];
        if is_kind.contains(&words.0.as_str()) {
            self.holds = holds(&words.1).or(self.holds);
        }
        self.source.push((shown(name), shown(&value)));
    }
}

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
    let digits = value.trim_end_matches(|c: char| c.is_alphabetic() || c == '°');
    let suffix = value[digits.len()..].parse().ok();
    let comma = Dialect { has_decimal_comma: digits.contains(',') && !digits.contains('.'), ..dialect };
    Some(Fixed { angle, value: comma.number(digits.trim())?, unit: suffix.or(unit) })
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
