//! `cargo xtask cross`: builds the backends of other processors, and tests them on emulators.
//!
//! Missing tools are installed in `target/cross`. A target that cannot be run here is skipped, and the reason is
//! printed.
#![forbid(unsafe_code)]

#[path = "../../src/counts.rs"]
mod counts;
mod install;
mod target;

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, ensure};
use clap::Parser;

use counts::Counts;
use target::{Setup, Target};

/// The packages tested on each target, besides the crate of the backend: lanes, functions, tables, the facade, rays and
/// pictures.
const PACKAGES: [&str; 6] = ["lobe-backend", "lobe-math", "lobe-table", "lobe", "lobe-trace", "lobe-render"];

/// Test the backends of other processors on emulators
///
/// aarch64 runs in qemu, wasm in node, sse2 in qemu as a processor that has nothing newer; avx512 runs if this
/// processor has it. Missing tools are installed in target/cross: a target of rustup, qemu from Debian's packages.
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
        let (begun, mut counts) = (Instant::now(), Counts::default());
        let outcome = match target.setup() {
            Ok(setup) => match test(target, &setup, &args.packages, &mut counts) {
                Ok(()) => Outcome::Passed,
                Err(error) => Outcome::Failed(format!("{error:#}")),
            },
            Err(reason) => Outcome::Skipped(format!("{reason:#}")),
        };
        outcomes.push((target, outcome, counts, begun.elapsed().as_secs()));
    }
    println!();
    let (mut failed, mut skipped) = (0, 0);
    for (target, outcome, counts, seconds) in &outcomes {
        let name = target.name();
        match outcome {
            Outcome::Passed => println!("{name}: passed in {seconds} s; tests: {counts}"),
            Outcome::Skipped(reason) => println!("{name}: SKIP: {reason}"),
            Outcome::Failed(error) => println!("{name}: FAILED after {seconds} s: {error}; tests: {counts}"),
        }
        failed += usize::from(matches!(outcome, Outcome::Failed(_)));
        skipped += usize::from(matches!(outcome, Outcome::Skipped(_)));
    }
    println!("{} passed, {failed} failed, {skipped} skipped", outcomes.len() - failed - skipped);
    ensure!(failed == 0, "{failed} targets failed");
    ensure!(!args.no_skip || skipped == 0, "{skipped} targets were skipped");
    Ok(())
}

/// Tests the backend by itself and the packages that use it, then its equivalence with the reference, which fails if the
/// backend did not run.
fn test(target: Target, setup: &Setup, packages: &[String], counts: &mut Counts) -> anyhow::Result<()> {
    let mut failed = Vec::new();
    // One build, because each package alone would have dependencies with other features, which are compiled again.
    let mut arguments = vec!["test", "--lib", "--tests", "--no-fail-fast", "--package", target.backend_crate()];
    arguments.extend(packages.iter().flat_map(|package| ["--package", package.as_str()]));
    arguments.push("--");
    arguments.extend(setup.harness);
    if !cargo(setup, &arguments, counts)? {
        failed.push("the tests");
    }
    if setup.panics_end && !refuses_short_slices(target, setup)? {
        failed.push("slices that are too short");
    }
    let backend = target.backend();
    let equivalence = ["run", "--package", "xtask-equivalence", "--no-default-features", "--", "--backend", backend];
    if !cargo(setup, &equivalence, counts)? {
        failed.push("the equivalence with the reference");
    }
    ensure!(failed.is_empty(), "{}", failed.join(", "));
    Ok(())
}

/// Checks that every access of the backend refuses slices that are too short, and no others, on a target where a panic
/// ends the program: the tests of the backend then try one access per process.
fn refuses_short_slices(target: Target, setup: &Setup) -> anyhow::Result<bool> {
    println!("\n== accesses of slices that are too short, and of others");
    let name = format!("{}::short_slices_are_refused", target.backend());
    for access in 0.. {
        for more in [0, -1] {
            let mut cargo = command(setup);
            cargo.args(["test", "--quiet", "--package", target.backend_crate(), "--test", "suite", "--"]);
            cargo.args(["--exact", &name, "--nocapture"]).env("LOBE_SHORT", format!("{access}:{more}"));
            let output = cargo.output().context("cannot run cargo")?;
            let said = String::from_utf8_lossy(&output.stderr);
            // The tests have numbered them without a gap.
            if output.status.success() && said.contains("there is no access") {
                println!("{access} accesses");
                return Ok(access > 0);
            }
            let refused = said.contains("panicked at");
            let as_it_should = if more < 0 { refused } else { output.status.success() && said.contains("is accepted") };
            if !as_it_should {
                println!("{said}\naccess {access} with {more} elements more than it needs: refused = {refused}");
                return Ok(false);
            }
        }
    }
    Ok(false)
}

/// Runs cargo, shows its output, and adds up what test programs say at their end; returns `true` if it succeeds.
fn cargo(setup: &Setup, arguments: &[&str], counts: &mut Counts) -> anyhow::Result<bool> {
    println!("\n== cargo {}", arguments.join(" "));
    let mut cargo = command(setup).args(arguments).stdout(Stdio::piped()).spawn().context("cannot run cargo")?;
    for line in BufReader::new(cargo.stdout.take().context("the output of cargo")?).lines() {
        let line = line?;
        println!("{line}");
        counts.add(&line);
    }
    Ok(cargo.wait()?.success())
}

fn command(setup: &Setup) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.envs(setup.environment.iter().map(|(name, value)| (name, value)));
    cargo
}
