//! `cargo xtask report`: the paper's tables on this machine, as a page, as JSON and on the terminal.

mod bars;
mod curve;
mod equivalence;
mod machine;
mod measure;
mod page;
mod paper;
mod pictures;
mod rows;
mod sections;
mod style;
mod svg;
mod terminal;
mod write;

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use serde::Serialize;

use equivalence::EquivalenceSummary;
use pictures::Pictures;
use rows::Row;

pub(crate) use machine::Machine;
pub(crate) use rows::{nanoseconds, times};
pub(crate) use write::replace;

/// The id of the section of that name.
const PICTURES: &str = "pictures";

/// Options of `cargo xtask report`.
#[derive(Args, Debug)]
pub struct Options {
    /// Fewer queries and rounds: under a minute, ratios within some 10 %
    #[arg(long)]
    quick: bool,
    /// Only these questions, by their ids in report.json; `pictures` is the section of that name
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
    pictures: Option<Pictures>,
}

/// Measures, prints and writes.
///
/// # Errors
/// Where a contender's values are wrong, or a file cannot be written.
pub fn run(options: &Options) -> anyhow::Result<()> {
    let machine = Machine::here();
    let plan = if options.quick { measure::Plan::QUICK } else { measure::Plan::FULL };
    let (sections, questions): (Vec<_>, Vec<_>) = options.only.iter().cloned().partition(|id| id == PICTURES);
    let rows = if sections.is_empty() || !questions.is_empty() { measure::all(plan, &questions)? } else { Vec::new() };
    let wanted = options.only.is_empty() || !sections.is_empty();
    let pictures = wanted.then(|| pictures::measure(options.quick)).transpose()?;
    let report = Report { machine, quick: options.quick, rows, equivalence: equivalence::summary(), pictures };

    terminal::print(&report);
    std::fs::create_dir_all(&options.out).with_context(|| format!("cannot create {}", options.out.display()))?;
    let json = serde_json::to_string_pretty(&report)? + "\n";
    write::replace(&options.out.join("report.json"), &json)?;
    if let Some(path) = &options.json {
        write::replace(path, &json)?;
    }
    let page = options.out.join("index.html");
    write::replace(&page, &page::html(&report))?;
    println!("{}", page.display());
    Ok(())
}
