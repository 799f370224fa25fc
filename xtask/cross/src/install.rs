//! The tools that the targets need: found on this machine, or installed in `target/cross`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, bail, ensure};

/// The folder in which missing tools are installed.
fn folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target")).join("cross")
}

/// The standard library for a target of rustc.
///
/// # Errors
/// If it is missing and rustup cannot fetch it.
pub fn rust_target(triple: &str) -> anyhow::Result<()> {
    let printed = output(Command::new("rustc").args(["--print", "target-libdir", "--target", triple]))?;
    let libraries = PathBuf::from(String::from_utf8_lossy(&printed.stdout).trim());
    if libraries.is_dir() {
        return Ok(());
    }
    output(Command::new("rustup").args(["target", "add", triple]))
        .with_context(|| format!("Rust's library for {triple} is missing"))?;
    ensure!(libraries.is_dir(), "rustup added {triple}, but {} is missing", libraries.display());
    Ok(())
}

/// The emulator of another processor for Linux programs: from this machine, or from Debian's packages.
///
/// # Errors
/// If it is missing and cannot be installed.
pub fn qemu(processor: &str) -> anyhow::Result<PathBuf> {
    ensure!(cfg!(target_os = "linux"), "qemu runs programs only on Linux");
    let names = [format!("qemu-{processor}"), format!("qemu-{processor}-static")];
    if let Some(found) = names.iter().find_map(|name| on_path(name)) {
        return Ok(found);
    }
    let package = "qemu-user-static";
    let program = folder().join(package).join("usr/bin").join(&names[1]);
    if !program.is_file() {
        debian(package).with_context(|| format!("{} is missing and cannot be installed", names[0]))?;
        ensure!(program.is_file(), "Debian's {package} has no {}", names[1]);
    }
    Ok(std::path::absolute(program)?)
}

/// Node.js, which runs WebAssembly.
///
/// # Errors
/// If it is missing or too old.
pub fn node() -> anyhow::Result<PathBuf> {
    let node = on_path("node").context("node is missing")?;
    let printed = output(Command::new(&node).arg("--version"))?;
    let version = String::from_utf8_lossy(&printed.stdout).trim().to_owned();
    let major = version.trim_start_matches('v').split('.').next().and_then(|major| major.parse::<u32>().ok());
    ensure!(major.is_some_and(|major| major >= 20), "node is {version}; 20 or newer is needed");
    Ok(node)
}

/// Unpacks one of Debian's packages, without installing it.
fn debian(package: &str) -> anyhow::Result<()> {
    let into = folder().join(package);
    std::fs::create_dir_all(&into).with_context(|| format!("{}: cannot be created", into.display()))?;
    let download = || output(Command::new("apt-get").args(["download", "--quiet", package]).current_dir(&into));
    if download().is_err() {
        // The list of packages is missing or outdated.
        output(Command::new("apt-get").args(["update", "--quiet"]))?;
        download()?;
    }
    let entries = std::fs::read_dir(&into).with_context(|| format!("{}: cannot be read", into.display()))?;
    let mut files = entries.map_while(Result::ok).map(|entry| entry.path());
    let archive = files.find(|file| file.extension().is_some_and(|extension| extension == "deb"));
    let archive =
        archive.with_context(|| format!("apt-get did not download the package {package} to {}", into.display()))?;
    output(Command::new("dpkg-deb").arg("--extract").arg(&archive).arg(&into))?;
    std::fs::remove_file(&archive).with_context(|| format!("{}: cannot be removed", archive.display()))
}

/// A program in one of the folders of `PATH`.
fn on_path(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// Runs a program and waits for its end.
///
/// # Errors
/// If it cannot be run or fails, with the last line of its output.
fn output(command: &mut Command) -> anyhow::Result<Output> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("cannot run {name}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let said = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it printed nothing");
        bail!("{name} failed: {}", said.trim());
    }
    Ok(output)
}
