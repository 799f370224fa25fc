//! Reads the answers of other programs: text files with one query and one answer per line, `query -> answer`.

use std::path::{Path, PathBuf};

use crate::files::{bytes, files};

/// The queries and answers of a golden file: the numbers left of each `->`, and those right of it.
pub fn queries(path: &Path) -> Vec<(Vec<f64>, Vec<f64>)> {
    let numbers = |text: &str| text.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    let text = String::from_utf8(bytes(path)).expect("text");
    let lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    lines.map(|line| line.split_once("->").expect("an arrow")).map(|(q, a)| (numbers(q), numbers(a))).collect()
}

/// The three numbers of a direction at `at`.
pub fn direction(numbers: &[f64], at: usize) -> [f64; 3] {
    [numbers[at], numbers[at + 1], numbers[at + 2]]
}

/// The same, normalised in `f64`, because some references printed single precision.
pub fn unit(numbers: &[f64], at: usize) -> [f64; 3] {
    let d = direction(numbers, at);
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    d.map(|x| x / length)
}

/// The largest deviation found, and its query.
#[derive(Default, Debug)]
pub struct Worst {
    /// The deviation; NaN if any deviation was NaN.
    pub error: f64,
    /// The query that it belongs to.
    pub at: usize,
}

impl Worst {
    /// Records the deviation of query `at`.
    pub fn see(&mut self, error: f64, at: usize) {
        if error.is_nan() || error > self.error {
            *self = Worst { error, at };
        }
    }
}

/// `|a - b|` relative to `|b|`, or to `floor` if that is larger.
pub fn relative(a: f64, b: f64, floor: f64) -> f64 {
    (a - b).abs() / b.abs().max(floor)
}

/// WINDOW files with their answers: synthetic ones, whose second column is the exact value, and real ones.
pub fn sheets(shared: &Path) -> [Vec<(PathBuf, PathBuf)>; 2] {
    let folder = shared.join("golden");
    let mut synthetic = Vec::new();
    for name in ["klems_quarter_columns", "klems_quarter_rows", "klems_half", "tensortree3", "tensortree4"] {
        let xml = folder.join(format!("{name}.xml"));
        match xml.is_file() {
            true => synthetic.push((xml, folder.join(format!("{name}.radiance.txt")))),
            false => println!("SKIPPED: {} is missing", xml.display()),
        }
    }
    let mut real = Vec::new();
    for answers in files(&folder) {
        let name = answers.file_name().expect("a name").to_string_lossy().into_owned();
        let Some(xml) = name.strip_prefix("real_").and_then(|name| name.strip_suffix(".radiance.txt")) else {
            continue;
        };
        let folders = ["klems_xml", "tensortree_xml"].map(|folder| shared.join("data").join(folder).join(xml));
        let xml = folders.into_iter().find(|path| path.is_file()).unwrap_or_else(|| panic!("{xml} is missing"));
        real.push((xml, answers));
    }
    [synthetic, real]
}
