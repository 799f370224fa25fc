//! Lists of angles, and the choice of a measurement of a sheet, from the command line.

use std::cell::Cell;
use std::io::{IsTerminal, stdout};
use std::path::Path;

use clap::ValueEnum;
use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, Table, Width, presets};
use lobe::Side;
use lobe::table::Scatter;
use lobe_ops::{Aspect, Subject};

use crate::failure::Failure;
use crate::progress::Progress;

/// Angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Angles(pub Vec<f64>);

impl Angles {
    /// Degrees, without the digits that their conversion to radians added.
    pub fn degrees(&self) -> Vec<f64> {
        self.0.iter().map(|angle| (angle.to_degrees() * 1e9).round() / 1e9).collect()
    }
}

/// The longest list: more knots than any instrument has positions.
const LONGEST: f64 = 100_000.0;

/// Parses degrees separated by commas; `first:last:step` means a sequence of them.
pub fn parse_angles(text: &str) -> Result<Angles, String> {
    let mut angles = Vec::new();
    for item in text.split(',') {
        let numbers = item.split(':').map(|word| {
            let number: Option<f64> = word.trim().parse().ok();
            number
                .filter(|n| n.is_finite())
                .ok_or_else(|| format!("found `{word}`; expected a finite number of degrees"))
        });
        match numbers.collect::<Result<Vec<f64>, String>>()?.as_slice() {
            [angle] => angles.push(*angle),
            [first, last, step] if *step > 0.0 && last >= first && (last - first) / step < LONGEST => {
                // The last angle must not be lost to rounding, so half a step is allowed.
                let steps = ((last - first) / step + 1e-9).floor() as usize;
                angles.extend((0..=steps).map(|index| first + index as f64 * step));
            }
            _ => return Err(format!("found `{item}`; expected an angle, or first:last:step with a step above 0")),
        }
    }
    Ok(Angles(angles.into_iter().map(f64::to_radians).collect()))
}

/// Refuses knots in degrees that no table has: sigma, psi, theta and phi.
pub fn check_knots(file: &Path, knots: [&[f64]; 4]) -> Result<(), Failure> {
    let axes = [("sigma", 90.0), ("psi", 360.0), ("theta", 180.0), ("phi", 360.0)];
    for ((name, most), knots) in axes.into_iter().zip(knots) {
        let refuse = |found: String, expected: &str| {
            Err(Failure::Usage(format!("{}: found {name} knots {found}; expected {expected}", file.display())))
        };
        // Knots of a sequence are rounded.
        if let Some(knot) = knots.iter().find(|knot| !(0.0..=most + 1e-9).contains(*knot)) {
            return refuse(format!("at {knot} degrees"), &format!("0 to {most}"));
        }
        if let Some([first, second]) = knots.array_windows().find(|[first, second]| second <= first) {
            return refuse(format!("at {first} and then {second} degrees"), "strictly ascending knots");
        }
    }
    Ok(())
}

/// Light that stays on its side, or passes through.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum ScatterRule {
    Reflection,
    Transmission,
}

/// The side that the light comes from.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum SideRule {
    /// z > 0.
    Front,
    /// z < 0.
    Back,
}

/// The requested measurements of a file; all of them if none is requested.
pub fn choose_aspects(
    file: &Path,
    subject: &Subject,
    scatter: Option<ScatterRule>,
    side: Option<SideRule>,
) -> Result<Vec<Aspect>, Failure> {
    let all = subject.aspects();
    let fits = |aspect: &&Aspect| {
        let is_scatter =
            scatter.is_none_or(|rule| (rule == ScatterRule::Reflection) == (aspect.scatter == Scatter::Reflection));
        is_scatter && side.is_none_or(|rule| (rule == SideRule::Front) == (aspect.light == Side::Front))
    };
    let chosen: Vec<Aspect> = all.iter().filter(fits).copied().collect();
    if chosen.is_empty() {
        let there: Vec<String> = all.iter().map(Aspect::to_string).collect();
        return Err(Failure::Usage(format!(
            "{}: found {}; expected the requested scatter and side",
            file.display(),
            there.join(", ")
        )));
    }
    Ok(chosen)
}

/// Lines are not wrapped if the terminal is narrower than this, or reports no columns.
const NARROWEST: u16 = 40;

/// A table for the terminal, with all columns but the first `words` right-aligned. Lines are wrapped only on a
/// terminal, and words are never cut.
pub fn table(header: Vec<String>, rows: Vec<Vec<String>>, words: usize) -> Table {
    let columns = header.len();
    let longest = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).chain([&header[column]]);
        cells.flat_map(|cell| cell.split_whitespace()).map(|word| word.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<u16> = (0..columns).map(|column| longest(column).try_into().unwrap_or(u16::MAX)).collect();
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Dynamic).set_header(header);
    rows.into_iter().for_each(|row| {
        table.add_row(row);
    });
    let narrowest = widths.iter().fold(NARROWEST, |sum, width| sum.saturating_add(*width).saturating_add(2));
    if !stdout().is_terminal() || table.width().is_none_or(|width| width < narrowest) {
        table.set_content_arrangement(ContentArrangement::Disabled);
    }
    for (index, width) in widths.into_iter().enumerate() {
        if let Some(column) = table.column_mut(index) {
            column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(width)));
            if index >= words {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
    }
    table
}

/// A progress bar that receives the finished share.
pub fn progress(what: &'static str) -> impl Fn(f64) {
    let (bar, done) = (Progress::new(100, what), Cell::new(0));
    move |share: f64| {
        let percent = (100.0 * share).clamp(0.0, 100.0) as usize;
        (done.get()..percent).for_each(|_| bar.step());
        done.set(percent.max(done.get()));
    }
}

/// A direction as its polar angle and azimuth in degrees.
pub fn show_direction([x, y, z]: [f64; 3]) -> String {
    let (theta, phi) = (x.hypot(y).atan2(z).to_degrees(), y.atan2(x).to_degrees().rem_euclid(360.0));
    format!("{theta:.1}, {phi:.1}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_ranges() {
        let degrees =
            |text: &str| parse_angles(text).map(|Angles(list)| list.iter().map(|a| a.to_degrees().round()).collect());
        assert_eq!(degrees("0, 5,90"), Ok(vec![0.0, 5.0, 90.0]));
        assert_eq!(degrees("0:90:30,360"), Ok(vec![0.0, 30.0, 60.0, 90.0, 360.0]));
        for bad in ["", "a", "0:90", "0:90:0", "90:0:5", "0:1e9:1e-9", "nan"] {
            assert!(degrees(bad).is_err(), "{bad}");
        }
    }
}
