//! The figures of a report: one row for each backend, input and baseline.

use serde::Serialize;

/// One ratio.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Of the question, as in `lobe_benches::contest::QUESTIONS`.
    pub id: &'static str,
    /// Which backend, `-strict` where that is a form of its own.
    pub backend: &'static str,
    /// `coherent` or `incoherent`.
    pub input: &'static str,
    /// What it is compared with.
    pub baseline: &'static str,
    /// Nanoseconds a query.
    pub ns: f64,
    /// Nanoseconds a query of the baseline, in the same run.
    pub baseline_ns: f64,
    /// How many times the speed of the baseline: `baseline_ns / ns`.
    pub ratio: f64,
}

/// The rows of one question on one input.
pub fn of<'a>(rows: &'a [Row], id: &'a str, input: &'a str) -> impl Iterator<Item = &'a Row> {
    rows.iter().filter(move |row| row.id == id && row.input == input)
}

/// The row of one cell.
pub fn find<'a>(rows: &'a [Row], id: &str, input: &str, backend: &str, baseline: &str) -> Option<&'a Row> {
    rows.iter().find(|r| r.id == id && r.input == input && r.backend == backend && r.baseline == baseline)
}

/// The distinct names of a column, in order of appearance.
pub fn distinct<'a>(rows: impl Iterator<Item = &'a Row>, column: fn(&Row) -> &'static str) -> Vec<&'static str> {
    let mut names = Vec::new();
    for name in rows.map(column) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// A ratio with as many digits as it deserves.
pub fn times(ratio: f64) -> String {
    if ratio >= 100.0 {
        format!("{ratio:.0}×")
    } else if ratio >= 10.0 {
        format!("{ratio:.1}×")
    } else {
        format!("{ratio:.2}×")
    }
}

/// Nanoseconds with three digits.
pub fn nanoseconds(ns: f64) -> String {
    let decimals = if ns >= 100.0 {
        0
    } else if ns >= 10.0 {
        1
    } else {
        2
    };
    format!("{ns:.decimals$}")
}

/// A backend's name as it is shown.
pub fn shown(backend: &str) -> String {
    backend.replace('-', " ")
}
