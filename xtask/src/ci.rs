//! `cargo xtask ci`: runs the checks that a change must pass.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;

use super::counts::Counts;
use super::{cargo, python};

pub const ABOUT: &str = "Run the checks that a change must pass: format, lints, documentation, and last the tests";

/// A step before the tests.
struct Step {
    /// The arguments to cargo.
    arguments: &'static [&'static str],
    /// Flags of rustdoc.
    doc_flags: &'static str,
}

const fn step(arguments: &'static [&'static str]) -> Step {
    Step { arguments, doc_flags: "" }
}

/// The quick report comes before `asm`, which checks the same programs. `cargo xtask python`, which needs packages of
/// Python, is a step of the public workflow.
const STEPS: [Step; 6] = [
    step(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]),
    Step { arguments: &["doc", "--workspace", "--no-deps", "--quiet"], doc_flags: "-D warnings" },
    step(&["xtask", "fixtures", "--check"]),
    step(&["xtask", "report", "--quick"]),
    step(&["xtask", "equivalence"]),
    step(&["xtask", "asm", "--package", "xtask-report"]),
];

pub fn run(arguments: &[String]) -> ExitCode {
    if let Some(unknown) = arguments.first() {
        println!("{ABOUT}\n\nUsage: cargo xtask ci");
        return if ["-h", "--help"].contains(&unknown.as_str()) { ExitCode::SUCCESS } else { ExitCode::from(2) };
    }
    let begun = Instant::now();
    // It is ready long before the tests that need it.
    let environment = std::thread::spawn(python::for_tests);
    println!("\n== rustfmt --check");
    if !is_formatted() {
        eprintln!("not every file is formatted, or git or rustfmt cannot be run");
        return ExitCode::FAILURE;
    }
    for Step { arguments, doc_flags } in STEPS {
        println!("\n== cargo {} ({:.0} s)", arguments.join(" "), begun.elapsed().as_secs_f64());
        let mut cargo = quiet();
        cargo.args(arguments);
        if !doc_flags.is_empty() {
            cargo.env("RUSTDOCFLAGS", doc_flags);
        }
        match cargo.status() {
            Ok(status) if status.success() => {}
            Ok(_) => return ExitCode::FAILURE,
            Err(error) => {
                eprintln!("cannot run cargo: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    println!("\n== cargo test --workspace ({:.0} s)", begun.elapsed().as_secs_f64());
    match environment.join() {
        Ok(Ok(python)) => test(Some(&python)),
        Ok(Err(why)) => {
            println!("no environment for the tests in Python: {why}");
            test(None)
        }
        Err(_) => ExitCode::FAILURE,
    }
}

/// Checks every file, because `cargo fmt` does not see modules that a macro declares.
fn is_formatted() -> bool {
    let Ok(listed) = Command::new("git").args(["ls-files", "-z", "*.rs"]).output() else { return false };
    let files = String::from_utf8_lossy(&listed.stdout);
    let files: Vec<&str> = files.split('\0').filter(|file| Path::new(file).is_file()).collect();
    let checked = Command::new("rustfmt").args(["--check", "--edition", "2024"]).args(&files).status();
    !files.is_empty() && checked.is_ok_and(|status| status.success())
}

/// Cargo without incremental compilation, because nothing is compiled twice here.
fn quiet() -> Command {
    let mut cargo = cargo();
    cargo.env("CARGO_INCREMENTAL", "0");
    cargo
}

/// Runs all tests, those in Python with this interpreter, shows their output, and ends with the totals.
fn test(python: Option<&Path>) -> ExitCode {
    let mut cargo = quiet();
    cargo.args(["test", "--workspace"]).stdout(Stdio::piped());
    if let Some(python) = python {
        cargo.env("LOBE_PYTHON", python);
    }
    let mut running = match cargo.spawn() {
        Ok(running) => running,
        Err(error) => {
            eprintln!("cannot run cargo: {error}");
            return ExitCode::FAILURE;
        }
    };
    let mut counts = Counts::default();
    if let Some(output) = running.stdout.take() {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            println!("{line}");
            counts.add(&line);
        }
    }
    let succeeded = running.wait().is_ok_and(|status| status.success());
    println!("{counts}");
    if succeeded { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
