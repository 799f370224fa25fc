//! Writes the results: on the terminal, as JSON, and as the page in the documentation.

use std::collections::BTreeMap;
use std::fmt::Write;

use comfy_table::{CellAlignment, Table, presets};
use serde::Serialize;

use super::frames::{self, Agreement};
use super::row::Row;
use super::speed::Speed;
use super::variance::{self, Variance};
use xtask_common::{Grid, Machine};

const HEADER: [&str; 8] = ["question", "on", "peer", "peer, ns", "lobe, ns", "speed", "goal", "difference"];

/// Everything that was measured.
#[derive(Debug, Serialize)]
pub struct Record {
    /// The machine.
    pub machine: Machine,
    /// The core, if the process was pinned to one.
    pub core: Option<usize>,
    /// The speed of the machine.
    pub speed: Speed,
    /// The number of turns.
    pub turns: usize,
    /// The peers that took part.
    pub versions: BTreeMap<&'static str, String>,
    /// The peers that did not take part, and the reasons.
    pub missing: Vec<[String; 2]>,
    /// The figures.
    pub rows: Vec<Row>,
    /// The variances of samples.
    pub variances: Vec<Variance>,
    /// The differences between pictures and those of another renderer.
    pub pictures: Vec<Agreement>,
}

impl Record {
    /// The tables on the terminal.
    pub fn print(&self) {
        let mut table = Table::new();
        table.load_style(presets::UTF8_HORIZONTAL_ONLY);
        table.set_header(HEADER);
        for row in &self.rows {
            table.add_row(row.cells());
        }
        for column in table.column_iter_mut().skip(3) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        println!("{table}");
        println!("A multiplication that waits for another takes {}", self.speed.text());
        self.grids().iter().for_each(Grid::print);
    }

    /// The results that are not about speed.
    fn grids(&self) -> Vec<Grid> {
        variance::grid(&self.variances).into_iter().chain(frames::grid(&self.pictures)).collect()
    }

    /// The page.
    pub fn markdown(&self) -> String {
        let Machine { cpu, cores, features, load, compiler, date, commit } = &self.machine;
        let mut page = String::from(HEAD);
        let versions: Vec<_> = self.versions.iter().map(|(name, version)| format!("{name} {version}")).collect();
        let mut line = |name: &str, text: String| writeln!(page, "| {name} | {text} |").expect("a string");
        line("date", date.clone());
        line("processor", format!("{cpu}, {cores} cores, {}", features.join(" ")));
        line("pinned to", self.core.map_or_else(|| "no core".into(), |core| format!("core {core}")));
        line("load at the start", load.map_or_else(|| "unknown".into(), |load| format!("{load:.1}")));
        line("a multiplication that waits for another", self.speed.text());
        line("compiler", compiler.clone());
        line("commit", commit.clone());
        line("peers", versions.join(", "));
        line("turns", self.turns.to_string());
        page += "\n";
        for (name, why) in self.missing.iter().map(|[name, why]| (name, why)) {
            writeln!(page, "Left out: {name}, {why}.\n").expect("a string");
        }
        page += READING;
        writeln!(page, "| {} |\n|---|---|---|--:|--:|--:|--:|--:|", HEADER.join(" | ")).expect("a string");
        for row in &self.rows {
            writeln!(page, "| {} |", row.cells().join(" | ")).expect("a string");
        }
        page.extend(self.grids().iter().map(Grid::markdown));
        if !self.pictures.is_empty() {
            page += PICTURE;
        }
        page
    }
}

const HEAD: &str = "# Performance compared with peers

Written by `cargo xtask peers --record`; [benchmarking](benchmarking.md) explains how to read and reproduce it.

| | |
|---|---|
";

const READING: &str = "Times are nanoseconds of processor time per lookup, evaluation, density, sample or value on one thread, the shortest
of all turns. `speed` is the peer's time divided by lobe's. The goal is set against the fastest peer of each question
whose vectors are no wider than lobe's on this processor. `difference` is the largest relative difference
between lobe's values and the peer's. If lobe and the peer disagree about a ray, all triangles are tested in double
precision: lobe must then be right, and rays that the peer gets wrong are counted next to the difference.

";

const PICTURE: &str = "
lobe, Mitsuba, and the difference in each pixel: white is no difference, full red or blue is four standard deviations.

![This renderer, Mitsuba, and their difference](pictures/mitsuba-difference.png)
";
