//! Golden vectors and real files, which lie beside the project and not in it.
#![allow(dead_code, reason = "every test file uses its own part of this")]

use std::fs;
use std::path::{Path, PathBuf};

/// The folder of shared test data, or `None`, printed, where this machine has none.
pub fn shared() -> Option<PathBuf> {
    let folder = match std::env::var_os("LOBE_SHARED") {
        Some(folder) => PathBuf::from(folder),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"),
    };
    if folder.join("golden").is_dir() {
        return Some(folder);
    }
    println!("SKIPPED: no golden vectors in {}; set LOBE_SHARED", folder.display());
    None
}

/// The queries of a golden file: the numbers left of `->`, and those right of it.
pub fn golden(path: &Path) -> Vec<(Vec<f64>, Vec<f64>)> {
    let numbers = |text: &str| text.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    let text = fs::read_to_string(path).expect("golden file");
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split_once("->").expect("an arrow")).map(|(q, a)| (numbers(q), numbers(a))).collect()
}

/// The three numbers of a direction at `at`.
pub fn direction(numbers: &[f64], at: usize) -> [f64; 3] {
    [numbers[at], numbers[at + 1], numbers[at + 2]]
}

/// The same, of length one to the last digit: the reference printed single precision.
pub fn unit(numbers: &[f64], at: usize) -> [f64; 3] {
    let d = direction(numbers, at);
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    d.map(|x| x / length)
}

/// The largest deviation seen, and where.
#[derive(Default, Debug)]
pub struct Worst {
    pub error: f64,
    pub at: usize,
}

impl Worst {
    pub fn see(&mut self, error: f64, at: usize) {
        if error.is_nan() || error > self.error {
            *self = Worst { error, at };
        }
    }
}

/// |a - b| relative to b, where values below `floor` count as `floor`.
pub fn relative(a: f64, b: f64, floor: f64) -> f64 {
    (a - b).abs() / b.abs().max(floor)
}
