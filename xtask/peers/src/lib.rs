//! `cargo xtask peers`: compares other libraries with this one, on the same tables and queries, in turns.
//!
//! Peers available as wheels are installed into a virtual environment; SLEEF and Embree are taken from the system. Each
//! peer runs in a separate process, which answers one request per line; an unavailable peer is left out, and the reason
//! is printed. All values are compared before anything is timed.
#![cfg(target_os = "linux")]
#![forbid(unsafe_code)]

mod analytic;
mod comparison;
mod contest;
mod contests;
mod exchange;
mod frames;
mod install;
mod interpolation;
mod material;
mod processor;
mod program;
mod python;
mod record;
mod referee;
mod row;
mod speed;
mod tracing;
mod trigonometry;
mod variance;

use std::path::{Path, PathBuf};

use anyhow::{Context, bail, ensure};
use clap::Parser;

use contest::Least;
use exchange::Exchange;
use program::{Program, Programs};
use record::Record;
use xtask_common::Steps;
use xtask_common::{Machine, replace};

/// Compare speed, values and noise with other libraries, in one run; what cannot be installed is left out
#[derive(Parser, Debug)]
#[command(
    bin_name = "cargo xtask peers",
    after_help = "Examples:
  cargo xtask peers
  cargo xtask peers --only rgl --only variance --turns 6
  cargo xtask peers --record"
)]
pub struct Options {
    /// Number of turns of every contestant
    #[arg(long, value_name = "COUNT", default_value_t = 12)]
    turns: usize,
    /// Run only the contests whose names begin with this
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    only: Vec<String>,
    /// Directory of the environment, of exchanged files and of peers.json
    #[arg(long, value_name = "DIR", default_value = "target/peers")]
    out: PathBuf,
    /// Directory of measured materials, `rgl_bsdf/*.bsdf` [default: LOBE_SHARED/data, else ../shared/data]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Also write the table to docs/performance.md
    #[arg(long)]
    record: bool,
}

/// Installs, checks, measures, prints and writes.
///
/// # Errors
/// If a peer's values differ from those of this library, a program fails, or a file cannot be written.
pub fn run(options: &Options) -> anyhow::Result<()> {
    let machine = Machine::here();
    std::fs::create_dir_all(&options.out).with_context(|| format!("cannot create {}", options.out.display()))?;
    // Programs are started with absolute paths, so that they can be started from anywhere.
    let out = options.out.canonicalize()?;
    let data = options.data.clone().unwrap_or_else(default_data);
    let mut exchange = Exchange::new(&out)?;
    let mut contests = contests::all(&data, &mut exchange, &options.only)?;
    let is_asked =
        |name: &str| options.only.is_empty() || options.only.iter().any(|start| name.starts_with(start.as_str()));
    let variance = is_asked(variance::Question::NAME).then(|| variance::Question::new(&data, &mut exchange));
    let pictures = is_asked(frames::Question::NAME).then(|| frames::Question::new(&data, &mut exchange));
    let (variance, pictures) = (variance.transpose()?, pictures.transpose()?);
    if contests.is_empty() && variance.is_none() && pictures.is_none() {
        bail!("no contest has a name that begins with {}", options.only.join(" or "));
    }
    let tasks = exchange.write_tasks()?;

    let mut programs = Programs::default();
    for (name, command) in install::all(&out, &tasks, &exchange) {
        println!("{name}: starting");
        programs.add(name, command.and_then(|command| Program::start(command, &out.join(format!("{name}.log")))));
    }
    for (name, why) in programs.missing() {
        println!("{name}: left out, {why}");
    }
    if material::files(&data).is_empty() {
        println!("EPFL materials: left out, no rgl_bsdf/*.bsdf in {}", data.display());
    }
    if !tracing::statue_file(&data).is_file() {
        println!("statue: left out, no {}", tracing::statue_file(&data).display());
    }
    contests.retain_mut(|contest| contest.keep_present(&programs));

    let core = processor::pin();
    let at_start = speed::measure();
    let steps = Steps::new((contests.len() * (options.turns + 1)) as u64 + 2);
    let (mut rows, mut faults) = (Vec::new(), Vec::new());
    let mut taking_part = Vec::new();
    for mut contest in contests {
        steps.begin(contest.name());
        // A contest whose values differ must not keep the others from being measured.
        match contest.check(&mut programs, &exchange) {
            Ok(differences) => taking_part.push((contest, differences, Least::default())),
            Err(error) => {
                faults.push(format!("{error:#}"));
                steps.done(options.turns as u64);
            }
        }
        steps.done(1);
    }
    // All contests have a turn before any has its next one, so that a short disturbance spoils one turn of many
    // contests and not all turns of one.
    for _ in 0..options.turns {
        for (contest, _, least) in &mut taking_part {
            steps.begin(contest.name());
            contest.turn(&mut programs, least)?;
            steps.done(1);
        }
    }
    for (contest, differences, least) in &taking_part {
        rows.extend(contest.rows(least, differences));
    }
    let speed = speed::kept(&out.join("speed.json"), &machine.cpu, [at_start, speed::measure()])?;
    let variances = match variance {
        Some(question) => steps.part("variances", || question.answer(&mut programs, &exchange))?,
        None => Vec::new(),
    };
    let pictures = match pictures {
        Some(question) => {
            let shown = difference_picture(options, &out);
            steps.part("pictures", || question.answer(&mut programs, &exchange, &shown))?
        }
        None => Vec::new(),
    };
    drop(steps);

    let missing = programs.missing().map(|(name, why)| [name.to_owned(), why]).collect();
    let record = Record {
        machine,
        core,
        speed,
        turns: options.turns,
        versions: programs.versions(),
        missing,
        rows,
        variances,
        pictures,
    };
    record.print();
    let json = out.join("peers.json");
    replace(&json, serde_json::to_string_pretty(&record)? + "\n")?;
    println!("{}", json.display());
    if options.record {
        let page = workspace().join("docs/performance.md");
        replace(&page, record.markdown())?;
        println!("{}", page.display());
    }
    ensure!(faults.is_empty(), "left out of the table: {}", faults.join("; "));
    Ok(())
}

/// The file that shows the pictures of two renderers side by side.
fn difference_picture(options: &Options, out: &Path) -> PathBuf {
    const NAME: &str = "mitsuba-difference.png";
    if options.record { workspace().join("docs/pictures").join(NAME) } else { out.join(NAME) }
}

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("this package lies in the workspace")
}

fn default_data() -> PathBuf {
    std::env::var_os("LOBE_SHARED").map_or_else(|| workspace().join("../shared"), PathBuf::from).join("data")
}
