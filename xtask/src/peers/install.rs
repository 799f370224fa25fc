//! Where the peers come from: wheels in a virtual environment, and SLEEF with the system's C compiler.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, bail};

/// The wheels: package and version, so that figures compare from one day to another.
const WHEELS: [(&str, &str); 3] = [("interpn", "0.11.2"), ("mitsuba", "3.9.1"), ("scipy", "1.17.1")];

/// The programs by name, ready to be started, or why they cannot be. `tasks` is for those that are told of their tasks in
/// a file, `cosines` is what the arc cosine is taken of.
pub fn all(out: &Path, tasks: &Path, cosines: &Path) -> Vec<(&'static str, anyhow::Result<Command>)> {
    let environment = environment(out).map_err(|error| format!("{error:#}"));
    let wheel = |(package, version): (&'static str, &str)| {
        let command = environment.clone().map_err(anyhow::Error::msg).and_then(|python| {
            install(&python, package, version)?;
            let script = out.join("peers.py");
            std::fs::write(&script, include_str!("peers.py"))?;
            let mut command = Command::new(python);
            command.arg(script).arg(package).arg(tasks);
            Ok(command)
        });
        (package, command)
    };
    let mut programs: Vec<_> = WHEELS.into_iter().map(wheel).collect();
    programs.push(("sleef", sleef(out, cosines)));
    programs
}

/// The interpreter of the virtual environment, which is made where there is none.
fn environment(out: &Path) -> anyhow::Result<std::path::PathBuf> {
    let directory = out.join("venv");
    let python = directory.join("bin/python");
    if !python.exists() {
        println!("making {}", directory.display());
        finish(Command::new("python3").args(["-m", "venv"]).arg(&directory))?;
    }
    Ok(python)
}

/// Installs a wheel unless that version is there.
fn install(python: &Path, package: &str, version: &str) -> anyhow::Result<()> {
    let check = format!("import importlib.metadata as m; assert m.version('{package}') == '{version}'");
    if finish(Command::new(python).args(["-c", &check])).is_ok() {
        return Ok(());
    }
    println!("installing {package} {version}");
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", ":all:", "numpy"];
    finish(Command::new(python).args(pip).arg(format!("{package}=={version}")))
}

/// Compiles the program that calls SLEEF.
fn sleef(out: &Path, cosines: &Path) -> anyhow::Result<Command> {
    if !(cfg!(target_arch = "x86_64") && lobe::Backend::named("avx2").is_ok()) {
        bail!("this processor has no AVX2");
    }
    let (source, program) = (out.join("acos.c"), out.join("acos"));
    std::fs::write(&source, include_str!("acos.c"))?;
    let mut compiler = Command::new("cc");
    compiler.args(["-std=c11", "-D_POSIX_C_SOURCE=199309L", "-O3", "-mavx2", "-mfma", "-o"]).arg(&program);
    finish(compiler.arg(&source).arg("-lsleef")).context("Debian has it as libsleef-dev")?;
    let mut command = Command::new(program);
    command.arg(cosines);
    Ok(command)
}

/// Runs a command to its end.
///
/// # Errors
/// Where it fails: with the first line that it wrote which speaks of an error, or else the last.
fn finish(command: &mut Command) -> anyhow::Result<()> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().with_context(|| format!("cannot start {name}"))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let line = text.lines().find(|line| line.to_lowercase().contains("error")).or(text.lines().last());
        bail!("{name}: {}", line.map_or_else(|| output.status.to_string(), |line| line.trim().to_owned()));
    }
    Ok(())
}
