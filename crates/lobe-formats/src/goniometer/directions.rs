//! The assignment of angle names to the two directions.

use super::facts::Facts;
use super::meaning::Meaning;
use super::source::{SPHERICAL, Source};
use crate::angle::{Angle, Unit};

/// `true` if columns with these meanings determine the directions of light and viewer.
pub(super) fn has_directions(mut meanings: Vec<Meaning>, facts: &Facts) -> bool {
    let is_fixed = |angle: Angle| facts.angles.iter().any(|fixed| fixed.angle == angle);
    settle(&mut meanings, is_fixed);
    let is_column = |angle: Angle| meanings.iter().any(|m| matches!(m, Meaning::Angle(other, _) if *other == angle));
    let has = |angle: Angle| is_fixed(angle) || is_column(angle);
    let numbers = meanings.iter().filter(|meaning| matches!(meaning, Meaning::Number(..))).count();
    let is_wide = numbers >= 2 && (is_column(Angle::ThetaI) || is_column(Angle::ThetaO));
    let has_viewer = is_column(Angle::ThetaO) || is_column(Angle::ThetaI) || is_column(Angle::Theta);
    let is_known =
        (has(Angle::ThetaI) && has(Angle::ThetaO)) || [Angle::Sigma, Angle::Theta, Angle::Phi].into_iter().all(has);
    is_wide || (has_viewer && is_known)
}

/// Assigns names that may mean either direction to the one that the other names leave.
pub(super) fn settle(meanings: &mut [Meaning], is_fixed: impl Fn(Angle) -> bool) {
    let has = |meanings: &[Meaning], angle: Angle| {
        is_fixed(angle) || meanings.iter().any(|m| matches!(m, Meaning::Angle(other, _) if *other == angle))
    };
    let light_is_known = has(meanings, Angle::ThetaI);
    let viewer_is_known = has(meanings, Angle::ThetaO);
    let [theta, phi] = match (light_is_known, viewer_is_known) {
        (true, false) => [Angle::ThetaO, Angle::PhiO],
        (false, true) => [Angle::ThetaI, Angle::PhiI],
        _ => return,
    };
    // `theta` and `phi` next to `theta_i`.
    let is_specular = has(meanings, Angle::Sigma);
    for meaning in meanings.iter_mut() {
        *meaning = match meaning {
            Meaning::EitherTheta(unit) => Meaning::Angle(theta, *unit),
            Meaning::EitherPhi(unit) => Meaning::Angle(phi, *unit),
            Meaning::AnyAngle(unit) if light_is_known => Meaning::Angle(theta, *unit),
            Meaning::Angle(Angle::Theta, unit) if light_is_known && !is_specular => Meaning::Angle(theta, *unit),
            Meaning::Angle(Angle::Phi, unit) if light_is_known && !is_specular => Meaning::Angle(phi, *unit),
            _ => continue,
        };
    }
}

/// Whether a number is there twice. Files may have hundreds of thousands of columns.
pub(super) fn has_twice(mut numbers: Vec<f64>) -> bool {
    numbers.sort_by(f64::total_cmp);
    numbers.windows(2).any(|pair| pair[0] == pair[1])
}

/// The columns of a table with one column per incident or outgoing polar angle, if it is such a table: all whose names
/// are numbers.
pub(super) type Wide = (Vec<(usize, f64)>, Option<Unit>);

pub(super) fn wide(meanings: &[Meaning], angles: &mut [Source; 4]) -> Option<Wide> {
    let numbers = meanings.iter().enumerate().filter_map(|(column, meaning)| match meaning {
        Meaning::Number(number, unit, angle) => Some((column, *number, *unit, *angle)),
        _ => None,
    });
    let numbers: Vec<_> = numbers.collect();
    let &(_, _, unit, angle) = numbers.first()?;
    let missing = match (angles[0] == Source::Missing, angles[2] == Source::Missing) {
        (true, false) => 0,
        (false, true) => 2,
        _ => return None,
    };
    let fits = |&(_, number, of, which): &(usize, f64, Option<Unit>, Option<Angle>)| {
        of == unit && which == angle && which.is_none_or(|angle| angle == SPHERICAL[missing]) && number.abs() <= 90.0
    };
    let has_values = meanings.iter().any(|meaning| matches!(meaning, Meaning::Values { .. }));
    if has_values || !numbers.iter().all(fits) || has_twice(numbers.iter().map(|(_, number, ..)| *number).collect()) {
        return None;
    }
    angles[missing] = Source::Wide;
    Some((numbers.into_iter().map(|(column, number, ..)| (column, number)).collect(), unit))
}
