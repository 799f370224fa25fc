//! `cargo xtask python`: installs the Python package as a user does, and tests it. `cargo test` runs the same tests on
//! an unoptimised build, in an environment that `cargo xtask ci` creates.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use super::wheel;

pub const ABOUT: &str = "Install the Python package into a separate environment, and run its tests";

const HELP: &str = "
Usage: cargo xtask python [--wheel] [ARGUMENTS OF PYTEST]

Options:
  --wheel    Make a wheel for most distributions of Linux in target/wheels, and install and test that

Examples:
  cargo xtask python
  cargo xtask python --wheel
  cargo xtask python -k arrays";

const NO_PYTHON: &str = "there is no Python 3.10 or newer that can create virtual environments";

/// Prints `True` if this interpreter can create environments, and is new enough.
const PROBE: &str = "import sys, venv, ensurepip; print(sys.version_info >= (3, 10))";

pub fn run(arguments: &[String]) -> ExitCode {
    if arguments.iter().any(|argument| ["-h", "--help"].contains(&argument.as_str())) {
        println!("{ABOUT}\n{HELP}");
        return ExitCode::SUCCESS;
    }
    let (options, arguments): (Vec<_>, Vec<_>) = arguments.iter().cloned().partition(|argument| argument == "--wheel");
    match check(!options.is_empty(), &arguments) {
        Ok(Outcome::Passed) => ExitCode::SUCCESS,
        Ok(Outcome::Skipped(why)) => {
            println!("SKIP the Python package: {why}");
            ExitCode::SUCCESS
        }
        Err(failed) => {
            eprintln!("{failed}");
            ExitCode::FAILURE
        }
    }
}

enum Outcome {
    Passed,
    Skipped(&'static str),
}

/// Creates an environment for the tests in Python that `cargo test` runs, unless it exists. Returns its interpreter.
///
/// # Errors
/// Why the tests have to be skipped.
pub fn for_tests() -> Result<PathBuf, String> {
    let environment = environment()?;
    let python = interpreter(&environment);
    if !is_usable(&python) {
        create(base().ok_or(NO_PYTHON)?, &environment)?;
    }
    // Tests that need one of the others report that they are skipped.
    if !installs(&python, &["numpy", "pytest"]) {
        return Err("pip cannot install numpy and pytest".into());
    }
    for package in ["scipy", "matplotlib", "openjd-cli"] {
        if !installs(&python, &[package]) {
            println!("SKIP tests that need {package}: pip cannot install it");
        }
    }
    Ok(python)
}

fn check(is_wheel: bool, arguments: &[String]) -> Result<Outcome, String> {
    let Some(base) = base() else { return Ok(Outcome::Skipped(NO_PYTHON)) };
    let environment = environment()?;
    create(base, &environment)?;
    let python = interpreter(&environment);
    let tools = ["maturin>=1.9.4,<2", "numpy", "pytest", "scipy", "matplotlib"];
    let of_wheels: &[&str] = if is_wheel { &wheel::TOOLS } else { &[] };
    if !installs(&python, &[&tools, of_wheels].concat()) {
        return Ok(Outcome::Skipped("pip cannot install maturin, numpy and pytest"));
    }
    // They are not available for every Python; tests that need them report that they are skipped.
    for engine in [["openjd-cli"].as_slice(), &["ray", "colorama"]] {
        if !installs(&python, engine) {
            println!("SKIP tests that need {}: pip cannot install it", engine[0]);
        }
    }
    // So that pip finds maturin.
    let mut path = vec![environment.join(BIN)];
    path.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()));
    let path = std::env::join_paths(path).map_err(|error| error.to_string())?;
    let package = match is_wheel {
        true => wheel::build(&python, &path)?.into_os_string(),
        false => OsString::from("./crates/lobe-python"),
    };
    let install = ["--no-build-isolation", "--no-deps", "--force-reinstall"];
    done(pip(&python).args(install).arg(package).env("PATH", path))?;
    // Some tests compare with the program, so it must be up to date. The tests of the workspace use the same build.
    done(super::cargo().args(["build", "--quiet", "--workspace", "--bin", "lobe"]))?;
    done(
        Command::new(&python)
            .args(["-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "crates/lobe-python"])
            .args(arguments),
    )?;
    Ok(Outcome::Passed)
}

/// The folder of the environment, in which `cargo test` looks too.
fn environment() -> Result<PathBuf, String> {
    std::path::absolute("target/python").map_err(|error| error.to_string())
}

/// A Python of this machine that can create environments.
fn base() -> Option<&'static str> {
    ["python3", "python"].into_iter().find(|python| is_usable(python))
}

/// Creates an empty environment, because those created by another Python do not work.
fn create(base: &str, environment: &Path) -> Result<(), String> {
    done(Command::new(base).args(["-m", "venv", "--clear"]).arg(environment))
}

fn pip(python: &Path) -> Command {
    let mut pip = Command::new(python);
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    pip
}

/// `true` if pip installs these packages, or has installed them before.
fn installs(python: &Path, packages: &[&str]) -> bool {
    done(pip(python).args(["--retries", "2"]).args(packages)).is_ok()
}

fn is_usable(python: impl AsRef<OsStr>) -> bool {
    let answer = Command::new(python).args(["-c", PROBE]).output();
    answer.is_ok_and(|answer| answer.status.success() && answer.stdout.starts_with(b"True"))
}

/// The folder of the programs of an environment.
const BIN: &str = if cfg!(windows) { "Scripts" } else { "bin" };

fn interpreter(environment: &Path) -> PathBuf {
    environment.join(BIN).join(if cfg!(windows) { "python.exe" } else { "python" })
}

pub fn done(command: &mut Command) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?}: {status}")),
        Err(error) => Err(format!("{command:?}: {error}")),
    }
}
