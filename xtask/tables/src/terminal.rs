//! Prints the tables on the terminal.

use comfy_table::{CellAlignment, Table, presets};
use lobe_benches::workload::Input;
use xtask_common::{Machine, nanoseconds, times};

use super::rows::{self, Row};
use super::sections::Section;

/// Prints the machine that the figures come from.
pub fn heading(machine: &Machine) {
    println!("{}, {} cores, {}", machine.cpu, machine.cores, machine.compiler);
    if let Some(load) = machine.load.filter(|load| *load > 1.0) {
        println!("The machine was busy when the run began (load {load:.1}): figures are noisy.");
    }
}

/// Prints one table per question of a section.
pub fn print(section: &Section, rows: &[Row]) {
    println!("\n{}", section.title);
    if let Some(paper) = section.paper {
        let [scalar, sse] = paper.nanoseconds().map(nanoseconds);
        let times = times(paper.ratio());
        println!("Table {} of the paper: {scalar} ns scalar, {sse} ns with SSE, {times} the speed", paper.number);
    }
    for question in &section.questions {
        println!("{} ({}), ns per {}", question.title, question.id, question.unit);
        println!("{}", table(rows, question.id));
    }
}

/// One row per backend; for each input, columns with the time and the ratio to each baseline.
fn table(all: &[Row], id: &str) -> Table {
    let rows_of = || all.iter().filter(|row| row.id == id);
    let baselines = rows::distinct(rows_of(), |row| &row.baseline);
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    let mut header = vec!["".to_owned()];
    for input in Input::ALL {
        header.push(format!("{} ns", input.name()));
        header.extend(baselines.iter().map(|baseline| format!("× {baseline}")));
    }
    table.set_header(header);
    for baseline in &baselines {
        let mut cells = vec![(*baseline).to_owned()];
        for input in Input::ALL {
            let row = rows::of(all, id, input.name()).find(|row| row.baseline == *baseline);
            cells.push(row.map_or_else(String::new, |row| nanoseconds(row.baseline_ns)));
            cells.extend(baselines.iter().map(|_| String::new()));
        }
        table.add_row(cells);
    }
    for backend in rows::distinct(rows_of(), |row| &row.backend) {
        let mut cells = vec![rows::shown(backend)];
        for input in Input::ALL {
            let find = |baseline: &&str| rows::find(all, id, input.name(), backend, baseline);
            let ns = baselines.first().and_then(find).map(|row| nanoseconds(row.ns));
            cells.push(ns.unwrap_or_default());
            cells.extend(baselines.iter().map(|b| find(b).map(|row| times(row.ratio)).unwrap_or_default()));
        }
        table.add_row(cells);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
