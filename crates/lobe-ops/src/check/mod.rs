//! Is a measurement sound, and what does it cover?
//!
//! [`check`] looks at a file in every way that it can, and says what it found in sentences with numbers: a list of
//! [`Finding`]s. What cannot be, such as an albedo above 1, fails. What is suspicious is a warning. What one has to know
//! before using the data is a note.

mod azimuths;
mod coverage;
mod energy;
mod exchange;
mod grid;
mod values;

use std::collections::BTreeMap;
use std::fmt;

use lobe_formats::{Document, Part};
use lobe_table::{Aspect, Side};
use serde::Serialize;

use crate::Subject;
use grid::Grid;

/// What to make of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// As it should be.
    Pass,
    /// Worth knowing.
    Note,
    /// Probably not what was meant.
    Warn,
    /// Cannot be.
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

/// One thing that was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Which of the checks found it.
    pub check: &'static str,
    /// Of which part of the file; empty where there is one only.
    pub part: String,
    /// What to make of it.
    pub status: Status,
    /// The finding in words.
    pub text: String,
    /// The numbers in it, by name.
    pub numbers: BTreeMap<&'static str, f64>,
}

impl Finding {
    fn new(check: &'static str, part: &str, status: Status, text: String) -> Self {
        Finding { check, part: part.into(), status, text, numbers: BTreeMap::new() }
    }

    fn number(mut self, name: &'static str, value: f64) -> Self {
        self.numbers.insert(name, value);
        self
    }
}

/// How much a check may cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thoroughness {
    /// At most this many directions of the light are integrated over, evenly chosen.
    pub incidences: usize,
    /// Directions of an integral.
    pub evaluations: usize,
    /// The error of an integral, absolute, but relative above 1.
    pub tolerance: f64,
    /// Pairs of directions that are exchanged.
    pub pairs: usize,
}

impl Default for Thoroughness {
    fn default() -> Self {
        Thoroughness { incidences: 160, evaluations: 200_000, tolerance: 1e-3, pairs: 20_000 }
    }
}

/// Checks a file. `progress` is told the share that is done, now and then.
///
/// Knots that do not ascend and values that are no numbers do not get this far: the reader refuses such a file and says
/// where they are.
pub fn check(subject: &Subject, thoroughness: &Thoroughness, progress: impl Fn(f64)) -> Vec<Finding> {
    let mut findings = values::check(&subject.document);
    for (part, grid) in grids(&subject.document) {
        findings.extend(grid.check_knots(&part));
        findings.extend(grid.check_pole(&part));
        findings.extend(azimuths::check(&grid, &part));
    }
    findings.extend(coverage::check(&subject.document));
    findings.extend(energy::check(subject, thoroughness, |done| progress(0.9 * done)));
    findings.extend(exchange::check(subject, thoroughness));
    progress(1.0);
    findings
}

/// The worst of the findings.
pub fn worst(findings: &[Finding]) -> Status {
    findings.iter().map(|finding| finding.status).max().unwrap_or(Status::Pass)
}

/// The grids of a file, and what they are called.
fn grids(document: &Document) -> Vec<(String, Grid<'_>)> {
    let grid = |part| Some((part_name(document, part), Grid(part.data.representation().grid()?)));
    document.parts.iter().filter_map(grid).collect()
}

/// What a part of a sheet is called; nothing if it is all that there is.
fn part_name(document: &Document, part: &Part) -> String {
    if !document.is_sheet() {
        return String::new();
    }
    let data = part.data.representation();
    let aspect = Aspect { scatter: data.scatter(), light: part.side.unwrap_or(Side::Front) };
    let kind = if data.mirror().is_some() { "mirror " } else { "" };
    format!("{} {kind}{aspect}", part.name).trim().into()
}

/// A share in per cent, with as many digits as it needs.
fn percent(share: f64) -> String {
    match 100.0 * share {
        percent if percent == 0.0 || percent >= 10.0 => format!("{percent:.0} %"),
        percent if percent >= 0.1 => format!("{percent:.1} %"),
        percent => format!("{percent:.1e} %"),
    }
}

/// Degrees to a tenth, without a zero at the end.
fn degrees(radians: f64) -> String {
    let rounded = (radians.to_degrees() * 10.0).round() / 10.0;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}

#[cfg(test)]
mod tests;
