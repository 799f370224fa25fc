//! `xtask damage`: runs every command of the program on damaged files, thousands of times, under limits of memory and
//! time. No run may panic, be ended by a signal, or take longer than the limit.
//!
//! Run `n` is the same on every machine: its command, its file and the damage follow from its number. The outcomes are
//! recorded in a file, one line per run, so that the next call continues where the last one ended.
#![forbid(unsafe_code)]

mod commands;
mod gentle;
mod inputs;
mod run;

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use clap::Parser;
use lobe_testing::damage::mutant;
use rand::seq::IndexedRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use commands::{COMMANDS, Command};
use inputs::Input;
use run::{Limits, Outcome, run};

/// Run every command of the program on damaged files, under limits of memory and time.
#[derive(Parser)]
#[command(
    bin_name = "cargo xtask damage",
    after_help = "Examples:
  cargo build --bin lobe && cargo xtask damage --runs 1000
  cargo xtask damage --program target/release/lobe --runs 20000     continues where the last call ended
  cargo xtask damage --again 1234                                   one run, with its messages
  cargo xtask damage --summary

Files of runs that went wrong are kept in folders next to the record. Needs sh."
)]
struct Args {
    /// The total number of runs, including those of earlier calls
    #[arg(long, default_value_t = 1000)]
    runs: u64,
    /// The program
    #[arg(long, default_value = "target/debug/lobe")]
    program: PathBuf,
    /// The memory limit of a run, in MB of address space
    #[arg(long, default_value_t = 4000)]
    memory: u64,
    /// The limit of processor time of a run, in seconds
    #[arg(long, default_value_t = 30)]
    seconds: u64,
    /// The file that records the outcomes
    #[arg(long, default_value = "target/damage/record.tsv")]
    record: PathBuf,
    /// Repeat one run, without recording it
    #[arg(long, value_name = "N")]
    again: Option<u64>,
    /// Summarise the record, without running anything
    #[arg(long)]
    summary: bool,
}

fn main() -> Result<()> {
    let args = Args::parse();
    if args.summary {
        return summary(&args.record);
    }
    let program = fs::canonicalize(&args.program).with_context(|| args.program.display().to_string())?;
    let kept = args.record.parent().unwrap_or(Path::new(".")).to_path_buf();
    fs::create_dir_all(&kept)?;
    let folder = tempfile::tempdir()?;
    let sound = folder.path().join("sound");
    let mut inputs = inputs::all();
    inputs.extend(inputs::sound(&program, &sound)?);
    let runs = Runs { program, limits: Limits { memory: args.memory, seconds: args.seconds }, inputs, sound };
    if let Some(number) = args.again {
        let Made { line, .. } = runs.make(number, &folder.path().join("run"))?;
        let (outcome, took, message) = runs.run(&line, &folder.path().join("run"))?;
        println!(
            "lobe {}\n{message}{outcome}, {took:.1?}; the files are in {}",
            line.join(" "),
            folder.keep().display()
        );
        return Ok(());
    }
    let mut record = OpenOptions::new().append(true).create(true).open(&args.record)?;
    for number in done(&args.record)?..args.runs {
        let place = folder.path().join("run");
        let Made { line, input, command } = runs.make(number, &place)?;
        let (outcome, took, message) = runs.run(&line, &place)?;
        let name = command.line.split(' ').next().unwrap_or_default();
        writeln!(record, "{number}\t{name}\t{input}\t{outcome}\t{}", took.as_millis())?;
        if outcome.is_finding() {
            fs::write(place.join("said.txt"), format!("lobe {}\n{message}", line.join(" ")))?;
            let to = kept.join(number.to_string());
            copy(&place, &to)?;
            println!("run {number}: {outcome}; see {}", to.display());
        }
        fs::remove_dir_all(&place)?;
    }
    summary(&args.record)
}

/// The share of files in which only numbers are changed.
const GENTLE: f64 = 0.7;

/// What all runs have in common.
struct Runs {
    program: PathBuf,
    limits: Limits,
    inputs: Vec<Input>,
    /// The folder of sound files.
    sound: PathBuf,
}

