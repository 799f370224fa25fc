//! The parts of the report beyond the tables of the paper: formats, conversions, energy, samplers, pictures,
//! equivalence, and the page.
#![forbid(unsafe_code)]

mod bars;
mod conversions;
mod curve;
mod energy;
mod equivalence;
mod formats;
pub mod golden;
mod page;
mod pictures;
mod samplers;
mod style;

use anyhow::Context;
use serde::Serialize;
use xtask_common::{Grid, Machine, Steps, replace};
use xtask_tables::rows::Row;
use xtask_tables::{Options, Tables};

use conversions::Conversion;
use energy::Energy;
use equivalence::EquivalenceSummary;
use golden::Comparison;
use pictures::Pictures;
use samplers::SamplerCost;

/// Everything that is shown, and the document in `report.json`.
#[derive(Debug, Serialize)]
struct Report {
    machine: Machine,
    quick: bool,
    rows: Vec<Row>,
    equivalence: Option<EquivalenceSummary>,
    formats: Option<Vec<Comparison>>,
    conversions: Option<Vec<Conversion>>,
    energy: Vec<Energy>,
    samplers: Vec<SamplerCost>,
    pictures: Option<Pictures>,
}

impl Report {
    /// The sections that are not about speed.
    fn grids(&self) -> Vec<Grid> {
        let mut grids = formats::grids(self.formats.as_deref());
        grids.extend(self.conversions.as_deref().map(conversions::grid));
        grids.extend(energy::grids(&self.energy));
        grids.extend(samplers::grids(&self.samplers));
        grids.extend(self.pictures.as_ref().map(Pictures::grid));
        grids
    }
}

/// Measures everything except the tables, prints it, compares the backends, and writes the page with the tables
/// measured before.
///
/// # Errors
/// If there are no tables, a contender's values are wrong, or a file cannot be read or written.
pub fn run(options: &Options) -> anyhow::Result<()> {
    let Tables { machine, rows } = Tables::read(&options.out)?;
    let steps = Steps::new(5);
    let formats = options.is_asked(formats::ID).then(|| steps.part(formats::ID, formats::compare)).transpose()?;
    let conversions = options
        .is_asked(conversions::ID)
        .then(|| steps.part(conversions::ID, || conversions::all(options.quick)))
        .transpose()?;
    let energy = options.is_asked(energy::ID).then(|| steps.part(energy::ID, energy::all)).transpose()?;
    let samplers = options
        .is_asked(samplers::ID)
        .then(|| steps.part(samplers::ID, || samplers::all(options.quick)))
        .transpose()?;
    let pictures = options
        .is_asked(pictures::ID)
        .then(|| steps.part(pictures::ID, || pictures::measure(options.quick)))
        .transpose()?;
    drop(steps);
    let (energy, samplers) = (energy.unwrap_or_default(), samplers.unwrap_or_default());
    let mut report = Report {
        machine,
        quick: options.quick,
        rows,
        equivalence: None,
        formats,
        conversions,
        energy,
        samplers,
        pictures,
    };
    report.grids().iter().for_each(Grid::print);
    // Compiling this takes as long as measuring all figures, so it comes last.
    report.equivalence = options.is_asked(equivalence::ID).then(|| equivalence::summary(&options.out)).transpose()?;
    if let Some(summary) = &report.equivalence {
        equivalence::print(summary);
    }

    let json = serde_json::to_string_pretty(&report)? + "\n";
    replace(&options.out.join("report.json"), &json)?;
    if let Some(path) = &options.json {
        replace(path, &json)?;
    }
    let page = options.out.join("index.html");
    replace(&page, page::html(&report)).with_context(|| format!("{}", page.display()))?;
    println!("{}", page.display());
    Ok(())
}
