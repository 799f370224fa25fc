//! `cargo xtask web`: the explorer as static files in `target/web`, and its tests.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

pub const ABOUT: &str = "Build the explorer, a page for browsers, into target/web; --test runs its tests";

const USAGE: &str = "Usage: cargo xtask web [--test] [--speed] [--embed]

  --test   run the tests of the module in node, and of the page in Chromium
  --speed  compare simd128 with a module that is built without it
  --embed  also copy the page to crates/lobe-cli/page, so that `lobe view` is built with it

It needs the target wasm32-unknown-unknown (`rustup target add wasm32-unknown-unknown`), node 20.19
or newer with npm, and Chromium for the tests of the page; the variable CHROMIUM may name it.";

const TRIPLE: &str = "wasm32-unknown-unknown";

pub fn run(arguments: &[String]) -> ExitCode {
    if let Some(unknown) =
        arguments.iter().find(|argument| !["--test", "--speed", "--embed"].contains(&argument.as_str()))
    {
        println!("{ABOUT}\n\n{USAGE}");
        return if ["-h", "--help"].contains(&unknown.as_str()) { ExitCode::SUCCESS } else { ExitCode::from(2) };
    }
    let has = |option: &str| arguments.iter().any(|argument| argument == option);
    let asked = Asked { tests: has("--test"), speed: has("--speed"), embeds: has("--embed") };
    match build(asked) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        // Only tests may be skipped; if the page was requested, it must be built.
        Ok(Outcome::Skipped(why)) if has("--test") => {
            println!("SKIP the explorer: {why}");
            ExitCode::SUCCESS
        }
        Ok(Outcome::Skipped(why)) => {
            eprintln!("the explorer was not built: {why}");
            ExitCode::FAILURE
        }
        Err(failed) => {
            eprintln!("{failed}");
            ExitCode::FAILURE
        }
    }
}

/// What is asked for besides the page.
struct Asked {
    tests: bool,
    speed: bool,
    embeds: bool,
}

enum Outcome {
    Done,
    Skipped(String),
}

/// The folders of the build.
struct Places {
    /// The sources of the page.
    page: PathBuf,
    /// The output of wasm-bindgen.
    module: PathBuf,
    /// The static files that are built.
    out: PathBuf,
}

fn build(asked: Asked) -> Result<Outcome, String> {
    let absolute = |path: &str| std::path::absolute(path).map_err(|error| error.to_string());
    let places = Places {
        page: absolute("crates/lobe-web/page")?,
        module: absolute("target/web-module")?,
        out: absolute("target/web")?,
    };
    if !has_target() {
        return Ok(Outcome::Skipped(format!("the target is missing; `rustup target add {TRIPLE}` installs it")));
    }
    for program in ["node", "npm"] {
        if !answers(program) {
            return Ok(Outcome::Skipped(format!("there is no {program}")));
        }
    }
    let bindgen = bindgen()?;
    module(&bindgen, &absolute("target/wasm")?, &places.module, "-C target-feature=+simd128")?;
    let mut npm = npm(&places);
    if done(npm.args(["ci", "--no-audit", "--no-fund", "--loglevel", "error"])).is_err() {
        let why = "npm cannot install the packages of the page";
        // The usual cause is a missing network, which a server that tests everything has.
        return if std::env::var_os("CI").is_some() { Err(why.into()) } else { Ok(Outcome::Skipped(why.into())) };
    }
    done(with_places(npm_run(&places), &places))?;
    println!("{}: {}", places.out.display(), sizes(&places.out)?);
    if asked.embeds {
        let page = absolute("crates/lobe-cli/page")?;
        let _ = std::fs::remove_dir_all(&page);
        copy(&places.out, &page)?;
        // The file that keeps the folder in the repository; see crates/lobe-cli/build.rs.
        std::fs::write(page.join(".gitkeep"), "").map_err(|error| error.to_string())?;
        println!("{}: the next build of `lobe` contains it", page.display());
    }
    if asked.speed {
        // The scalar backend of the module with simd128 is vectorised by the compiler; this one is what a browser without
        // it would run.
        let scalar = absolute("target/web-module-scalar")?;
        module(&bindgen, &absolute("target/wasm-scalar")?, &scalar, "")?;
        done(Compared::build()?.node(&places, &["tests/speed.mjs"]).env("LOBE_WEB_SCALAR", &scalar))?;
    }
    if asked.tests { test(&places) } else { Ok(Outcome::Done) }
}

/// Compiles the module with these flags, and writes what wasm-bindgen makes of it into a folder.
fn module(bindgen: &Path, target: &Path, out: &Path, flags: &str) -> Result<(), String> {
    done(
        super::cargo()
            .args(["build", "--release", "--quiet", "--package", "lobe-web", "--target", TRIPLE, "--target-dir"])
            .arg(target)
            .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", flags),
    )?;
    let module = target.join(TRIPLE).join("release/lobe_web.wasm");
    done(
        Command::new(bindgen)
            .args(["--target", "web", "--remove-name-section", "--remove-producers-section", "--out-dir"])
            .arg(out)
            .arg(module),
    )
}

/// `true` if there is a standard library for the target.
fn has_target() -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let found = Command::new(rustc).args(["--print", "target-libdir", "--target", TRIPLE]).output();
    let path = found.ok().filter(|found| found.status.success()).map(|found| found.stdout);
    path.is_some_and(|path| Path::new(String::from_utf8_lossy(&path).trim()).is_dir())
}

fn answers(program: &str) -> bool {
    let asked = Command::new(program).arg("--version").output();
    asked.is_ok_and(|answer| answer.status.success())
}

