//! The package as Python imports it: its files and the module that cargo has built, in one folder.

use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

use crate::build;

/// Fails with the reason if an interpreter cannot load the module; its arguments are modules that it must have.
const PROBE: &str = "
import sys, sysconfig
if sys.implementation.name != 'cpython' or sys.version_info < (3, 10) or sysconfig.get_config_var('Py_GIL_DISABLED'):
    sys.exit('it is not CPython 3.10 or newer with the usual lock')
for module in sys.argv[1:]:
    __import__(module)
";

/// The package in a temporary folder, and an interpreter that finds it there.
pub struct Package {
    interpreter: PathBuf,
    folder: TempDir,
}

impl Package {
    /// For an interpreter that has these modules: the one that the environment variable `LOBE_PYTHON` names, the one of
    /// the environment in `target/python`, or the one on the path.
    ///
    /// # Errors
    /// Why no interpreter can be used.
    ///
    /// # Panics
    /// If `LOBE_PYTHON` names an interpreter that cannot be used.
    pub fn new(modules: &[&str]) -> Result<Self, String> {
        let interpreter = interpreter(modules)?;
        let folder = tempfile::tempdir().expect("a folder");
        let package = folder.path().join("lobe_bsdf");
        std::fs::create_dir(&package).expect("a folder");
        let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("python/lobe_bsdf");
        for entry in files.read_dir().expect("the files of the package") {
            let file = entry.expect("a folder entry").path();
            if file.is_file() {
                std::fs::copy(&file, package.join(file.file_name().expect("a name"))).expect("a copy");
            }
        }
        let module = if cfg!(windows) { "_lobe.pyd" } else { "_lobe.abi3.so" };
        std::fs::copy(build::library("_lobe"), package.join(module)).expect("a copy");
        Ok(Package { interpreter, folder })
    }

    /// The interpreter.
    pub fn python(&self) -> Command {
        let others = std::env::var_os("PYTHONPATH").unwrap_or_default();
        let others = std::env::split_paths(&others).filter(|folder| !folder.as_os_str().is_empty());
        let folders = [self.folder.path().to_owned()].into_iter().chain(others);
        let mut python = Command::new(&self.interpreter);
        python.env("PYTHONPATH", std::env::join_paths(folders).expect("paths")).env("PYTHONDONTWRITEBYTECODE", "1");
        python
    }
}

fn interpreter(modules: &[&str]) -> Result<PathBuf, String> {
    if let Some(named) = std::env::var_os("LOBE_PYTHON") {
        let named = PathBuf::from(named);
        check(&named, modules).unwrap_or_else(|why| panic!("LOBE_PYTHON: {why}"));
        return Ok(named);
    }
    let of_environment = if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" };
    let candidates = [build::environment().join(of_environment), "python3".into(), "python".into()];
    let mut reasons = Vec::new();
    for candidate in candidates {
        match check(&candidate, modules) {
            Ok(()) => return Ok(candidate),
            Err(why) => reasons.push(why),
        }
    }
    Err(reasons.join("; "))
}

/// The reason why an interpreter cannot be used, if there is one.
fn check(interpreter: &Path, modules: &[&str]) -> Result<(), String> {
    let output = Command::new(interpreter).args(["-c", PROBE]).args(modules).output();
    let output = output.map_err(|error| format!("{}: {error}", interpreter.display()))?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let last = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it fails");
    Err(format!("{}: {}", interpreter.display(), last.trim()))
}
