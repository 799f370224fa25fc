//! Measures the tables of the paper on this machine, and every other question about speed, and prints each as soon as
//! it is measured.
#![forbid(unsafe_code)]

mod measure;
pub mod paper;
pub mod rows;
pub mod sections;
mod terminal;

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Parser;
use serde::{Deserialize, Serialize};
use xtask_common::{Machine, replace};

use rows::Row;

/// Measure this machine: the paper's tables first, then everything beyond them, as a page and on the terminal
#[derive(Clone, Debug, Parser)]
#[command(
    bin_name = "cargo xtask report",
    after_help = "Examples:
  cargo xtask report
  cargo xtask report --quick --only iso,aniso
  cargo xtask report --only formats --json formats.json"
)]
pub struct Options {
    /// Fewer queries and rounds: under a minute, ratios accurate to about 10 %
    #[arg(long)]
    pub quick: bool,
    /// Only these questions, by their ids in report.json, or `formats`, `conversions`, `energy`, `samplers`, `pictures`
    /// or `equivalence`
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    pub only: Vec<String>,
    /// Also write the rows to this file
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Directory of index.html and report.json
    #[arg(long, value_name = "DIR", default_value = "target/report")]
    pub out: PathBuf,
}

/// The sections that are not about speed.
pub const SECTIONS: [&str; 6] = ["formats", "conversions", "energy", "samplers", "pictures", "equivalence"];

impl Options {
    /// `true` if a section is requested.
    pub fn is_asked(&self, section: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|asked| asked == section)
    }

    /// The questions that are requested; `None` for all of them.
    fn questions(&self) -> Option<Vec<&str>> {
        let is_question = |id: &&str| !SECTIONS.contains(id);
        (!self.only.is_empty()).then(|| self.only.iter().map(String::as_str).filter(is_question).collect())
    }
}

/// The results measured here and shown on the page.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Tables {
    /// The machine on which it was measured.
    pub machine: Machine,
    /// The figures.
    pub rows: Vec<Row>,
}

/// The file that passes the tables on to the rest of the report.
fn file(out: &Path) -> PathBuf {
    out.join("tables.json")
}

impl Tables {
    /// The tables that were last measured for this folder.
    ///
    /// # Errors
    /// If there are none.
    pub fn read(out: &Path) -> anyhow::Result<Self> {
        let path = file(out);
        let opened = File::open(&path).with_context(|| format!("cannot read {}", path.display()))?;
        serde_json::from_reader(BufReader::new(opened))
            .with_context(|| format!("{}: not tables of figures", path.display()))
    }
}

/// Measures, prints, and keeps the figures for the rest of the report.
///
/// # Errors
/// If a contender's values are wrong, or a file cannot be written.
pub fn run(options: &Options) -> anyhow::Result<()> {
    let machine = Machine::here();
    terminal::heading(&machine);
    let rounds = if options.quick { measure::QUICK } else { measure::FULL };
    let rows = measure::all(rounds, options.questions().as_deref(), terminal::print)?;
    let json = serde_json::to_string(&Tables { machine, rows })? + "\n";
    std::fs::create_dir_all(&options.out).with_context(|| format!("cannot create {}", options.out.display()))?;
    replace(&file(&options.out), json)
}
