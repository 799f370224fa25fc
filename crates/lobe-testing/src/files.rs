//! Paths of test files: fixtures in the repository, and measured files next to it.
//!
//! Measured files and the answers of other programs are not part of the project. They are in the folder named by the
//! environment variable `LOBE_SHARED`, or in `shared` next to the repository. A test that needs a missing file passes,
//! and reports on standard error that it was skipped.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// The folder with the fixtures of the repository.
pub fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures")
}

/// A fixture of the repository, by its name or its path in `fixtures`.
pub fn fixture(name: &str) -> PathBuf {
    fixtures().join(name)
}

/// The folder that holds `golden` and `data`, if it exists.
pub fn find_shared() -> Option<PathBuf> {
    let folder = shared_folder();
    folder.join("golden").is_dir().then_some(folder)
}

/// The folder that holds `golden` and `data`; reports the test as skipped if it does not exist.
pub fn shared() -> Option<PathBuf> {
    let folder = find_shared();
    if folder.is_none() {
        skipped(&format!("no measured files in {}", shared_folder().display()));
    }
    folder
}

/// A file or folder of the shared folder, by its path in it; reports the test as skipped if it is missing.
pub fn shared_file(path: &str) -> Option<PathBuf> {
    let file = shared_folder().join(path);
    if file.exists() {
        return Some(file);
    }
    skipped(&format!("{} is missing", file.display()));
    None
}

fn shared_folder() -> PathBuf {
    std::env::var_os("LOBE_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from)
}

/// Reports that a test, or part of one, is skipped. It bypasses the test harness, which hides the output of passing
/// tests.
fn skipped(why: &str) {
    // A test must not fail because standard error is closed.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {why}; set LOBE_SHARED to the folder with `golden` and `data`");
}

/// The bytes of a file that must exist.
///
/// # Panics
/// If it cannot be read.
pub fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Everything in a folder, sorted by name.
///
/// # Panics
/// If the folder cannot be read.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a folder entry").path()).collect();
    files.sort();
    files
}

/// The files of a folder, and of the folders in it, of at most 200 kB.
pub fn small_files(folder: &Path) -> Vec<PathBuf> {
    let of = |path: PathBuf| match path.is_dir() {
        true => small_files(&path),
        false => vec![path],
    };
    let is_small = |path: &PathBuf| path.metadata().is_ok_and(|metadata| metadata.len() <= 200_000);
    files(folder).into_iter().flat_map(of).filter(is_small).collect()
}
