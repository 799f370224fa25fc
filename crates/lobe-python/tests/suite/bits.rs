//! Strict values have the same bits in Rust, in Python, in C and from the program.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use lobe::{Backend, Material};
use lobe_testing::examples;
use lobe_testing::files::{fixture, shared_file};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg32;
use tempfile::TempDir;

use crate::package::Package;
use crate::{build, skipped};

/// Writes the values of each file to FILE.python.
const SCRIPT: &str = "
import sys, warnings
import numpy as np
import lobe_bsdf
warnings.simplefilter('ignore')
pairs, *files = sys.argv[1:]
wi, wo = np.fromfile(pairs, np.float32).reshape(2, -1, 3)
for file in files:
    lobe_bsdf.open(file, strict=True).eval(wi, wo).tofile(file + '.python')
";

/// Random pairs of directions of the whole sphere.
struct Pairs {
    wi: Vec<[f32; 3]>,
    wo: Vec<[f32; 3]>,
    /// Vectors of any length, for the program, which normalises them.
    text: PathBuf,
    /// The unit vectors.
    floats: PathBuf,
}

impl Pairs {
    fn new(folder: &Path, count: usize) -> Self {
        let mut rng = Pcg32::seed_from_u64(22);
        let mut vector = || loop {
            let v: [f64; 3] = [(); 3].map(|()| 2.0 * rng.random::<f64>() - 1.0);
            let square: f64 = v.iter().map(|c| c * c).sum();
            if (1e-4..1.0).contains(&square) {
                return v;
            }
        };
        let pairs: Vec<[[f64; 3]; 2]> = (0..count).map(|_| [vector(), vector()]).collect();
        let mut lines = String::new();
        for [[a, b, c], [d, e, f]] in &pairs {
            writeln!(lines, "{a:?},{b:?},{c:?},{d:?},{e:?},{f:?}").expect("a string");
        }
        let (wi, wo): (Vec<_>, Vec<_>) = pairs.iter().map(|[wi, wo]| (unit(*wi), unit(*wo))).unzip();
        let bytes: Vec<u8> = wi.iter().chain(&wo).flatten().flat_map(|c| c.to_ne_bytes()).collect();
        let (text, floats) = (folder.join("pairs.csv"), folder.join("pairs.f32"));
        std::fs::write(&text, lines).expect("a file");
        std::fs::write(&floats, bytes).expect("a file");
        Pairs { wi, wo, text, floats }
    }
}

/// The unit vector that the program computes: scaled by the largest component first, and rounded once.
fn unit(v: [f64; 3]) -> [f32; 3] {
    let largest = v.iter().fold(0.0_f64, |largest, c| largest.max(c.abs()));
    let v = v.map(|c| c / largest);
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    v.map(|c| (c / length) as f32)
}

/// A file, and its values according to the library.
struct Case {
    name: String,
    file: PathBuf,
    expected: Vec<f32>,
}

impl Case {
    /// `None` if the file has no values for pairs of directions.
    fn new(folder: &Path, name: String, content: &[u8], pairs: &Pairs) -> Option<Self> {
        let file = folder.join(&name);
        std::fs::write(&file, content).expect("a file");
        let material = Material::open(&file).ok()?.with_backend(Backend::detect().expect("a backend").strict());
        let mut expected = vec![f32::NAN; pairs.wi.len() * material.channel_count()];
        material.eval_batch(&pairs.wi, &pairs.wo, &mut expected);
        assert!(expected.iter().all(|value| value.is_finite()), "{name}: values that are not finite");
        assert!(expected.iter().any(|value| *value != 0.0), "{name}: all values are 0");
        Some(Case { name, file, expected })
    }

    fn compare(&self, language: &str, found: &[f32]) {
        assert_eq!(found.len(), self.expected.len(), "{}, {language}: number of values", self.name);
        let differ = |at: &usize| found[*at].to_bits() != self.expected[*at].to_bits();
        let differing: Vec<usize> = (0..found.len()).filter(differ).collect();
        if let Some(&first) = differing.first() {
            panic!(
                "{}: {} of {} values differ in {language}; value {first} is {:e}, but {:e} in Rust",
                self.name,
                differing.len(),
                found.len(),
                found[first],
                self.expected[first]
            );
        }
    }

