//! Finds the table in a text: the line of names, the rows, and what stands around them.

use std::borrow::Cow;
use std::path::Path;

use super::chosen::{meanings, of_name};
use super::directions::has_directions;
use super::facts::{Facts, fixed};
use super::layout::{Layout, Trouble};
use super::names::{Meaning, Unit};
use super::rows::{Raw, describe};
use super::sheet::{Cell, Dialect, Line, lines, names};
use crate::lines::shown;
use crate::reading::{Position, ReadOptions};
use crate::{FormatError, Place};

/// Lines that are looked at to find the names.
const HEAD: usize = 2000;
/// Lines between the names and the first row: units, rulers, comments.
const GAP: usize = 4;

/// A line of names with the first row after it.
pub(super) struct Start {
    pub names: Vec<String>,
    pub names_line: usize,
    /// Position of the first row in the list of lines.
    pub first: usize,
    pub width: usize,
}

/// `true` if the text has a line of names that say where the light and the viewer are, with rows of numbers below it.
pub(super) fn is_named_table(text: &str) -> bool {
    let lines: Vec<Line<'_>> = lines(text).take(HEAD).collect();
    let options = ReadOptions::default();
    let Some(dialect) = Dialect::of(&lines, None) else { return false };
    let Ok(start) = start(&lines, dialect, &options) else { return false };
    let mut facts = Facts::default();
    lines[..start.first]
        .iter()
        .filter(|line| line.number != start.names_line)
        .for_each(|line| facts.add(dialect, line));
    meanings(&start.names, start.width, &options).is_ok_and(|meanings| has_directions(meanings, &facts))
}

/// `true` if the text has rows of numbers, or some below the name of an angle.
pub(super) fn has_rows(text: &str) -> bool {
    let lines: Vec<Line<'_>> = lines(text).take(HEAD).collect();
    let Some(dialect) = Dialect::of(&lines, None) else { return false };
    let is_row = |line: &Line<'_>, width: usize| {
        let cells = dialect.cells_to_the_last(line.text);
        let numbers = cells.iter().filter(|cell| matches!(dialect.cell(cell), Cell::Number(_))).count();
        numbers + 1 >= width
            && cells.len() >= width
            && cells.iter().all(|cell| !matches!(dialect.cell(cell), Cell::Text))
    };
    // Prose has numbers in it as well: half of the lines are rows, or half of those below the names.
    let are_rows = |lines: &[Line<'_>], least: usize, width: usize| {
        let rows = lines.iter().filter(|line| is_row(line, width)).count();
        rows >= least && 2 * rows > lines.len()
    };
    are_rows(&lines, 4, 3)
        || start(&lines, dialect, &ReadOptions::default()).is_ok_and(|start| are_rows(&lines[start.first..], 1, 2))
}

/// Reads the table of a text.
pub(super) fn read(text: &str, file: &Path, options: &ReadOptions) -> Result<Raw, FormatError> {
    let lines: Vec<Line<'_>> = lines(text).collect();
    let whole = |found: &str| {
        let expected = "a line of names such as theta_i,theta_o,phi_o,f with rows of numbers below it";
        FormatError::new(file, Place::File, found, expected)
    };
    let Some(dialect) = Dialect::of(&lines, options.decimal_comma) else { return Err(whole("no rows of numbers")) };
    let at = |number: usize, trouble: Trouble| {
        hint(FormatError::new(file, Place::Line(number), trouble.found, trouble.expected), options)
    };
    let mut start = start(&lines, dialect, options).map_err(|(line, trouble)| at(line, trouble))?;
    let mut facts = Facts::default();
    let (names_line, has_names) = (start.names_line, !start.names.is_empty());
    for line in lines[..start.first].iter().filter(|line| line.number != names_line || !has_names) {
        let is_below = line.number > names_line && has_names;
        if !(is_below && add_units(&mut start.names, dialect, line)) {
            facts.add(dialect, line);
        }
    }
    let of_line = if start.names_line == 0 { lines[start.first].number } else { start.names_line };
    let meanings = meanings(&start.names, start.width, options).map_err(|trouble| at(of_line, trouble))?;
    // Of a column whose first cells are words, nothing is measured.
    let sample: Vec<Vec<Cow<'_, str>>> =
        lines[start.first..].iter().take(20).map(|line| dialect.cells(line.text)).collect();
    let is_word = |column: usize| {
        let cells: Vec<Cell> = sample.iter().filter_map(|row| row.get(column)).map(|cell| dialect.cell(cell)).collect();
        !cells.is_empty() && !cells.iter().any(|cell| matches!(cell, Cell::Number(_))) && cells.contains(&Cell::Text)
    };
    let is_text: Vec<bool> = (0..meanings.len()).map(is_word).collect();
    let layout =
        Layout::new(&start.names, meanings, &is_text, &facts, options).map_err(|trouble| at(of_line, trouble))?;
    let mut notes = vec![dialect.describe()];
    let columns: Vec<String> = describe(&layout, &start.names);
    notes.push(columns.join(", "));
    let mut raw = Raw {
        layout,
        facts,
        rows: Vec::new(),
        lines: Vec::new(),
        values: Vec::new(),
        wavelengths: Vec::new(),
        notes,
        names_line: start.names_line,
    };
    raw.read_rows(&lines, &start, dialect, file)?;
    Ok(raw)
}

