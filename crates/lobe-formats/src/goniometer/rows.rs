//! Reads the rows of a table.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use super::blocks::Blocks;
use super::facts::{fixed, says_nothing, wavelength};
use super::layout::{Layout, Values};
use super::raw::Raw;
use super::sheet::{Cell, Dialect, Line};
use super::source::{SPECULAR, SPHERICAL, Source};
use super::start::Start;
use crate::angle::{Angle, Unit};
use crate::lines::shown;
use crate::{FormatError, Place};

/// By the bits of angles and wavelength: the first line with them, and its words in the watched columns.
type Seen = BTreeMap<([u64; 4], u64), (usize, Vec<String>)>;

impl Raw {
    pub fn read_rows(
        &mut self,
        lines: &[Line<'_>],
        start: &Start,
        dialect: Dialect,
        file: &Path,
    ) -> Result<Blocks, FormatError> {
        let error = |line: &Line<'_>, found: String, expected: String| {
            Err(FormatError::new(file, Place::Line(line.number), found, expected))
        };
        let names_text = lines.iter().find(|line| line.number == start.names_line).map(|line| line.text.trim());
        let used = self.layout.used();
        let last = used.iter().copied().max().unwrap_or(0);
        // Lines that are not rows, until it is known what follows.
        let mut pending: Vec<&Line<'_>> = Vec::new();
        let mut blocks = Blocks::new(self.facts.wavelength);
        let mut before = lines[start.first].number;
        let mut seen = Seen::new();
        for line in &lines[start.first..] {
            if line.number > before + 1 {
                blocks.begin(self.rows.len(), line.number - 1, self.facts.wavelength);
            }
            before = line.number;
            let is_comment = line.comment().is_some();
            if is_comment || wavelength(dialect, line).is_some() {
                self.facts.add(dialect, line);
                if !(self.turn(dialect, line) || (is_comment && says_nothing(line))) {
                    blocks.begin(self.rows.len(), line.number, self.facts.wavelength);
                }
                continue;
            }
            if Some(line.text.trim()) == names_text {
                blocks.begin(self.rows.len(), line.number, self.facts.wavelength);
                pending.drain(..).for_each(|line| self.facts.add(dialect, line));
                continue;
            }
            if self.turn(dialect, line) {
                pending.clear();
                continue;
            }
            let cells = dialect.cells(line.text);
            let is_row = cells.iter().any(|cell| matches!(dialect.cell(cell), Cell::Number(_)));
            if !is_row {
                pending.push(line);
                continue;
            }
            if let Some(pending) = pending.first() {
                return error(pending, shown(pending.text.trim()), format!("a row of {} cells", start.width));
            }
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
        if !pending.is_empty() {
            self.notes.push(format!("{} lines after the rows are not read", pending.len()));
            // But they may say what the values are.
            pending.iter().for_each(|line| self.facts.claim(dialect, line));
        }
        if self.rows.is_empty() {
            return Err(FormatError::new(file, Place::File, "no rows with values", "at least one"));
        }
        Ok(blocks)
    }

    /// Takes an angle that applies from this line on, if the line states one.
    fn turn(&mut self, dialect: Dialect, line: &Line<'_>) -> bool {
        if !self.layout.is_from_facts.contains(&true) {
            return false;
        }
        let Some(fixed) = fixed(dialect, line) else { return false };
        let axes = if self.layout.is_specular { SPECULAR } else { SPHERICAL };
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
        let axes = if self.layout.is_specular { SPECULAR } else { SPHERICAL };
        let mut angles = [0.0; 4];
        for (axis, angle) in angles.iter_mut().enumerate() {
            *angle = match self.layout.angles[axis] {
                Source::Fixed(value, _) => value,
                Source::Wide | Source::Missing => 0.0,
                Source::Column(column, _) => match number(column, &axes[axis].to_string())? {
                    Some(value) => value,
                    // Without an angle there is no direction.
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

    /// Refuses rows with the same directions that differ in a column that is not read.
    fn watch(
        &self,
        cells: &[Cow<'_, str>],
        line: &Line<'_>,
        seen: &mut Seen,
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

/// How each column was understood.
pub(super) fn describe(layout: &Layout, names: &[String]) -> Vec<String> {
    let axes = if layout.is_specular { SPECULAR } else { SPHERICAL };
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
