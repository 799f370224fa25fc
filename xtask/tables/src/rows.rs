//! The figures of a report: one row for each backend, input and baseline.

use serde::{Deserialize, Serialize};

/// One ratio.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Id of the question, as in `lobe_benches::contest::QUESTIONS`.
    pub id: String,
    /// The backend, with `-strict` if that is a separate form.
    pub backend: String,
    /// `coherent` or `incoherent`.
    pub input: String,
    /// The baseline with which it is compared.
    pub baseline: String,
    /// Nanoseconds per query.
    pub ns: f64,
    /// Nanoseconds per query of the baseline, in the same run.
    pub baseline_ns: f64,
    /// How many times as fast as the baseline: `baseline_ns / ns`.
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
pub fn distinct<'a>(rows: impl Iterator<Item = &'a Row>, column: fn(&Row) -> &str) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for name in rows.map(column) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// A backend's displayed name.
pub fn shown(backend: &str) -> String {
    backend.replace('-', " ")
}