    /// Compares the floats that another program wrote next to the file.
    fn compare_written(&self, language: &str, end: &str) {
        let file = PathBuf::from(format!("{}.{end}", self.file.display()));
        let bytes = std::fs::read(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let floats: Vec<f32> = bytes.as_chunks().0.iter().map(|bytes| f32::from_ne_bytes(*bytes)).collect();
        assert_eq!(4 * floats.len(), bytes.len(), "{}", file.display());
        self.compare(language, &floats);
    }

    fn compare_with_program(&self, program: &Path, pairs: &Pairs) {
        let mut command = Command::new(program);
        command.arg("eval").arg(&self.file).arg("--pairs").arg(&pairs.text).arg("--strict");
        let text = printed(&mut command);
        let values = text.lines().flat_map(|line| line.split(',')).map(|word| word.parse().expect("a number"));
        self.compare("the program", &values.collect::<Vec<_>>());
    }
}

/// The output of a command, which has to succeed.
fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {}\n{said}", output.status);
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The program in C, linked with the library that cargo has built; the reason if it cannot be compiled.
fn compiled(folder: &Path) -> Result<PathBuf, String> {
    if cfg!(windows) || Command::new("cc").arg("--version").output().is_err() {
        return Err("there is no cc".into());
    }
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = folder.join("bits");
    let mut cc = Command::new("cc");
    cc.args(["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I"]).arg(here.join("../lobe-c/include"));
    cc.arg(here.join("tests/suite/bits.c")).arg(build::library("lobe_c")).arg("-o").arg(&program);
    printed(&mut cc);
    Ok(program)
}

fn compare(cases: &[Case], pairs: &Pairs, folder: &Path) {
    let files = || cases.iter().map(|case| &case.file);
    match Package::new(&["numpy"]) {
        Ok(package) => {
            printed(package.python().args(["-c", SCRIPT]).arg(&pairs.floats).args(files()));
            cases.iter().for_each(|case| case.compare_written("Python", "python"));
        }
        Err(why) => skipped(&format!("bits in Python: {why}")),
    }
    match compiled(folder) {
        Ok(program) => {
            printed(Command::new(program).arg(&pairs.floats).args(files()));
            cases.iter().for_each(|case| case.compare_written("C", "c"));
        }
        Err(why) => skipped(&format!("bits in C: {why}")),
    }
    if let Some(program) = build::program() {
        cases.iter().for_each(|case| case.compare_with_program(&program, pairs));
    }
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn values_have_the_same_bits_in_every_language() {
    let folder = folder();
    let pairs = Pairs::new(folder.path(), 100_000);
    let fixtures = ["conductor-7x8x13.ddr", "paint-12x21x13.ddr", "cloth-17x7x17x13.ddr"].map(fixture);
    let measured = [
        "rgl_bsdf/cc_ibiza_sunset_rgb.bsdf",
        "zemax_bsdf/IMX455.bsdf",
        "klems_xml/2011-SA1.XML",
        "tensortree_xml/blindsT3.xml",
        "kaist_pbsdf/spectralon_lowres.pbsdf",
        "cornell_brdf/garnet_red.brdf",
        "mdl_mbsdf/carpaint_red.mbsdf",
    ];
    let measured = measured.into_iter().filter_map(|name| shared_file(&format!("data/{name}")));
    let case = |file: PathBuf| {
        let name = file.file_name().expect("a name").to_string_lossy().into_owned();
        let content = std::fs::read(&file).expect("a file");
        Case::new(folder.path(), name, &content, &pairs).unwrap_or_else(|| panic!("{}: not opened", file.display()))
    };
    let cases: Vec<Case> = fixtures.into_iter().chain(measured).map(case).collect();
    compare(&cases, &pairs, folder.path());
}

#[test]
fn files_of_every_format_have_the_same_bits_in_every_language() {
    let folder = folder();
    let pairs = Pairs::new(folder.path(), 5_000);
    let case = |(at, (format, content)): (usize, (lobe_formats::Format, Vec<u8>))| {
        let extension = format.spec().extensions.first().unwrap_or(&"txt");
        Case::new(folder.path(), format!("{at}.{extension}"), &content, &pairs)
    };
    let cases: Vec<Case> = examples::all().into_iter().enumerate().filter_map(case).collect();
    assert!(cases.len() > 25, "only {} files were opened", cases.len());
    compare(&cases, &pairs, folder.path());
}
