//! Files of measurements and of reference answers, which lie beside the project where they are at all.
#![allow(dead_code, reason = "every test program uses a part of this")]

use std::path::{Path, PathBuf};

/// The folder `LOBE_SHARED`, or `shared` beside the workspace; says so where there is none.
pub fn folder(below: &str) -> Option<PathBuf> {
    let root = std::env::var_os("LOBE_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from);
    let folder = root.join(below);
    if !folder.is_dir() {
        println!("SKIPPED: {} is not there", folder.display());
        return None;
    }
    Some(folder)
}

/// The bytes of a file that has to be there.
pub fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// All files of a folder, by name.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a folder entry").path()).collect();
    files.sort();
    files
}

/// One line of a golden file: `numbers -> numbers`.
pub struct Answer {
    pub input: Vec<f64>,
    pub output: Vec<f64>,
}

/// All lines of a golden file.
pub fn answers(path: &Path) -> Vec<Answer> {
    let text = String::from_utf8(bytes(path)).expect("text");
    let numbers = |side: &str| side.split_whitespace().map(|n| n.parse().expect("a number")).collect();
    let lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    lines
        .map(|line| {
            let (input, output) = line.split_once("->").expect("an arrow");
            Answer { input: numbers(input), output: numbers(output) }
        })
        .collect()
}

/// The two directions of a line.
pub fn directions(answer: &Answer) -> ([f64; 3], [f64; 3]) {
    let n = &answer.input;
    ([n[0], n[1], n[2]], [n[3], n[4], n[5]])
}
