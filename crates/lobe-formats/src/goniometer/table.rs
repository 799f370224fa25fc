//! Finds the table in a text: the line of names, the rows, and what stands around them.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use super::facts::{Facts, fixed};
use super::layout::{Layout, SPHERICAL, Source, Trouble, Values, has_directions, meanings};
use super::names::{Angle, Meaning, Unit};
use super::sheet::{Cell, Dialect, Line, lines, names};
use crate::lines::shown;
use crate::reading::{Position, ReadOptions};
use crate::{FormatError, Place};

/// Angles and values as they stand in the file.
pub(super) struct Raw {
    pub layout: Layout,
    pub facts: Facts,
    /// As stated, in the unit of the file: see [`Layout::angles`].
    pub rows: Vec<[f64; 4]>,
    /// The line of each row.
    pub lines: Vec<u32>,
    /// `[row][channel]`, NaN if not measured; for tables with a wavelength per row, one each.
    pub values: Vec<f32>,
    /// The wavelength of each row in nm, if each has its own.
    pub wavelengths: Vec<f64>,
    /// What was understood, for people.
    pub notes: Vec<String>,
    /// Where the names stand; 0 if there are none.
    pub names_line: usize,
}

/// Lines that are looked at to find the names.
const HEAD: usize = 2000;
/// Lines between the names and the first row: units, rulers, comments.
const GAP: usize = 4;

/// A line of names with the first row after it.
struct Start {
    names: Vec<String>,
    names_line: usize,
    /// Position of the first row in the list of lines.
    first: usize,
    width: usize,
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

/// `true` if the text is rows of numbers of which nothing says what they are.
pub(super) fn has_rows(text: &str) -> bool {
    let lines: Vec<Line<'_>> = lines(text).take(HEAD).collect();
    let Some(dialect) = Dialect::of(&lines, None) else { return false };
    let is_row = |line: &&Line<'_>| {
        let cells = dialect.cells_to_the_last(line.text);
        cells.len() >= 3 && cells.iter().all(|cell| !matches!(dialect.cell(cell), Cell::Text))
    };
    lines.iter().filter(is_row).take(4).count() == 4
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
    let start = start(&lines, dialect, options).map_err(|(line, trouble)| at(line, trouble))?;
    let mut facts = Facts::default();
    let before = lines[..start.first].iter().filter(|line| line.number != start.names_line || start.names.is_empty());
    before.for_each(|line| facts.add(dialect, line));
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
    if is_too_short
        || (has_same_width && names.len() != width)
        || (is_row(dialect, line) && !is_wide_head(dialect, &names))
    {
        return None;
    }
    let is_angle = |name: &String| {
        let meaning = super::names::meaning(name);
        matches!(meaning, Meaning::Angle(..) | Meaning::EitherTheta(_) | Meaning::EitherPhi(_) | Meaning::AnyAngle(_))
    };
    let width = names.len();
    names.iter().any(is_angle).then_some(Start { names, names_line: 0, first, width })
}

/// Whether a line of numbers is the head of a table with a column per angle: its first cell is the name of an angle.
fn is_wide_head(dialect: Dialect, names: &[String]) -> bool {
    let is_number =
        |name: &String| dialect.number(name).is_some() || matches!(super::names::meaning(name), Meaning::Number(..));
    names.len() >= 3 && !is_number(&names[0]) && names[1..].iter().all(is_number)
}

