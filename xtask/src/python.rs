//! `cargo xtask python`: installs the Python package as a user does, and tests it.

use std::ffi::OsString;
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

fn check(is_wheel: bool, arguments: &[String]) -> Result<Outcome, String> {
    let Some(python) = ["python3", "python"].into_iter().find(|python| is_usable(python)) else {
        return Ok(Outcome::Skipped("there is no Python 3.10 or newer that can create virtual environments"));
    };
    // Environments created by another Python do not work.
    let environment = std::path::absolute("target/python").map_err(|error| error.to_string())?;
    done(Command::new(python).args(["-m", "venv", "--clear"]).arg(&environment))?;
    let python = interpreter(&environment);
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    let tools = ["maturin>=1.9.4,<2", "numpy", "pytest", "scipy", "matplotlib"];
    let of_wheels: &[&str] = if is_wheel { &wheel::TOOLS } else { &[] };
    if done(Command::new(&python).args(pip).args(tools).args(of_wheels)).is_err() {
        return Ok(Outcome::Skipped("pip cannot install maturin, numpy and pytest"));
    }
    // They are not available for every Python; tests that need them report that they are skipped.
    for engine in [["openjd-cli"].as_slice(), &["ray", "colorama"]] {
        if done(Command::new(&python).args(pip).args(engine)).is_err() {
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
    done(Command::new(&python).args(pip).args(install).arg(package).env("PATH", path))?;
    // Some tests compare with the program, so it must be up to date. The tests of the workspace use the same build.
    done(super::cargo().args(["build", "--quiet", "--workspace", "--bin", "lobe"]))?;
    done(
        Command::new(&python)
            .args(["-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "crates/lobe-python"])
            .args(arguments),
    )?;
    Ok(Outcome::Passed)
}

fn is_usable(python: &str) -> bool {
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
