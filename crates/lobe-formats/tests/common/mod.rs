//! Measured files and the answers of other implementations, which lie beside the project and not in it: in the folder
//! that the environment variable `LOBE_SHARED` names, else in `shared` beside the workspace. Tests of other crates take
//! this file in by its path.
#![allow(dead_code, reason = "every test program uses a part of this")]

use std::io::Write as _;
use std::path::{Path, PathBuf};

pub mod made;

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

/// The files of a folder, and of the folders in it, of at most 200 kB.
pub fn small_files(folder: &Path) -> Vec<PathBuf> {
    let of = |path: PathBuf| match path.is_dir() {
        true => small_files(&path),
        false => vec![path],
    };
    let is_small = |path: &PathBuf| path.metadata().is_ok_and(|metadata| metadata.len() <= 200_000);
    files(folder).into_iter().flat_map(of).filter(is_small).collect()
}

/// The queries of a golden file: the numbers left of `->`, and those right of it.
pub fn golden(path: &Path) -> Vec<(Vec<f64>, Vec<f64>)> {
    let numbers = |text: &str| text.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    let text = String::from_utf8(bytes(path)).expect("text");
    let lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    lines.map(|line| line.split_once("->").expect("an arrow")).map(|(q, a)| (numbers(q), numbers(a))).collect()
}

/// The three numbers of a direction at `at`.
pub fn direction(numbers: &[f64], at: usize) -> [f64; 3] {
    [numbers[at], numbers[at + 1], numbers[at + 2]]
}

/// The same, of length one to the last digit: some references printed single precision.
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

/// WINDOW files with their answers: those made for it, whose second column is the exact value, and real ones.
pub fn sheets(shared: &Path) -> [Vec<(PathBuf, PathBuf)>; 2] {
    let folder = shared.join("golden");
    let mut synthetic = Vec::new();
    for name in ["klems_quarter_columns", "klems_quarter_rows", "klems_half", "tensortree3", "tensortree4"] {
        let xml = folder.join(format!("{name}.xml"));
        match xml.is_file() {
            true => synthetic.push((xml, folder.join(format!("{name}.radiance.txt")))),
            false => println!("SKIPPED: {} is not there", xml.display()),
        }
    }
    let mut real = Vec::new();
    for answers in files(&folder) {
        let name = answers.file_name().expect("a name").to_string_lossy().into_owned();
        let Some(xml) = name.strip_prefix("real_").and_then(|name| name.strip_suffix(".radiance.txt")) else {
            continue;
        };
        let folders = ["klems_xml", "tensortree_xml"].map(|folder| shared.join("data").join(folder).join(xml));
        let xml = folders.into_iter().find(|path| path.is_file()).unwrap_or_else(|| panic!("{xml} is not there"));
        real.push((xml, answers));
    }
    [synthetic, real]
}
