//! Compares materials in lanes with the answers of the programs that define their formats.
//!
//! The answers and the measured files are not part of the project: they are in the folder named by the environment
//! variable `LOBE_SHARED`, or in `shared` next to the workspace.

mod answers;
mod cases;

use std::path::{Path, PathBuf};

use lobe::Backend;
use serde::Serialize;

/// One file, compared with another program's answers.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The file.
    pub file: String,
    /// The reader of the file.
    pub reader: String,
    /// The program that answered.
    pub against: &'static str,
    /// Number of pairs of directions compared.
    pub pairs: usize,
    /// The largest difference found.
    pub error: f64,
    /// What the difference is relative to.
    pub of: Measure,
    /// The largest difference that is allowed.
    pub bound: f64,
}

/// What a difference is relative to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// The largest value of the file.
    Largest,
    /// The value itself.
    Value,
    /// Nothing: the difference is absolute.
    Absolute,
}

impl Measure {
    /// As words.
    pub fn name(self) -> &'static str {
        match self {
            Measure::Largest => "of the largest value",
            Measure::Value => "of the value",
            Measure::Absolute => "absolute",
        }
    }
}

impl Comparison {
    /// `true` if all values agree.
    pub fn ok(&self) -> bool {
        self.error <= self.bound
    }
}

/// The folder of the answers.
pub fn folder() -> PathBuf {
    std::env::var_os("LOBE_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from)
}

/// Compares every file for which there are answers on this backend; empty if there are none.
///
/// # Errors
/// If a file cannot be read or has no such answers.
pub fn compare(backend: Backend) -> anyhow::Result<Vec<Comparison>> {
    let shared = folder();
    let Ok(entries) = std::fs::read_dir(shared.join("golden")) else { return Ok(Vec::new()) };
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.sort();
    let mut comparisons = Vec::new();
    for answers in files {
        let name = answers.file_name().unwrap_or_default().to_string_lossy().into_owned();
        comparisons.extend(cases::compare(backend, &shared, &answers, &name)?);
    }
    comparisons.sort_by(|a, b| (&a.reader, &a.file).cmp(&(&b.reader, &b.file)));
    Ok(comparisons)
}
