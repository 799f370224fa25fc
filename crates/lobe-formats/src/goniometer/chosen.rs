//! The contents of columns, from their names and from the user.

use super::meaning::Meaning;
use super::names::meaning;
use super::stated::unit_of_angle;
use super::trouble::Trouble;
use crate::angle::Angle;
use crate::lines::shown;
use crate::reading::{Content, Position, ReadOptions};

/// The meaning of the names of columns, overridden by the user.
pub(super) fn meanings(names: &[String], width: usize, options: &ReadOptions) -> Result<Vec<Meaning>, Trouble> {
    let mut meanings: Vec<Meaning> = names.iter().map(|name| of_name(name)).collect();
    meanings.resize(width.max(names.len()), Meaning::Unknown);
    let mut chosen = vec![None; meanings.len()];
    for column in &options.columns {
        let index = match &column.at {
            Position::Fixed(..) => continue,
            Position::Number(number) if *number <= meanings.len() => number - 1,
            Position::Named(name) => names
                .iter()
                .position(|other| other.trim().eq_ignore_ascii_case(name))
                .ok_or_else(|| Trouble::new(format!("no column {name:?} as in {column}"), named(names)))?,
            Position::Number(_) => {
                return Err(Trouble::new(
                    format!("{column} in rows of {} columns", meanings.len()),
                    "a column that exists",
                ));
            }
        };
        let stated = meanings[index].clone();
        let meaning = match &column.content {
            Content::Angle(angle) => Meaning::Angle(*angle, stated.unit()),
            Content::Wavelength => match stated {
                Meaning::Wavelength(nm) => Meaning::Wavelength(nm),
                _ => Meaning::Wavelength(1.0),
            },
            Content::Values(name) => match (meaning(name), stated) {
                (Meaning::Values { channel, quantity, is_transmission, .. }, Meaning::Values { unit, .. }) => {
                    Meaning::Values { channel, quantity, is_transmission, unit }
                }
                (Meaning::Values { channel, quantity, is_transmission, unit }, _) => {
                    Meaning::Values { channel, quantity, is_transmission, unit }
                }
                _ => Meaning::Values {
                    channel: name.clone(),
                    quantity: None,
                    unit: String::new(),
                    is_transmission: false,
                },
            },
        };
        if chosen[index].replace(meaning).is_some() {
            return Err(Trouble::new(format!("column {} twice, again as {column}", index + 1), "each column once"));
        }
    }
    let has_values = options.columns.iter().any(|column| matches!(column.content, Content::Values(_)));
    let is_chosen = |angle: Angle| options.columns.iter().any(|column| column.content == Content::Angle(angle));
    for (meaning, chosen) in meanings.iter_mut().zip(chosen) {
        match (chosen, &*meaning) {
            (Some(chosen), _) => *meaning = chosen,
            (None, Meaning::Angle(angle, _)) if !is_chosen(*angle) => {}
            (None, Meaning::EitherTheta(_) | Meaning::EitherPhi(_) | Meaning::AnyAngle(_)) => {}
            // A column that the user leaves out while naming others.
            (None, Meaning::Angle(..)) => *meaning = Meaning::NoValue,
            (None, Meaning::Wavelength(_)) => {}
            (None, _) if has_values => *meaning = Meaning::NoValue,
            (None, _) => {}
        }
    }
    Ok(meanings)
}

/// The meaning of the name of a column.
pub(super) fn of_name(name: &str) -> Meaning {
    meaning(corner(name))
}

/// The corner of a table with a column per angle names both: `theta_o \\ theta_i`. Its own column holds the first.
fn corner(name: &str) -> &str {
    match name.split_once(['\\', '/']) {
        Some((rows, columns)) => match (meaning(rows), meaning(columns)) {
            // The names of the columns are numbers in the same unit.
            (Meaning::Angle(_, unit), Meaning::Angle(_, other))
                if (other.is_none() || unit == other) && unit_of_angle(columns).is_none() =>
            {
                rows
            }
            _ => name,
        },
        None => name,
    }
}

/// The names of a table for an error.
fn named(names: &[String]) -> String {
    let shown: Vec<String> =
        names.iter().take(12).enumerate().map(|(i, name)| format!("{}: {}", i + 1, shown(name))).collect();
    let more = if names.len() > 12 { format!(" and {} more", names.len() - 12) } else { String::new() };
    format!("one of the columns {}{more}", shown.join(", "))
}

/// Names for an error.
pub(super) fn list(names: &[String], width: usize) -> String {
    match names.is_empty() {
        true => format!("{width} columns without names"),
        false => list_of(names, &(0..names.len()).collect::<Vec<_>>()),
    }
}

pub(super) fn list_of(names: &[String], columns: &[usize]) -> String {
    let name = |column: &usize| names.get(*column).map_or_else(|| format!("column {}", column + 1), |name| shown(name));
    let shown: Vec<String> = columns.iter().take(12).map(name).collect();
    let more = if columns.len() > 12 { format!(" and {} more", columns.len() - 12) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}