impl Raw {
    fn read_rows(
        &mut self,
        lines: &[Line<'_>],
        start: &Start,
        dialect: Dialect,
        file: &Path,
    ) -> Result<(), FormatError> {
        let error = |line: &Line<'_>, found: String, expected: String| {
            Err(FormatError::new(file, Place::Line(line.number), found, expected))
        };
        let names_text = lines.iter().find(|line| line.number == start.names_line).map(|line| line.text.trim());
        let used = self.layout.used();
        let last = used.iter().copied().max().unwrap_or(0);
        // A line that is no row, until it is known what follows.
        let mut pending: Option<&Line<'_>> = None;
        let mut after = 0;
        let mut seen: BTreeMap<([u64; 4], u64), (usize, Vec<String>)> = BTreeMap::new();
        for line in &lines[start.first..] {
            if line.comment().is_some() {
                self.facts.add(dialect, line);
                self.turn(dialect, line);
                continue;
            }
            if Some(line.text.trim()) == names_text {
                pending = None;
                continue;
            }
            if self.turn(dialect, line) {
                pending = None;
                continue;
            }
            let cells = dialect.cells(line.text);
            let is_row = cells.iter().any(|cell| matches!(dialect.cell(cell), Cell::Number(_)));
            if !is_row {
                pending = pending.or(Some(line));
                after += 1;
                continue;
            }
            if let Some(pending) = pending {
                return error(pending, shown(pending.text.trim()), format!("a row of {} cells", start.width));
            }
            after = 0;
            let filled = cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
            if cells.len() < start.width.min(last + 1)
                || filled > start.width
                || cells.len() < start.width && dialect.delimiter.is_some()
            {
                let found = format!("{} fields in {}", cells.len(), shown(line.text.trim()));
                return error(line, found, format!("{}, one for each name", start.width));
            }
            self.push(&cells, line, dialect, file)?;
            if !self.layout.watched.is_empty() {
                self.watch(&cells, line, &mut seen, &start.names, file)?;
            }
        }
        if after > 0 {
            self.notes.push(format!("{after} lines after the rows are not read"));
        }
        if self.rows.is_empty() {
            return Err(FormatError::new(file, Place::File, "no rows with values", "at least one"));
        }
        Ok(())
    }

    /// Takes an angle that holds from this line on, if it says one.
    fn turn(&mut self, dialect: Dialect, line: &Line<'_>) -> bool {
        let Some(fixed) = fixed(dialect, line) else { return false };
        let axes = if self.layout.is_specular { super::layout::SPECULAR } else { SPHERICAL };
        let Some(axis) = axes.iter().position(|angle| *angle == fixed.angle) else { return false };
        if self.layout.is_from_facts[axis] {
            self.layout.angles[axis] = Source::Fixed(fixed.value, fixed.unit);
        }
        self.layout.is_from_facts[axis]
    }

