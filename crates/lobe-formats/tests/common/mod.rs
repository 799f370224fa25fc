//! Where measured files and the answers of other implementations lie: in the folder that the environment variable
//! `LOBE_SHARED` names, else in `shared` beside the workspace. Tests of other crates take this file in by its path.

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