/// A prepared run.
struct Made {
    line: Vec<String>,
    /// The name of the input that was damaged.
    input: String,
    command: &'static Command,
}

impl Runs {
    /// Prepares the files of a run.
    fn make(&self, number: u64, place: &Path) -> Result<Made> {
        let mut random = Pcg64Mcg::seed_from_u64(number);
        let total: u32 = COMMANDS.iter().map(|command| command.share).sum();
        let mut left = random.random_range(0..total);
        let command = COMMANDS.iter().find(|command| {
            let is_it = left < command.share;
            left = left.saturating_sub(command.share);
            is_it
        });
        let command = command.context("a command")?;
        let of_kind: Vec<&Input> = self.inputs.iter().filter(|input| input.kind == command.kind).collect();
        // Formats are equally frequent, however many files there are of each.
        let mut names: Vec<&str> = of_kind.iter().map(|input| input.name.as_str()).collect();
        names.dedup();
        let name = names.choose(&mut random).context("a file of the kind")?;
        let of_name: Vec<&Input> = of_kind.iter().copied().filter(|input| input.name == *name).collect();
        let input = of_name.choose(&mut random).context("a file of the name")?;
        let other = of_name.choose(&mut random).context("a file of the name")?;
        copy(&self.sound, place)?;
        // Readers refuse most files with arbitrary damage, so the code after reading sees few of them.
        let damaged = match random.random_bool(GENTLE) {
            true => gentle::mutant(&mut random, &input.bytes),
            false => mutant(&mut random, &input.bytes, &other.bytes),
        };
        fs::write(place.join(input.file()), damaged)?;
        if let Some(scene) = input.scene() {
            fs::write(place.join("scene.toml"), scene)?;
        }
        let word = |word: &str| word.replace("{in}", &input.file()).replace("{out}", "out");
        Ok(Made { line: command.line.split(' ').map(word).collect(), input: input.name.clone(), command })
    }

    fn run(&self, line: &[String], place: &Path) -> Result<(Outcome, Duration, String)> {
        run(&self.program, line, place, self.limits)
    }
}

/// Copies a folder.
fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &target)?,
            false => drop(fs::copy(entry.path(), target)?),
        }
    }
    Ok(())
}

/// The number of the next run.
fn done(record: &Path) -> Result<u64> {
    let text = fs::read_to_string(record)?;
    let last = text.lines().next_back().and_then(|line| line.split('\t').next()?.parse::<u64>().ok());
    Ok(last.map_or(0, |last| last + 1))
}

/// The outcomes of a command.
#[derive(Default)]
struct Count {
    runs: u64,
    /// Exit codes 0 to 3.
    codes: [u64; 4],
    findings: u64,
    slowest: u64,
}

fn summary(record: &Path) -> Result<()> {
    let text = fs::read_to_string(record).with_context(|| record.display().to_string())?;
    let mut counts: BTreeMap<&str, Count> = BTreeMap::new();
    for line in text.lines() {
        let fields: Vec<&str> = line.split('\t').collect();
        let [_, command, _, outcome, took] = fields[..] else { bail!("found the line `{line}` in the record") };
        let outcome = Outcome::parse(outcome).with_context(|| format!("found the outcome {outcome}"))?;
        for name in [command, "all"] {
            let count = counts.entry(name).or_default();
            count.runs += 1;
            count.slowest = count.slowest.max(took.parse()?);
            match outcome {
                Outcome::Code(code) => count.codes[code as usize & 3] += 1,
                _ => count.findings += 1,
            }
        }
    }
    println!(
        "{:<9} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>12}",
        "", "runs", "code 0", "1", "2", "3", "findings", "slowest (s)"
    );
    let findings = counts.get("all").map_or(0, |count| count.findings);
    for (name, Count { runs, codes: [a, b, c, d], findings, slowest }) in counts {
        let slowest = slowest as f64 / 1000.0;
        println!("{name:<9} {runs:>7} {a:>7} {b:>7} {c:>7} {d:>7} {findings:>9} {slowest:>12.1}");
    }
    if findings > 0 {
        bail!("{findings} runs went wrong");
    }
    Ok(())
}
