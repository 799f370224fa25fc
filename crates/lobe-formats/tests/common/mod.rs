//! Golden vectors: what other implementations answered on given files and pairs of directions.
//!
//! They lie in a folder that the environment variable `LOBE_SHARED` names, else in `shared` beside the workspace. Tests
//! of other crates take this file in by its path.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// The folder with `golden` and `data` in it; says so where there is none.
pub fn shared() -> Option<PathBuf> {
    let folder = std::env::var_os("LOBE_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from);
    if folder.join("golden").is_dir() {
        return Some(folder);
    }
    // Written past the test harness, which would swallow what a passing test prints.
    let _ = writeln!(std::io::stderr(), "SKIPPED: no golden vectors in {}; set LOBE_SHARED", folder.display());
    None
}

/// One query and the answer of the other implementation.
pub struct Pair {
    /// The direction to the light.
    pub wi: [f64; 3],
    /// The direction to the viewer.
    pub wo: [f64; 3],
    /// The value of each channel.
    pub values: Vec<f64>,
}

/// Reads lines `wi.x wi.y wi.z wo.x wo.y wo.z -> value...`; lines that start with `#` are comments.
pub fn pairs(path: &Path) -> Vec<Pair> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let numbers = |text: &str| -> Vec<f64> { text.split_whitespace().map(|word| word.parse().unwrap()).collect() };
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let (query, answer) = line.split_once("->").unwrap();
            let query = numbers(query);
            Pair { wi: query[..3].try_into().unwrap(), wo: query[3..].try_into().unwrap(), values: numbers(answer) }
        })
        .collect()
}
