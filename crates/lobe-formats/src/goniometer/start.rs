//! Finds the beginning of a table: the line of names, and the first row.

use super::chosen::of_name;
use super::directions::has_directions;
use super::facts::{Facts, fixed};
use super::meaning::Meaning;
use super::sheet::{Cell, Dialect, Line, names};
use super::trouble::Trouble;
use crate::lines::shown;
use crate::reading::{Position, ReadOptions};

/// The number of lines that are examined to find the names.
pub(super) const HEAD: usize = 2000;
/// The most lines between the names and the first row: units, rulers, comments.
const GAP: usize = 4;

/// A line of names with the first row after it.
pub(super) struct Start {
    pub names: Vec<String>,
    pub names_line: usize,
    /// Position of the first row in the list of lines.
    pub first: usize,
    pub width: usize,
}

/// `true` if a line has more numbers than words, and two or more.
fn is_row(dialect: Dialect, line: &Line<'_>) -> bool {
    let cells: Vec<Cell> = dialect.cells_to_the_last(line.text).iter().map(|cell| dialect.cell(cell)).collect();
    let numbers = cells.iter().filter(|cell| matches!(cell, Cell::Number(_))).count();
    let texts = cells.iter().filter(|cell| matches!(cell, Cell::Text)).count();
    line.comment().is_none() && numbers >= 2 && texts < numbers
}

/// The line of names, and the first row.
pub(super) fn start(lines: &[Line<'_>], dialect: Dialect, options: &ReadOptions) -> Result<Start, (usize, Trouble)> {
    let head = &lines[..lines.len().min(HEAD)];
    // Prefers as many names as cells, and names that are not in a comment.
    for (has_same_width, is_comment) in [(true, false), (true, true), (false, false), (false, true)] {
        for (index, line) in head.iter().enumerate().filter(|(_, line)| line.comment().is_some() == is_comment) {
            if let Some(start) = named_start(&head[index..], dialect, has_same_width) {
                return Ok(Start { first: index + start.first, names_line: line.number, ..start });
            }
        }
    }
    // Names of angles without rows of numbers.
    let named = head.windows(2).find(|pair| names_directions(dialect, &pair[0]));
    if let Some([_, row]) = named
        && options.columns.is_empty()
        && let Some((at, cell)) =
            dialect.cells(row.text).iter().enumerate().find(|(_, cell)| dialect.cell(cell) == Cell::Text)
    {
        let found = format!("{} in column {}", shown(cell), at + 1);
        return Err((row.number, Trouble::new(found, "rows of numbers below the names")));
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
            Some((number, names)) => (*number, format!("names that are not angles, {}", numbered(names))),
            None => (lines[first].number, format!("a row without names above it, {}", shown(lines[first].text.trim()))),
        };
        return Err((number, Trouble::new(found, "names such as theta_i, theta_o, phi_o and f")));
    }
    let (names_line, names) = above.unwrap_or_default();
    Ok(Start { names, names_line, first, width })
}

/// `true` if a line names the directions of light and viewer.
fn names_directions(dialect: Dialect, line: &Line<'_>) -> bool {
    let cells = dialect.cells_to_the_last(line.comment().unwrap_or(line.text));
    let meanings: Vec<Meaning> = cells.iter().map(|name| of_name(name)).collect();
    // Prose names directions as well.
    let unknown = meanings.iter().filter(|meaning| **meaning == Meaning::Unknown).count();
    let is_named = 4 * unknown <= meanings.len() || (dialect.delimiter.is_some() && 2 * unknown <= meanings.len());
    meanings.len() > 2 && is_named && has_directions(meanings, &Facts::default())
}

/// `true` if one of the first lines names directions, whatever separates the names.
pub(super) fn has_names(lines: &[Line<'_>]) -> bool {
    const FEW: usize = 50;
    let delimiters = [Some('\t'), Some(';'), Some('|'), Some(','), None];
    let mut dialects = delimiters.map(|delimiter| Dialect { delimiter, has_decimal_comma: false }).into_iter();
    dialects.any(|dialect| lines.iter().take(FEW).any(|line| names_directions(dialect, line)))
}

/// The table that starts with the first of these lines, if its names include angles and rows follow.
fn named_start(lines: &[Line<'_>], dialect: Dialect, has_same_width: bool) -> Option<Start> {
    let line = lines.first()?;
    if fixed(dialect, line).is_some() {
        return None;
    }
    // Units, rulers and comments may be in between.
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

/// Names with the numbers of their columns.
fn numbered(names: &[String]) -> String {
    let shown: Vec<String> =
        names.iter().take(12).enumerate().map(|(i, name)| format!("{}: {}", i + 1, shown(name))).collect();
    let more = if names.len() > 12 { format!(" and {} more", names.len() - 12) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}
