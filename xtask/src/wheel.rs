//! Builds a wheel for most Linux distributions.
//!
//! Zig links it, because it has the symbols of every glibc: the wheel then loads with the glibc that the platform tag
//! names, and with later ones. `auditwheel` checks this.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::Command;

use super::python::done;

/// The packages that pip installs to build the wheel.
pub const TOOLS: [&str; 2] = ["maturin[zig]>=1.9.4,<2", "auditwheel"];

/// The oldest glibc that Rust supports.
const GLIBC: &str = "2.17";
/// The platform tag for this glibc, which covers distributions since 2014.
const PLATFORM: &str = "manylinux2014";
/// The name of this tag in the output of auditwheel.
const AUDITED: &str = "manylinux_2_17";

/// Builds the wheel in `target/wheels`, with the interpreter of an environment that has the tools.
///
/// # Errors
/// If it cannot be built, or needs a newer system than its name says.
pub fn build(python: &Path, path: &OsStr) -> Result<PathBuf, String> {
    let folder = Path::new("target/wheels");
    if folder.exists() {
        std::fs::remove_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let mut maturin = Command::new(python);
    maturin.args(["-m", "maturin", "build", "--release", "--manifest-path", "crates/lobe-python/Cargo.toml", "--out"]);
    maturin.arg(folder).env("PATH", path);
    if cfg!(target_os = "linux") {
        let mut option = OsString::from("linker=");
        option.push(linker(python)?);
        maturin.args(["--compatibility", PLATFORM, "--", "-C"]).arg(option);
    }
    done(&mut maturin)?;
    let wheel = only_wheel(folder)?;
    let size = wheel.metadata().map_err(|error| format!("{}: {error}", wheel.display()))?.len();
    println!("{}: {:.1} MB", wheel.display(), size as f64 / 1e6);
    if cfg!(target_os = "linux") {
        audit(python, &wheel)?;
    }
    Ok(wheel)
}

/// Writes a program next to the interpreter that links like `cc`, for the oldest glibc, through maturin, which handles
/// options that Zig does not know.
fn linker(python: &Path) -> Result<PathBuf, String> {
    let program = python.with_file_name("zig-cc");
    let target = format!("{}-linux-gnu.{GLIBC}", std::env::consts::ARCH);
    let script = format!("#!/bin/sh\nexec \"${{0%/*}}/maturin\" zig cc -- -g -target {target} \"$@\"\n");
    let failed = |error: std::io::Error| format!("{}: {error}", program.display());
    std::fs::write(&program, script).map_err(failed)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).map_err(failed)?;
    }
    Ok(program)
}

fn only_wheel(folder: &Path) -> Result<PathBuf, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let files = entries.map_while(Result::ok).map(|entry| entry.path());
    let wheels: Vec<PathBuf> = files.filter(|file| file.extension().is_some_and(|end| end == "whl")).collect();
    <[PathBuf; 1]>::try_from(wheels)
        .map(|[wheel]| wheel)
        .map_err(|wheels| format!("{}: found {} wheels; expected one", folder.display(), wheels.len()))
}

/// Fails if the wheel needs a newer system than its name says.
fn audit(python: &Path, wheel: &Path) -> Result<(), String> {
    let mut auditwheel = Command::new(python);
    auditwheel.args(["-m", "auditwheel", "show"]).arg(wheel);
    let output = auditwheel.output().map_err(|error| format!("{auditwheel:?}: {error}"))?;
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{}", said.trim());
    match output.status.success() && is_consistent(&said) {
        true => Ok(()),
        false => Err(format!("{}: auditwheel does not find it consistent with {AUDITED}: {said}", wheel.display())),
    }
}

/// `true` if the tag that auditwheel finds consistent is the platform or an older one.
fn is_consistent(said: &str) -> bool {
    let words = said.split_whitespace().collect::<Vec<_>>().join(" ");
    let found = words.split("is consistent with the following platform tag: \"").nth(1);
    found.is_some_and(|tag| tag.starts_with(AUDITED))
}
