//! Installs the peers: wheels in a virtual environment, SLEEF and Embree with the system's C compiler.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, bail};

use super::exchange::Exchange;
use super::python;

/// The wheels: package and version, so that figures from different days can be compared.
const WHEELS: [(&str, &str); 3] = [("interpn", "0.11.2"), ("mitsuba", "3.9.1"), ("scipy", "1.17.1")];

/// A script that runs peers of one kind: its name and text.
type Script = (&'static str, &'static str);

const PEERS: Script = ("peers.py", include_str!("peers.py"));
const FRAMES: Script = ("frames.py", include_str!("frames.py"));

/// The programs by name, ready to be started, or the reason why they cannot be. `tasks` is for those that read their
/// tasks from a file, `exchange` has the files of the others.
pub fn all(out: &Path, tasks: &Path, exchange: &Exchange) -> Vec<(&'static str, anyhow::Result<Command>)> {
    let environment = environment(out).map_err(|error| format!("{error:#}"));
    let interpreter = || environment.clone().map_err(anyhow::Error::msg);
    // `wide` requests vectors of sixteen floats, if the processor has them.
    let run = |script: Script, what: &str, wide: bool| -> anyhow::Result<Command> {
        let mut command = command(out, &interpreter()?, script)?;
        command.arg(what).arg(tasks).args(wide.then_some("wide"));
        Ok(command)
    };
    let wheel = |(package, version): (&'static str, &str)| {
        let installed = interpreter().and_then(|python| install(&python, package, version));
        (package, installed.and_then(|()| run(PEERS, package, false)))
    };
    let mut programs: Vec<_> = WHEELS.into_iter().map(wheel).collect();
    programs.extend([
        ("mitsuba-wide", run(PEERS, "mitsuba", true)),
        ("mitsuba-llvm", run(FRAMES, "llvm_ad_rgb", false)),
        ("mitsuba-llvm-wide", run(FRAMES, "llvm_ad_rgb", true)),
        ("mitsuba-scalar", run(FRAMES, "scalar_rgb", false)),
    ]);
    let package = command(out, &python::interpreter(), PEERS).map(|mut command| {
        // Those of one core.
        command.arg(python::PROGRAM).arg(tasks).env("RAYON_NUM_THREADS", "1");
        command
    });
    programs.push((python::PROGRAM, package));
    let sleef = Source { name: "acos", text: include_str!("acos.c"), libraries: &["sleef"], package: "libsleef-dev" };
    programs.push(("sleef", sleef.compiled(out, &exchange.cosines())));
    let embree = Source {
        name: "embree",
        text: include_str!("embree.c"),
        libraries: &["embree3", "m"],
        package: "libembree-dev",
    };
    programs.push(("embree", embree.compiled(out, exchange.directory())));
    programs
}

/// Runs a script, which is placed next to the code that all scripts share.
fn command(out: &Path, python: &Path, (name, text): Script) -> anyhow::Result<Command> {
    std::fs::write(out.join("serve.py"), include_str!("serve.py"))?;
    let script = out.join(name);
    std::fs::write(&script, text)?;
    let mut command = Command::new(python);
    command.arg(script);
    Ok(command)
}

/// The interpreter of the virtual environment, which is created if it does not exist.
fn environment(out: &Path) -> anyhow::Result<std::path::PathBuf> {
    let directory = out.join("venv");
    let python = directory.join("bin/python");
    if !python.exists() {
        println!("making {}", directory.display());
        finish(Command::new("python3").args(["-m", "venv"]).arg(&directory))?;
    }
    Ok(python)
}

/// Installs a wheel unless this version is already installed.
fn install(python: &Path, package: &str, version: &str) -> anyhow::Result<()> {
    let check = format!("import importlib.metadata as m; assert m.version('{package}') == '{version}'");
    if finish(Command::new(python).args(["-c", &check])).is_ok() {
        return Ok(());
    }
    println!("installing {package} {version}");
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", ":all:", "numpy"];
    finish(Command::new(python).args(pip).arg(format!("{package}=={version}")))
}

/// A program in C that calls a library of the system.
struct Source {
    name: &'static str,
    text: &'static str,
    libraries: &'static [&'static str],
    /// The Debian package that has the library.
    package: &'static str,
}

impl Source {
    /// The program, with its only argument.
    fn compiled(&self, out: &Path, argument: &Path) -> anyhow::Result<Command> {
        if !(cfg!(target_arch = "x86_64") && lobe::Backend::named("avx2").is_ok()) {
            bail!("this processor has no AVX2");
        }
        let program = out.join(self.name);
        let source = program.with_extension("c");
        std::fs::write(&source, self.text)?;
        let mut compiler = Command::new("cc");
        compiler.args(["-std=c11", "-D_POSIX_C_SOURCE=199309L", "-O3", "-mavx2", "-mfma", "-o"]).arg(&program);
        compiler.arg(&source).args(self.libraries.iter().map(|library| format!("-l{library}")));
        finish(&mut compiler).with_context(|| format!("Debian has it as {}", self.package))?;
        let mut command = Command::new(program);
        command.arg(argument);
        Ok(command)
    }
}

/// Runs a command to its end.
///
/// # Errors
/// If it fails: with the first line of its output that mentions an error, or else the last line.
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
