//! Degrees or radians.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

use super::layout::Values;
use super::raw::Raw;
use super::source::{SPECULAR, SPHERICAL, Source};
use crate::angle::Unit;
use crate::reading::ReadOptions;
use crate::{FormatError, Place};

/// Rounded angles may be this much above a right angle or a full turn, in radians.
const ROUNDING: f64 = 2e-3;

/// The unit of each angle: what its name states, or the user, or a line above the rows, or the numbers themselves.
pub(super) fn of(
    raw: &Raw,
    file: &Path,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Result<[Unit; 4], FormatError> {
    let axes = if raw.layout.is_specular { SPECULAR } else { SPHERICAL };
    let stated = raw.layout.angles.map(|source| match source {
        Source::Column(_, unit) | Source::Fixed(_, unit) => unit,
        Source::Wide => match &raw.layout.values {
            Values::Wide(_, unit) => *unit,
            _ => None,
        },
        Source::Missing => None,
    });
    let is_column = |axis: usize| matches!(raw.layout.angles[axis], Source::Column(..));
    if let Some(given) = options.unit
        && let Some(axis) = (0..4).find(|&axis| is_column(axis) && stated[axis].is_some_and(|unit| unit != given))
    {
        let found = format!("{} whose name says {}", axes[axis], stated[axis].unwrap_or(given));
        return Err(FormatError::new(
            file,
            Place::Line(raw.names_line.max(1)),
            found,
            format!("{given}, as the options say"),
        ));
    }
    let is_there = |axis: usize| raw.layout.angles[axis] != Source::Missing;
    let open: Vec<usize> = (0..4).filter(|&axis| is_there(axis) && stated[axis].is_none()).collect();
    if open.is_empty() {
        return Ok(stated.map(|unit| unit.unwrap_or(Unit::Deg)));
    }
    // If only some names state a unit, it applies to all. An angle that is the same in all rows has its own unit.
    let is_fixed = |axis: &usize| matches!(raw.layout.angles[*axis], Source::Fixed(..));
    let some = (0..4).filter(|axis| !is_fixed(axis)).find_map(|axis| stated[axis]);
    let unit = match options.unit.or(raw.facts.unit).or(some) {
        Some(unit) => unit,
        None => {
            let (unit, why) = guess(raw, &open).ok_or_else(|| {
                let found = "angles that may be degrees or radians";
                FormatError::new(
                    file,
                    Place::Line(raw.names_line.max(1)),
                    found,
                    "a unit in the names, as theta_i_deg, or --unit deg or --unit rad",
                )
            })?;
            notes.push(format!("angles in {unit}: {why}"));
            unit
        }
    };
    Ok(stated.map(|stated| stated.unwrap_or(unit)))
}

/// The only possible unit of the numbers, and the reason.
fn guess(raw: &Raw, open: &[usize]) -> Option<(Unit, String)> {
    let largest = |axis: usize| raw.rows.iter().map(|angles| angles[axis].abs()).fold(0.0, f64::max);
    for &axis in open {
        let limit = if axis % 2 == 1 {
            TAU
        } else if axis == 2 {
            2.0 * FRAC_PI_2
        } else {
            FRAC_PI_2
        };
        let found = largest(axis);
        if found > limit + ROUNDING {
            return Some((Unit::Deg, format!("up to {found}")));
        }
    }
    if open.iter().all(|&axis| largest(axis) == 0.0) {
        return Some((Unit::Deg, "all are 0".into()));
    }
    for &axis in open {
        let is_whole = |angle: f64| (angle.to_degrees() - angle.to_degrees().round()).abs() < 0.01;
        let is_long = |angle: f64| (angle * 100.0 - (angle * 100.0).round()).abs() > 1e-6;
        let mut angles = raw.rows.iter().map(|angles| angles[axis]).filter(|angle| *angle != 0.0);
        let is_radians = largest(axis) > 0.0 && angles.clone().all(is_whole) && angles.any(is_long);
        if is_radians {
            return Some((Unit::Rad, format!("up to {}, in steps that are whole degrees", largest(axis))));
        }
    }
    None
}
