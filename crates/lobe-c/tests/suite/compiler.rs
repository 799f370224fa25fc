//! The compilers of this machine, and the library with which programs are linked.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A language, and the program that compiles it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    C,
    Cpp,
}

impl Language {
    fn compiler(self) -> &'static str {
        match self {
            Language::C => "cc",
            Language::Cpp => "c++",
        }
    }

    fn flags(self) -> &'static [&'static str] {
        match self {
            Language::C => &["-std=c11", "-D_POSIX_C_SOURCE=200809L"],
            Language::Cpp => &["-std=c++17"],
        }
    }
}

/// Reports that a test, or part of one, is skipped. It bypasses the test harness, which hides the output of passing
/// tests.
fn skipped(why: &str) {
    // A test must not fail because standard error is closed.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {why}");
}

/// `true` if a program is available; prints a note if not.
pub fn has(program: &str) -> bool {
    let is_there = Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
    if !is_there {
        skipped(&format!("there is no {program}"));
    }
    is_there
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The static library, which cargo has built next to this program.
fn library() -> PathBuf {
    let deps = std::env::current_exe().expect("this program");
    let deps = deps.parent().expect("its folder");
    let found = std::fs::read_dir(deps).expect("its files").map_while(Result::ok).map(|entry| entry.path());
    let is_it = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.starts_with("liblobe_c") && name.ends_with(".a")
    };
    let newest = found.filter(is_it).max_by_key(|path| path.metadata().and_then(|metadata| metadata.modified()).ok());
    newest.unwrap_or_else(|| panic!("no static library in {}", deps.display()))
}

/// Compiles a program with warnings as errors; `None`, and a note, if there is no compiler, or it does not know a flag.
pub fn compiled(language: Language, source: &Path, flags: &[&str], out: &Path) -> Option<PathBuf> {
    let compiler = language.compiler();
    if cfg!(windows) || !has(compiler) {
        return None;
    }
    if !flags.is_empty() && !knows(compiler, flags, out) {
        skipped(&format!("{compiler} cannot build programs with {}", flags.join(" ")));
        return None;
    }
    let program = out.join(source.file_stem().expect("a name")).with_extension("program");
    let mut command = Command::new(compiler);
    command.args(language.flags()).args(["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-g", "-O1"]).args(flags);
    command.arg("-I").arg(root().join("include")).arg(source).arg(library()).arg("-o").arg(&program);
    // System libraries that Rust needs.
    let system: &[&str] = match cfg!(target_os = "macos") {
        true => &["-framework", "CoreFoundation", "-lm"],
        false => &["-lpthread", "-ldl", "-lm", "-lrt", "-lgcc_s", "-lutil"],
    };
    let output = command.args(system).output().expect("a compiler");
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    Some(program)
}

/// `true` if programs that the compiler builds with these flags run.
fn knows(compiler: &str, flags: &[&str], out: &Path) -> bool {
    let (source, program) = (out.join("probe.c"), out.join("probe"));
    std::fs::write(&source, "int main(void) { return 0; }\n").expect("a folder to write to");
    let made = Command::new(compiler).args(flags).arg("-x").arg("c").arg(&source).arg("-o").arg(&program).output();
    made.is_ok_and(|made| made.status.success())
        && Command::new(&program).output().is_ok_and(|output| output.status.success())
}

/// An example of the crate.
pub fn example(name: &str) -> PathBuf {
    root().join("examples").join(name)
}

/// A program of the tests.
pub fn test_program(name: &str) -> PathBuf {
    root().join("tests/suite/programs").join(name)
}