/// Adds how to say what was not understood.
fn hint(error: FormatError, options: &ReadOptions) -> FormatError {
    let how = "say which column is which with --columns theta_i=1,theta_o=2,phi_o=3,f=4";
    let sidecar = crate::sidecar::path_of(&error.file);
    let name = sidecar.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let expected = match options.columns.is_empty() {
        true => format!("{}; {how} (a constant: theta_i=30deg), or with columns = \"...\" in {name}", error.expected),
        false => error.expected,
    };
    FormatError { expected, ..error }
}

/// Whether a line has more numbers than words, and two or more.
fn is_row(dialect: Dialect, line: &Line<'_>) -> bool {
    let cells: Vec<Cell> = dialect.cells_to_the_last(line.text).iter().map(|cell| dialect.cell(cell)).collect();
    let numbers = cells.iter().filter(|cell| matches!(cell, Cell::Number(_))).count();
    let texts = cells.iter().filter(|cell| matches!(cell, Cell::Text)).count();
    line.comment().is_none() && numbers >= 2 && texts < numbers
}

/// The line of names, and the first row.
fn start(lines: &[Line<'_>], dialect: Dialect, options: &ReadOptions) -> Result<Start, (usize, Trouble)> {
    let head = &lines[..lines.len().min(HEAD)];
    // As many names as cells come first, and names that are no comment.
    for (has_same_width, is_comment) in [(true, false), (true, true), (false, false), (false, true)] {
        for (index, line) in head.iter().enumerate().filter(|(_, line)| line.comment().is_some() == is_comment) {
            if let Some(start) = named_start(&head[index..], dialect, has_same_width) {
                return Ok(Start { first: index + start.first, names_line: line.number, ..start });
            }
        }
    }
    // No names of angles: the first row of numbers, and the line above it if it has as many cells.
    let first = head.iter().position(|line| is_row(dialect, line)).ok_or_else(|| {
        (1, Trouble::new("no rows of numbers in the first lines", "a line of names with rows of numbers below it"))
    })?;
    let width = dialect.cells_to_the_last(lines[first].text).len();
    let above = first.checked_sub(1).map(|above| &lines[above]);
    let above = above.map(|line| (line.number, names(dialect, line.comment().unwrap_or(line.text), width)));
    let above = above.filter(|(_, names)| names.len() == width);
    if options.columns.iter().all(|column| matches!(column.at, Position::Fixed(..))) {
        let (number, found) = match &above {
            Some((number, names)) => (*number, format!("names that are no angles, {}", numbered(names))),
            None => (lines[first].number, format!("a row without names above it, {}", shown(lines[first].text.trim()))),
        };
        return Err((number, Trouble::new(found, "names such as theta_i, theta_o, phi_o and f")));
    }
    let (names_line, names) = above.unwrap_or_default();
    Ok(Start { names, names_line, first, width })
}

/// The table that the first of some lines is the head of, if its names are those of angles and rows follow.
fn named_start(lines: &[Line<'_>], dialect: Dialect, has_same_width: bool) -> Option<Start> {
    let line = lines.first()?;
    if fixed(dialect, line).is_some() {
        return None;
    }
    // Between are units, rulers and comments.
    let first = 1 + lines[1..].iter().take(GAP).position(|line| is_row(dialect, line))?;
    let width = dialect.cells_to_the_last(lines[first].text).len();
    let names = names(dialect, line.comment().unwrap_or(line.text), width);
    let is_too_short = names.len() < 2 || (names.len() < width && dialect.delimiter.is_none());
    if is_too_short || (has_same_width && names.len() != width) {
        return None;
    }
    let meanings: Vec<Meaning> = names.iter().map(|name| of_name(name)).collect();
    let is_angle = |meaning: &Meaning| {
        matches!(meaning, Meaning::Angle(..) | Meaning::EitherTheta(_) | Meaning::EitherPhi(_) | Meaning::AnyAngle(_))
    };
    // A word and a number are a fact, or the count of a list.
    let is_fact = matches!(meanings.as_slice(), [_, Meaning::Number(..)]);
    let width = names.len();
    (!is_fact && meanings.iter().any(is_angle)).then_some(Start { names, names_line: 0, first, width })
}

/// Adds the units of a line below the names to those that state none.
fn add_units(names: &mut [String], dialect: Dialect, line: &Line<'_>) -> bool {
    let cells = dialect.cells_to_the_last(line.comment().unwrap_or(line.text));
    let units: Vec<&str> = cells.iter().map(|cell| cell.trim_matches(['[', ']', '(', ')'])).collect();
    let is_unit = |cell: &&str| cell.parse::<Unit>().is_ok();
    if units.len() > names.len() || !units.iter().any(is_unit) {
        return false;
    }
    for (name, unit) in names.iter_mut().zip(units) {
        let is_open = !name.ends_with([']', ')']) && !unit.is_empty();
        if is_open && unit.chars().any(|c| c.is_alphanumeric() || c == '°' || c == '%') {
            *name = format!("{name} [{unit}]");
        }
    }
    true
}

/// Names with the numbers of their columns.
fn numbered(names: &[String]) -> String {
    let shown: Vec<String> =
        names.iter().take(12).enumerate().map(|(i, name)| format!("{}: {}", i + 1, shown(name))).collect();
    let more = if names.len() > 12 { format!(" and {} more", names.len() - 12) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}
