//! The angles of a row, and where each is found.

use crate::angle::{Angle, Unit};

pub(super) const SPHERICAL: [Angle; 4] = [Angle::ThetaI, Angle::PhiI, Angle::ThetaO, Angle::PhiO];
pub(super) const SPECULAR: [Angle; 4] = [Angle::Sigma, Angle::Psi, Angle::Theta, Angle::Phi];

/// Where an angle of a row is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Source {
    /// In a column, in the unit that its name states.
    Column(usize, Option<Unit>),
    /// In a line above the rows, or in what the user says.
    Fixed(f64, Option<Unit>),
    /// Each column of values has one of its own.
    Wide,
    Missing,
}
