//! The sources of the angles of a row.

use crate::angle::{Angle, Unit};

pub(super) const SPHERICAL: [Angle; 4] = [Angle::ThetaI, Angle::PhiI, Angle::ThetaO, Angle::PhiO];
pub(super) const SPECULAR: [Angle; 4] = [Angle::Sigma, Angle::Psi, Angle::Theta, Angle::Phi];

/// The source of an angle of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Source {
    /// In a column, in the unit that its name states.
    Column(usize, Option<Unit>),
    /// In a line above the rows, or from the user.
    Fixed(f64, Option<Unit>),
    /// Each column of values has its own.
    Wide,
    Missing,
}
