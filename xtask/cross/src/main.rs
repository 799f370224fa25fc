//! `cargo xtask cross`: the backends of other processors, built for them and tested on emulators.
//!
//! What is needed and missing is installed below `target/cross`. A target that cannot be run here is skipped, and the reason
//! is printed.
#![forbid(unsafe_code)]

mod install;
mod target;

use std::process::Command;
use std::time::Instant;

use anyhow::{Context, ensure};
use clap::Parser;

use target::{Setup, Target};

/// What is tested on each target, besides the crate of the backend: lanes, functions, tables, the facade, rays and pictures.
const PACKAGES: [&str; 6] = ["lobe-backend", "lobe-math", "lobe-table", "lobe", "lobe-trace", "lobe-render"];

/// Test the backends of other processors, on emulators of these
///
/// aarch64 runs in qemu, wasm in node, sse2 in qemu as a processor that has nothing else; avx512 runs where the processor has
/// it. Needed tools that are missing are installed below target/cross: a target of rustup, qemu from Debian's packages.
#[derive(Parser, Debug)]
#[command(bin_name = "cargo xtask cross")]
struct Args {
    /// Targets to test [default: all]
    #[arg(value_enum)]
    targets: Vec<Target>,
    /// Packages to test, besides the equivalence of the backend
    #[arg(long = "package", value_name = "NAME", value_delimiter = ',', default_values = PACKAGES)]
    packages: Vec<String>,
    /// Fail if a target cannot be run here
    #[arg(long)]
    no_skip: bool,
}

/// How testing a target ended.
enum Outcome {
    Passed,
    Skipped(String),
    Failed(String),
}

fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    let targets = if args.targets.is_empty() { Target::ALL.to_vec() } else { args.targets };
    let mut outcomes = Vec::new();
    for target in targets {
        let begun = Instant::now();
        let outcome = match target.setup() {
            Ok(setup) => match test(target, &setup, &args.packages) {
                Ok(()) => Outcome::Passed,
                Err(error) => Outcome::Failed(format!("{error:#}")),
            },
            Err(reason) => Outcome::Skipped(format!("{reason:#}")),
        };
        outcomes.push((target, outcome, begun.elapsed()));
    }
    println!();
    let (mut failed, mut skipped) = (0, 0);
    for (target, outcome, time) in &outcomes {
        let name = target.name();
        match outcome {
            Outcome::Passed => println!("{name}: passed in {:.0} s", time.as_secs_f64()),
            Outcome::Skipped(reason) => println!("{name}: SKIP: {reason}"),
            Outcome::Failed(error) => println!("{name}: FAILED: {error}"),
        }
        failed += usize::from(matches!(outcome, Outcome::Failed(_)));
        skipped += usize::from(matches!(outcome, Outcome::Skipped(_)));
    }
    println!("{} passed, {failed} failed, {skipped} skipped", outcomes.len() - failed - skipped);
    ensure!(failed == 0, "{failed} targets failed");
    ensure!(!args.no_skip || skipped == 0, "{skipped} targets were skipped");
    Ok(())
}

/// The backend by itself first, then what is made of it, then its equivalence with the reference: that fails if the backend
/// did not run.
fn test(target: Target, setup: &Setup, packages: &[String]) -> anyhow::Result<()> {
    let [backend_crate, backend] = [target.backend_crate(), target.backend()];
    let mut tested: Vec<&str> = packages.iter().map(String::as_str).collect();
    tested.insert(0, backend_crate);
    for package in tested {
        let mut arguments = vec!["test", "--package", package, "--lib", "--tests", "--"];
        arguments.extend(setup.harness);
        arguments.extend(target.left_out(package));
        cargo(setup, &arguments)?;
    }
    let equivalence = ["run", "--package", "xtask-equivalence", "--no-default-features", "--", "--backend", backend];
    cargo(setup, &equivalence)
}

fn cargo(setup: &Setup, arguments: &[&str]) -> anyhow::Result<()> {
    println!("\n== cargo {}", arguments.join(" "));
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(arguments).envs(setup.environment.iter().map(|(name, value)| (name, value)));
    let status = cargo.status().context("cargo cannot be run")?;
    ensure!(status.success(), "cargo {} failed", arguments.join(" "));
    Ok(())
}
