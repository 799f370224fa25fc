//! Checks that all backends give the same bits, and shows the result as one table of the page.

use std::fs::File;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};
use serde::{Deserialize, Serialize};

/// The name of the section.
pub const ID: &str = "equivalence";

/// The result of the equivalence check.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct EquivalenceSummary {
    /// One line per check: what was compared, and the outcome.
    pub rows: Vec<[String; 2]>,
    /// `true` if all checks passed.
    pub ok: bool,
}

/// Runs the check, which is a separate program, and reads its summary.
///
/// # Errors
/// If it cannot be built or run; a check that fails is not an error here.
pub fn summary(out: &Path) -> anyhow::Result<EquivalenceSummary> {
    let path = out.join("equivalence.json");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["run", "--release", "--quiet", "--package", "xtask-equivalence", "--", "--summary"]).arg(&path);
    let status = cargo.status().context("cannot run cargo")?;
    ensure!(status.success(), "the equivalence check did not run");
    let file = File::open(&path).with_context(|| format!("cannot read {}", path.display()))?;
    serde_json::from_reader(file).with_context(|| format!("{}: not a summary", path.display()))
}

/// Prints it.
pub fn print(summary: &EquivalenceSummary) {
    println!("\nEquivalence of the backends");
    for [what, found] in &summary.rows {
        println!("{what}: {found}");
    }
    println!("{}", if summary.ok { "All checks passed." } else { "Some checks failed." });
}
