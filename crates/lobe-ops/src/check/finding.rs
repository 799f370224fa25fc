//! The findings of checks, in words and numbers.

use std::collections::BTreeMap;
use std::fmt;

use lobe_formats::{Document, Part};
use lobe_table::{Aspect, Side};
use serde::Serialize;

/// The severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// In order.
    Pass,
    /// Worth knowing.
    Note,
    /// Probably a mistake.
    Warn,
    /// Impossible.
    Fail,
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Status::Pass => "pass",
            Status::Note => "note",
            Status::Warn => "warn",
            Status::Fail => "FAIL",
        })
    }
}

/// One finding of a check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The check that found it.
    pub check: &'static str,
    /// The part of the file; empty if there is only one.
    pub part: String,
    /// The severity of the finding.
    pub status: Status,
    /// The finding in words.
    pub text: String,
    /// The numbers in the text, by name.
    pub numbers: BTreeMap<&'static str, f64>,
}

impl Finding {
    pub(super) fn new(check: &'static str, part: &str, status: Status, text: String) -> Self {
        Finding { check, part: part.into(), status, text, numbers: BTreeMap::new() }
    }

    pub(super) fn number(mut self, name: &'static str, value: f64) -> Self {
        self.numbers.insert(name, value);
        self
    }
}

/// The effort of checks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thoroughness {
    /// The most directions of the light for which integrals are computed, evenly chosen.
    pub incidences: usize,
    /// The largest number of directions per integral.
    pub evaluations: usize,
    /// The error of an integral: absolute, but relative above 1.
    pub tolerance: f64,
    /// The number of pairs of directions that are exchanged.
    pub pairs: usize,
}

impl Default for Thoroughness {
    fn default() -> Self {
        Thoroughness { incidences: 160, evaluations: 200_000, tolerance: 1e-3, pairs: 20_000 }
    }
}

/// The name of a part of a sheet; empty if it is the only one.
pub(super) fn part_name(document: &Document, part: &Part) -> String {
    if !document.is_sheet() {
        return String::new();
    }
    let data = part.data.representation();
    let aspect = Aspect { scatter: data.scatter(), light: part.side.unwrap_or(Side::Front) };
    let kind = if data.is_delta() { "mirror " } else { "" };
    format!("{} {kind}{aspect}", part.name).trim().into()
}

/// A share in per cent, with as many digits as it needs.
pub(super) fn percent(share: f64) -> String {
    match 100.0 * share {
        percent if percent == 0.0 || percent >= 10.0 => format!("{percent:.0} %"),
        percent if percent >= 0.1 => format!("{percent:.1} %"),
        percent => format!("{percent:.1e} %"),
    }
}

/// Degrees to a tenth, without a zero at the end.
pub(super) fn degrees(radians: f64) -> String {
    let rounded = (radians.to_degrees() * 10.0).round() / 10.0;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}