    fn push(
        &mut self,
        cells: &[Cow<'_, str>],
        line: &Line<'_>,
        dialect: Dialect,
        file: &Path,
    ) -> Result<(), FormatError> {
        let number = |column: usize, what: &str| {
            let cell = cells.get(column).map_or("", |cell| cell);
            let refused = |found: String| {
                FormatError::new(file, Place::Line(line.number), found, format!("{what}, a finite number"))
            };
            match dialect.cell(cell) {
                Cell::Number(number) => Ok(Some(number)),
                Cell::Missing => Ok(None),
                Cell::Text => Err(refused(format!("{} in column {}", shown(cell), column + 1))),
            }
        };
        let axes = if self.layout.is_specular { super::layout::SPECULAR } else { SPHERICAL };
        let mut angles = [0.0; 4];
        for (axis, angle) in angles.iter_mut().enumerate() {
            *angle = match self.layout.angles[axis] {
                Source::Fixed(value, _) => value,
                Source::Wide | Source::Missing => 0.0,
                Source::Column(column, _) => match number(column, &axes[axis].to_string())? {
                    Some(value) => value,
                    // An empty angle is no direction at all.
                    None => {
                        let found = format!("no {} in column {}", axes[axis], column + 1);
                        return Err(FormatError::new(file, Place::Line(line.number), found, "an angle in each row"));
                    }
                },
            };
        }
        let line_number = u32::try_from(line.number).unwrap_or(u32::MAX);
        match &self.layout.values {
            Values::Channels(columns, _) => {
                for &column in columns {
                    self.values.push(number(column, "a value")?.map_or(f32::NAN, |value| value as f32));
                }
                self.rows.push(angles);
                self.lines.push(line_number);
            }
            Values::Wide(columns, _) => {
                let axis = self.layout.angles.iter().position(|source| *source == Source::Wide).unwrap_or(0);
                for &(column, angle) in columns {
                    angles[axis] = angle;
                    self.values.push(number(column, "a value")?.map_or(f32::NAN, |value| value as f32));
                    self.rows.push(angles);
                    self.lines.push(line_number);
                }
            }
            Values::ByWavelength { values, wavelength, nm } => {
                let of_row = number(*wavelength, "a wavelength")?.map(|value| (value * nm * 1e6).round() / 1e6);
                let Some(of_row) = of_row.filter(|nm| nm.is_finite() && *nm > 0.0) else {
                    let found = format!("wavelength {}", shown(cells.get(*wavelength).map_or("", |cell| cell)));
                    return Err(FormatError::new(file, Place::Line(line.number), found, "a wavelength above 0"));
                };
                self.values.push(number(*values, "a value")?.map_or(f32::NAN, |value| value as f32));
                self.rows.push(angles);
                self.lines.push(line_number);
                self.wavelengths.push(of_row);
            }
        }
        Ok(())
    }

    /// Refuses rows of the same directions that differ in a column that is not read.
    fn watch(
        &self,
        cells: &[Cow<'_, str>],
        line: &Line<'_>,
        seen: &mut BTreeMap<([u64; 4], u64), (usize, Vec<String>)>,
        names: &[String],
        file: &Path,
    ) -> Result<(), FormatError> {
        let Some(angles) = self.rows.last() else { return Ok(()) };
        let of_row = |column: &usize| cells.get(*column).map_or("", |cell| cell).chars().take(24).collect::<String>();
        let words: Vec<String> = self.layout.watched.iter().take(4).map(of_row).collect();
        let key = (angles.map(|angle| (angle + 0.0).to_bits()), self.wavelengths.last().map_or(0, |nm| nm.to_bits()));
        let Some((first, others)) = seen.get(&key) else {
            seen.insert(key, (line.number, words));
            return Ok(());
        };
        match words.iter().zip(others).position(|(a, b)| a != b) {
            None => Ok(()),
            Some(which) => {
                let name = names.get(self.layout.watched[which]).map_or("", String::as_str);
                let found = format!(
                    "{} in column {}, and {} in line {first} for the same directions",
                    shown(&words[which]),
                    shown(name),
                    shown(&others[which])
                );
                let expected =
                    "one row for each pair of directions, or columns that name the values, so that rows are averaged";
                Err(FormatError::new(file, Place::Line(line.number), found, expected))
            }
        }
    }
}

/// What each column that is read was taken for.
fn describe(layout: &Layout, names: &[String]) -> Vec<String> {
    let axes = if layout.is_specular { super::layout::SPECULAR } else { SPHERICAL };
    let name = |column: usize| names.get(column).map_or_else(|| format!("column {}", column + 1), |name| shown(name));
    let unit = |unit: Option<Unit>| unit.map(|unit| format!(" in {unit}")).unwrap_or_default();
    let mut out = Vec::new();
    for (axis, source) in layout.angles.iter().enumerate() {
        let what: Angle = axes[axis];
        match source {
            Source::Column(column, of) => out.push(format!("{} is {what}{}", name(*column), unit(*of))),
            Source::Fixed(value, of) if layout.is_from_facts[axis] => {
                out.push(format!("{what} is {value}{} as stated outside the rows", unit(*of)));
            }
            Source::Fixed(value, of) => out.push(format!("{what} is {value}{}", unit(*of))),
            Source::Wide => out.push(format!("the numbers in the names are {what}")),
            Source::Missing => {}
        }
    }
    match &layout.values {
        Values::Channels(columns, channels) => {
            let of: Vec<String> = columns.iter().take(8).map(|column| name(*column)).collect();
            let more = if columns.len() > 8 { ", ..." } else { "" };
            let channels = channels.names();
            let shown = if channels.len() > 8 {
                format!("{} to {}", channels[0], channels[channels.len() - 1])
            } else {
                channels.join(" ")
            };
            out.push(format!("values in {}{more}: {shown}", of.join(", ")));
        }
        Values::Wide(columns, _) => out.push(format!("values in {} columns", columns.len())),
        Values::ByWavelength { values, wavelength, .. } => {
            out.push(format!("values in {} for the wavelengths in {}", name(*values), name(*wavelength)));
        }
    }
    out
}

/// Names with the numbers of their columns.
fn numbered(names: &[String]) -> String {
    let shown: Vec<String> =
        names.iter().take(12).enumerate().map(|(i, name)| format!("{}: {}", i + 1, shown(name))).collect();
    let more = if names.len() > 12 { format!(" and {} more", names.len() - 12) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}
