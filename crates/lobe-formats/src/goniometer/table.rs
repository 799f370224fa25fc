//! Reads the table in a text, and the lines around it.

use std::borrow::Cow;
use std::path::Path;

use super::chosen::meanings;
use super::claims::Claim;
use super::directions::has_directions;
use super::facts::Facts;
use super::layout::Layout;
use super::meaning::Meaning;
use super::raw::Raw;
use super::rows::describe;
use super::sheet::{Cell, Dialect, Line, lines};
use super::start::{HEAD, has_names, start};
use super::stated;
use super::trouble::Trouble;
use crate::angle::Unit;
use crate::lines::shown;
use crate::reading::ReadOptions;
use crate::{FormatError, Place};

/// `true` if the text has a line of names that determine the directions of light and viewer, with rows of numbers below
/// it.
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

/// `true` if the text has rows of numbers, or some below the name of an angle, or a line of names of both directions.
pub(super) fn has_rows(text: &str) -> bool {
    let lines: Vec<Line<'_>> = lines(text).take(HEAD).collect();
    if has_names(&lines) {
        return true;
    }
    let Some(dialect) = Dialect::of(&lines, None) else { return false };
    let is_row = |line: &Line<'_>, width: usize| {
        let cells = dialect.cells_to_the_last(line.text);
        let numbers = cells.iter().filter(|cell| matches!(dialect.cell(cell), Cell::Number(_))).count();
        numbers + 1 >= width
            && cells.len() >= width
            && cells.iter().all(|cell| !matches!(dialect.cell(cell), Cell::Text))
    };
    // Prose also contains numbers, so half of the lines must be rows, or half of those below the names.
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
    if options.decimal_comma.is_none()
        && let Some((line, number)) = dialect.ambiguous(&lines[start.first..])
    {
        let expected = "numbers without separators of thousands, or --decimal-comma if these are decimals";
        let found = format!("{number}, and no comma that can only be one of decimals");
        return Err(FormatError::new(file, Place::Line(line), found, expected));
    }
    let mut facts = Facts::default();
    let (names_line, has_names) = (start.names_line, !start.names.is_empty());
    let above = lines[..start.first].iter().rposition(|line| line.number < names_line);
    for (at, line) in
        lines[..start.first].iter().enumerate().filter(|(_, line)| line.number != names_line || !has_names)
    {
        let is_below = line.number > names_line;
        let is_next = is_below || (above == Some(at) && are_units(dialect, line));
        if !(has_names && is_next && add_units(&mut start.names, dialect, line)) {
            facts.add(dialect, line);
        }
    }
    let of_line = if start.names_line == 0 { lines[start.first].number } else { start.names_line };
    let meanings = meanings(&start.names, start.width, options).map_err(|trouble| at(of_line, trouble))?;
    // A column whose first cells are words has no measured values.
    let sample: Vec<Vec<Cow<'_, str>>> =
        lines[start.first..].iter().take(20).map(|line| dialect.cells(line.text)).collect();
    let is_word = |column: usize| {
        let cells: Vec<Cell> = sample.iter().filter_map(|row| row.get(column)).map(|cell| dialect.cell(cell)).collect();
        !cells.is_empty() && !cells.iter().any(|cell| matches!(cell, Cell::Number(_))) && cells.contains(&Cell::Text)
    };
    let is_text: Vec<bool> = (0..meanings.len()).map(is_word).collect();
    // A column of units or factors says of the values what a line above them would say.
    for (column, name) in
        start.names.iter().enumerate().filter(|(column, _)| meanings.get(*column) == Some(&Meaning::Unknown))
    {
        facts.claims.extend(lines[start.first..].iter().zip(&sample).find_map(|(line, row)| {
            let cell = row.get(column)?.trim();
            Claim::of(line.number, &format!("{name}: {cell}"), Some((name, cell)))
        }));
    }
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
    let blocks = raw.read_rows(&lines, &start, dialect, file)?;
    blocks.close(&mut raw, options, file)?;
    let open = raw.facts.claims.iter().find(|claim| !claim.is_settled(raw.layout.quantity, options));
    if let Some(Claim { line, text, stated, .. }) = open {
        let found = format!("{} in the line {}", stated.found, shown(text));
        return Err(FormatError::new(file, Place::Line(*line), found, stated.expected));
    }
    Ok(raw)
}

/// Adds advice on the options for whatever was not understood.
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

/// `true` for a line of two or more cells, all of which are units.
fn are_units(dialect: Dialect, line: &Line<'_>) -> bool {
    let cells = dialect.cells_to_the_last(line.comment().unwrap_or(line.text));
    let units: Vec<&str> = cells.iter().map(|cell| cell.trim_matches(['[', ']', '(', ')'])).collect();
    let mut filled = units.iter().filter(|unit| !unit.is_empty());
    filled.clone().count() > 1 && filled.all(|unit| unit.parse::<Unit>().is_ok() || stated::is_unit(unit))
}

/// Adds the units of a line next to the names to those that state none.
fn add_units(names: &mut [String], dialect: Dialect, line: &Line<'_>) -> bool {
    let cells = dialect.cells_to_the_last(line.comment().unwrap_or(line.text));
    let units: Vec<&str> = cells.iter().map(|cell| cell.trim_matches(['[', ']', '(', ')'])).collect();
    let is_unit = |cell: &&str| cell.parse::<Unit>().is_ok() || stated::is_unit(cell);
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
