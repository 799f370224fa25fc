//! Checks whether a measurement is sound, and reports what it covers.
//!
//! [`check`] runs every check that applies to a file and reports a list of [`Finding`]s: sentences with numbers.
//! Impossible values, such as an albedo above 1, fail. Suspicious ones are warnings. Facts that a user of the data
//! should know are notes.

mod azimuths;
mod coverage;
mod energy;
mod exchange;
mod finding;
mod grid;
mod guesses;
mod horizon;
mod realisable;
mod values;

use lobe_formats::Document;

use crate::Subject;
pub(crate) use coverage::is_in_plane;
use finding::part_name;
use grid::Grid;

pub use finding::{Finding, Status, Thoroughness};
pub use guesses::guesses;

/// Checks a file. `progress` is called from time to time with the finished share.
///
/// Knots that do not ascend and values that are NaN do not occur here: readers refuse such files and name the line.
pub fn check(subject: &Subject, thoroughness: &Thoroughness, progress: impl Fn(f64)) -> Vec<Finding> {
    let mut findings = values::check(&subject.document);
    for (part, grid) in grids(&subject.document) {
        findings.extend(grid.check_knots(&part));
        findings.extend(grid.check_pole(&part));
        findings.extend(azimuths::check(&grid, &part));
    }
    findings.extend(horizon::check(&subject.document));
    findings.extend(realisable::check(&subject.document));
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

/// The grids of a file, and their names.
fn grids(document: &Document) -> Vec<(String, Grid<'_>)> {
    let grid = |part| Some((part_name(document, part), Grid(part.data.representation().grid()?)));
    document.parts.iter().filter_map(grid).collect()
}

#[cfg(test)]
mod tests;
