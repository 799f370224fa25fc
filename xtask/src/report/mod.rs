//! `cargo xtask report`: the paper's tables on this machine, as a page, as JSON and on the terminal.

mod bars;
mod curve;
mod energy;
mod equivalence;
mod formats;
mod grid;
mod machine;
mod measure;
mod page;
mod paper;
mod pictures;
mod rows;
mod samplers;
mod sections;
mod style;
mod svg;
mod terminal;
mod write;

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use serde::Serialize;

use energy::Energy;
use equivalence::EquivalenceSummary;
use pictures::Pictures;
use rows::Row;
use samplers::SamplerCost;

use crate::golden::Comparison;
use crate::steps::Steps;

pub(crate) use grid::Grid;
pub(crate) use machine::Machine;
pub(crate) use rows::{nanoseconds, times};
pub(crate) use write::replace;

/// Measure this machine: equivalence, the paper's tables, everything beyond them, as a page and on the terminal
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  cargo xtask report
  cargo xtask report --quick --only iso,aniso
  cargo xtask report --only formats --json formats.json")]
pub struct Options {
    /// Fewer queries and rounds: under a minute, ratios within some 10 %
    #[arg(long)]
    quick: bool,
    /// Only these questions, by their ids in report.json, or `formats`, `energy`, `samplers` or `pictures`
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    only: Vec<String>,
    /// Also write the rows to this file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Directory of index.html and report.json
    #[arg(long, value_name = "DIR", default_value = "target/report")]
    out: PathBuf,
}

/// All that is shown, and the document in `report.json`.
#[derive(Debug, Serialize)]
struct Report {
    machine: Machine,
    quick: bool,
    rows: Vec<Row>,
    equivalence: EquivalenceSummary,
    formats: Option<Vec<Comparison>>,
    energy: Vec<Energy>,
    samplers: Vec<SamplerCost>,
    pictures: Option<Pictures>,
}

impl Report {
    /// What is not about speed.
    fn grids(&self) -> Vec<Grid> {
        let mut grids = formats::grids(self.formats.as_deref());
        grids.extend(energy::grids(&self.energy));
        grids.extend(samplers::grids(&self.samplers));
        grids.extend(self.pictures.as_ref().map(Pictures::grid));
        grids
    }
}

/// Measures, prints and writes.
///
/// # Errors
/// Where a contender's values are wrong, or a file cannot be read or written.
pub fn run(options: &Options) -> anyhow::Result<()> {
    let machine = Machine::here();
    let rounds = if options.quick { measure::QUICK } else { measure::FULL };
    let is_section = |id: &&String| [formats::ID, energy::ID, samplers::ID, pictures::ID].contains(&id.as_str());
    let (sections, questions): (Vec<&String>, Vec<&String>) = options.only.iter().partition(is_section);
    let is_all = options.only.is_empty();
    let is_asked = |section: &str| is_all || sections.iter().any(|asked| *asked == section);
    let rows = if is_all || !questions.is_empty() { measure::all(rounds, &questions)? } else { Vec::new() };
    let steps = Steps::new(4);
    let formats = is_asked(formats::ID).then(|| steps.part(formats::ID, formats::compare)).transpose()?;
    let energy = is_asked(energy::ID).then(|| steps.part(energy::ID, energy::all)).transpose()?;
    let samplers = is_asked(samplers::ID).then(|| steps.part(samplers::ID, || samplers::all(options.quick)));
    let pictures = is_asked(pictures::ID).then(|| steps.part(pictures::ID, || pictures::measure(options.quick)));
    drop(steps);
    let (energy, samplers) = (energy.unwrap_or_default(), samplers.transpose()?.unwrap_or_default());
    let pictures = pictures.transpose()?;
    let equivalence = equivalence::summary();
    let report = Report { machine, quick: options.quick, rows, equivalence, formats, energy, samplers, pictures };

    terminal::print(&report);
    std::fs::create_dir_all(&options.out).with_context(|| format!("cannot create {}", options.out.display()))?;
    let json = serde_json::to_string_pretty(&report)? + "\n";
    write::replace(&options.out.join("report.json"), &json)?;
    if let Some(path) = &options.json {
        write::replace(path, &json)?;
    }
    let page = options.out.join("index.html");
    write::replace(&page, page::html(&report))?;
    println!("{}", page.display());
    Ok(())
}
