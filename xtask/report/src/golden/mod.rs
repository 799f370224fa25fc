//! Materials in lanes beside the answers of the programs that define their formats.
//!
//! The answers, and the measured files, lie beside the project and not in it: in the folder that the environment variable
//! `LOBE_SHARED` names, else in `shared` beside the workspace.

mod answers;
mod cases;

use std::path::{Path, PathBuf};

use lobe::Backend;
use serde::Serialize;

/// One file and what another program made of it.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// The file.
    pub file: String,
    /// What read it.
    pub reader: String,
    /// The program that answered.
    pub against: &'static str,
    /// How many pairs of directions were compared.
    pub pairs: usize,
    /// The largest difference found.
    pub error: f64,
    /// In parts of what.
    pub of: Measure,
    /// What is allowed.
    pub bound: f64,
}

/// In parts of what a difference is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// The largest value of the file.
    Largest,
    /// The value itself.
    Value,
    /// None: it is the difference as it is.
    Absolute,
}

impl Measure {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Measure::Largest => "of the largest value",
            Measure::Value => "of the value",
            Measure::Absolute => "absolute",
        }
    }
}

impl Comparison {
    /// Whether all values agree.
    pub fn ok(&self) -> bool {
        self.error <= self.bound
    }
}

/// Where the answers are.
pub fn folder() -> PathBuf {
    std::env::var_os("LOBE_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from)
}

/// Compares every file that there are answers for, on this backend; nothing where there are none.
///
/// # Errors
/// Where a file cannot be read or has no such answers.
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
