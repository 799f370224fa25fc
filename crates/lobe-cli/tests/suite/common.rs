//! Running the program.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// A temporary folder.
pub struct Files(TempDir);

impl Files {
    pub fn new() -> Self {
        Files(tempfile::tempdir().expect("a temporary folder"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, content: &str) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a file");
        path
    }
}

pub fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

pub fn lobe(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lobe")).args(args).stdin(Stdio::null()).output().expect("the program")
}

/// The exit code, the output, and the message.
pub fn run(args: &[&str]) -> (i32, String, String) {
    let Output { status, stdout, stderr } = lobe(args);
    let utf8 = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (status.code().expect("an exit code"), utf8(stdout), utf8(stderr))
}

/// The output of a command, which has to succeed.
pub fn printed(args: &[&str]) -> String {
    let (code, printed, message) = run(args);
    assert_eq!(code, 0, "{args:?}: {message}");
    printed
}

/// The output of a command with `--json`.
pub fn json(args: &[&str]) -> serde_json::Value {
    serde_json::from_str(&printed(&[args, &["--json"]].concat())).expect("JSON")
}

/// A grey DDR file with constant values, and this albedo for light at 0, 40 and 80 degrees.
pub fn diffuse(albedos: [f64; 3]) -> String {
    let rows: String =
        albedos.iter().flat_map(|albedo| (0..3).map(move |_| format!("{albedo} {albedo} {albedo}\n"))).collect();
    format!(
        "Source Generated\nTypeSym ASymmetrical\nTypeColorModel BW\nsigma 3 0 40 80\nphi 3 0 180 360\ntheta 3 0 60 180\n\
         bw def\n{rows}enddef\n"
    )
}
