//! What cargo has built next to this program.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
use std::path::PathBuf;

/// The folder of this program and of the libraries.
fn libraries() -> PathBuf {
    let program = std::env::current_exe().expect("this program");
    program.parent().expect("its folder").to_owned()
}

/// A shared library of the workspace, by the name of its crate.
///
/// # Panics
/// If it does not exist.
pub fn library(name: &str) -> PathBuf {
    let library = libraries().join(format!("{DLL_PREFIX}{name}{DLL_SUFFIX}"));
    assert!(library.is_file(), "cargo has not built {}", library.display());
    library
}

/// The program `lobe`, which is built together with the tests of the workspace; `None`, and a note, if it is missing.
pub fn program() -> Option<PathBuf> {
    let program = libraries().parent()?.join(format!("lobe{EXE_SUFFIX}"));
    if program.is_file() {
        return Some(program);
    }
    super::skipped("comparisons with the program lobe; `cargo test --workspace` builds it");
    None
}

/// The folder in which `cargo xtask python` and `cargo xtask ci` create an environment.
pub fn environment() -> PathBuf {
    libraries().ancestors().nth(2).expect("the target folder").join("python")
}
