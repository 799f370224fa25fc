//! `cargo xtask outside`: checks the speed of kernels compiled in a user's crate.
//!
//! A kernel that a user's crate instantiates is compiled with the user's profile, in which other functions may be
//! inlined than in the profile of the workspace. `user/` is such a crate, outside the workspace. It is built with
//! Cargo's default profile and others, searched for intrinsics out of line, and compared with its build in the profile
//! of the workspace.
#![forbid(unsafe_code)]

mod contest;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, ensure};
use clap::Parser;
use comfy_table::{CellAlignment, Table, presets};

use contest::{Contender, Timings};

/// The profile of the workspace, with which the others are compared.
const REFERENCE: &str = "workspace";
/// Cargo's default; `opt-level = 2`; thin LTO; 256 codegen units.
const PROFILES: [&str; 4] = ["release", "two", "thin", "units"];

/// How often questions that are too slow are asked again, with new processes.
const REPEATS: usize = 4;
/// Number of turns of each process at a question, each time.
const ROUNDS: usize = 40;

/// Compare kernels instantiated by a crate outside the workspace with those of the workspace
///
/// The crate is built with Cargo's default release profile, with opt-level 2, with thin LTO and with 256 codegen units.
/// No intrinsic may be out of line in any of them, and no question may be slower by more than is allowed than in a
/// build with the profile of the workspace. Processes take turns at each question, and slow questions are measured
/// again before they count.
#[derive(Parser, Debug)]
#[command(bin_name = "cargo xtask outside")]
struct Args {
    /// Profiles to compare with the workspace's
    #[arg(long = "profile", value_name = "NAME", value_delimiter = ',', default_values = PROFILES)]
    profiles: Vec<String>,
    /// The least speed, as a fraction of the speed in the profile of the workspace
    #[arg(long, value_name = "RATIO", default_value_t = 0.95)]
    least: f64,
    /// Measure no times, only search for intrinsics out of line
    #[arg(long)]
    no_contest: bool,
}

/// # Errors
/// If a build fails, an intrinsic is out of line, or a question is too slow.
fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    let mut programs = Vec::new();
    for profile in args.profiles.iter().map(String::as_str).chain((!args.no_contest).then_some(REFERENCE)) {
        programs.push(build(profile)?);
    }
    let checked = &programs[..args.profiles.len()];
    look_for_intrinsics(checked)?;
    if args.no_contest {
        return Ok(());
    }

    // Other cores have other caches, and may run at another speed.
    if pin().is_none() {
        eprintln!("cannot keep the processes on one core, so times vary more");
    }
    let questions = contest::questions(&programs[0])?;
    let mut timings = Timings::new(questions, programs.len());
    for _ in 0..REPEATS {
        let slow = timings.slower_than(args.least);
        if slow.is_empty() {
            break;
        }
        // Another process has its memory at other addresses.
        let mut contenders = programs.iter().map(|program| Contender::start(program)).collect::<Result<Vec<_>, _>>()?;
        for question in slow {
            timings.measure(question, &mut contenders, ROUNDS)?;
        }
    }
    print(&args.profiles, &timings);
    let slow = timings.slower_than(args.least);
    let names: Vec<&str> = slow.iter().map(|&question| timings.name(question)).collect();
    ensure!(slow.is_empty(), "slower than {} times the speed in the workspace: {}", args.least, names.join(", "));
    Ok(())
}

/// The program of the user's crate in a profile.
fn build(profile: &str) -> anyhow::Result<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target = here.join("../../target/outside");
    println!("== building with the profile `{profile}`");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--profile", profile, "--manifest-path"]).arg(here.join("user/Cargo.toml"));
    let status = cargo.arg("--target-dir").arg(&target).status().context("cannot run cargo")?;
    ensure!(status.success(), "the crate outside the workspace cannot be built with the profile `{profile}`");
    let program = target.join(profile).join(format!("lobe-user{}", std::env::consts::EXE_SUFFIX));
    ensure!(program.is_file(), "cargo built no {}", program.display());
    Ok(program)
}

/// Runs `cargo xtask asm` on the programs.
fn look_for_intrinsics(programs: &[PathBuf]) -> anyhow::Result<()> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["run", "--release", "--quiet", "--package", "xtask-asm", "--"]);
    for program in programs {
        cargo.arg("--binary").arg(program);
    }
    let status = cargo.status().context("cannot run cargo")?;
    ensure!(status.success(), "intrinsics are out of line in the crate outside the workspace");
    Ok(())
}

/// Keeps this process and its children on one core.
#[cfg(target_os = "linux")]
fn pin() -> Option<()> {
    use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
    let allowed = sched_getaffinity(None).ok()?;
    let core = (0..CpuSet::MAX_CPU).rev().find(|&core| allowed.is_set(core))?;
    let mut one = CpuSet::new();
    one.set(core);
    sched_setaffinity(None, &one).ok()
}

#[cfg(not(target_os = "linux"))]
fn pin() -> Option<()> {
    None
}

fn print(profiles: &[String], timings: &Timings) {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    let heads = ["question", "workspace, us"].map(String::from).into_iter().chain(profiles.iter().cloned());
    table.set_header(heads);
    for question in 0..timings.len() {
        let (reference, ratios) = timings.ratios(question);
        let numbers = ratios.iter().map(|ratio| format!("{ratio:.2}"));
        let cells = [timings.name(question).to_owned(), format!("{:.1}", reference * 1e-3)];
        table.add_row(cells.into_iter().chain(numbers));
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    println!("{table}\nSpeed in each profile, as a fraction of the speed in the profile of the workspace.");
}