/// The program wasm-bindgen in the version of the lock file: the one on the path, or one installed in `target`.
fn bindgen() -> Result<PathBuf, String> {
    let lock = std::fs::read_to_string("Cargo.lock").map_err(|error| format!("Cargo.lock: {error}"))?;
    let version = locked(&lock, "wasm-bindgen").ok_or("Cargo.lock has no wasm-bindgen")?;
    let is_it = |program: &Path| {
        let answer = Command::new(program).arg("--version").output();
        answer.is_ok_and(|answer| String::from_utf8_lossy(&answer.stdout).trim() == format!("wasm-bindgen {version}"))
    };
    let root = std::path::absolute("target/web-tools").map_err(|error| error.to_string())?;
    let own = root.join("bin").join(if cfg!(windows) { "wasm-bindgen.exe" } else { "wasm-bindgen" });
    if let Some(found) = [PathBuf::from("wasm-bindgen"), own.clone()].into_iter().find(|program| is_it(program)) {
        return Ok(found);
    }
    println!("installing wasm-bindgen {version} into {}", root.display());
    done(super::cargo().args(["install", "wasm-bindgen-cli", "--version", version, "--quiet", "--root"]).arg(&root))?;
    Ok(own)
}

/// The version of a package in the text of a lock file.
fn locked<'a>(lock: &'a str, package: &str) -> Option<&'a str> {
    let mut lines = lock.lines();
    let name = format!("name = \"{package}\"");
    lines.by_ref().find(|line| *line == name)?;
    lines.next()?.strip_prefix("version = \"")?.strip_suffix('"')
}

fn npm(places: &Places) -> Command {
    let mut npm = Command::new(if cfg!(windows) { "npm.cmd" } else { "npm" });
    npm.current_dir(&places.page);
    npm
}

fn npm_run(places: &Places) -> Command {
    let mut npm = npm(places);
    npm.args(["run", "--silent", "build", "--", "--logLevel", "warn"]);
    npm
}

/// Tells a command the folders of the build by environment variables.
fn with_places(mut command: Command, places: &Places) -> Command {
    command.env("LOBE_WEB_MODULE", &places.module).env("LOBE_WEB_OUT", &places.out);
    command
}

/// The number and the total size of the files of the page.
fn sizes(folder: &Path) -> Result<String, String> {
    let mut files = Vec::new();
    collect(folder, &mut files)?;
    let size = |path: &PathBuf| std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    Ok(format!("{} files, {} bytes", files.len(), files.iter().map(size).sum::<u64>()))
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    for entry in folder.read_dir().map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() { collect(&path, files)? } else { files.push(path) }
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let mut files = Vec::new();
    collect(from, &mut files)?;
    for file in files {
        let target = to.join(file.strip_prefix(from).map_err(|error| error.to_string())?);
        let copied =
            target.parent().map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::copy(&file, &target));
        copied.map_err(|error| format!("{}: {error}", target.display()))?;
    }
    Ok(())
}

/// Tests the module in node, then the page in Chromium.
fn test(places: &Places) -> Result<Outcome, String> {
    let compared = Compared::build()?;
    let tests = |file: &str| compared.node(places, &["--test", "--test-reporter=spec", file]);
    done(tests("tests/module.test.mjs"))?;
    let named = std::env::var("CHROMIUM").ok();
    let browsers = named.iter().map(String::as_str).chain(["chromium", "chromium-browser", "google-chrome"]);
    let Some(browser) = browsers.into_iter().find(|browser| answers(browser)) else {
        return Ok(Outcome::Skipped(
            "there is no Chromium for the tests of the page; those of the module passed".into(),
        ));
    };
    for file in ["tests/page.test.mjs", "tests/panels.test.mjs", "tests/quality.test.mjs"] {
        done(tests(file).env("CHROMIUM", browser))?;
    }
    Ok(Outcome::Done)
}

/// What the module is compared with.
struct Compared {
    /// The program.
    lobe: PathBuf,
    /// A folder with a small file of every format.
    examples: PathBuf,
}

impl Compared {
    fn build() -> Result<Self, String> {
        // The tests of the workspace use the same build of the program.
        done(super::cargo().args(["build", "--quiet", "--workspace", "--bin", "lobe", "--example", "write_examples"]))?;
        let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
        let target = std::path::absolute(target).map_err(|error| error.to_string())?;
        let built = |name: &str| target.join("debug").join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
        let examples = target.join("web-examples");
        let _ = std::fs::remove_dir_all(&examples);
        done(Command::new(built("examples/write_examples")).arg(&examples))?;
        Ok(Compared { lobe: built("lobe"), examples })
    }

    fn node(&self, places: &Places, arguments: &[&str]) -> Command {
        let mut node = Command::new("node");
        node.current_dir(&places.page).args(arguments);
        node.env("LOBE", &self.lobe).env("LOBE_WEB_EXAMPLES", &self.examples);
        with_places(node, places)
    }
}

fn done(mut command: impl std::borrow::BorrowMut<Command>) -> Result<(), String> {
    let command: &mut Command = command.borrow_mut();
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?}: {status}")),
        Err(error) => Err(format!("{command:?}: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_those_of_the_lock_file() {
        let lock = "[[package]]\nname = \"wasm-bindgen-shared\"\nversion = \"1.0\"\n\n[[package]]\nname = \"wasm-bindgen\"\nversion = \"0.2.130\"\n";
        assert_eq!(locked(lock, "wasm-bindgen"), Some("0.2.130"));
        assert_eq!(locked(lock, "bindgen"), None);
    }
}
