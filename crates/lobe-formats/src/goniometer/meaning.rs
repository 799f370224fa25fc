//! What a column holds, and the words of its name.

use crate::angle::{Angle, Unit};
use crate::reading::Quantity;

/// What a column holds, as far as its name says.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Meaning {
    Angle(Angle, Option<Unit>),
    /// A polar angle of either direction: `theta_s` is the sun's or the scattered light's.
    EitherTheta(Option<Unit>),
    /// An azimuth of either direction.
    EitherPhi(Option<Unit>),
    /// An angle of which the name says no more.
    AnyAngle(Option<Unit>),
    /// The wavelength of a row: what makes nm of it.
    Wavelength(f64),
    /// `f` or something like it, for the channel of this name, which is empty for the only one.
    Values {
        channel: String,
        quantity: Option<Quantity>,
        unit: String,
        is_transmission: bool,
    },
    /// A number, which may be a wavelength or an angle; of which angle, if the name says so, as in `theta_i=30`.
    Number(f64, Option<Unit>, Option<Angle>),
    /// What may be measured but is not `f`: intensities, currents, counts.
    Signal,
    /// Nothing that counts: uncertainties, comments, numbers of rows.
    NoValue,
    Unknown,
}

/// A name in its words, with its unit.
pub(super) struct Name {
    pub words: Vec<String>,
    /// All letters, digits and points in one word.
    pub compact: String,
    /// The name in lower case without its unit.
    pub text: String,
    /// What stands in brackets at the end, in lower case, if it is no word of a name.
    pub unit: String,
    pub angle_unit: Option<Unit>,
}

impl Meaning {
    /// The unit that the name of an angle states.
    pub fn unit(&self) -> Option<Unit> {
        match self {
            Meaning::Angle(_, unit)
            | Meaning::EitherTheta(unit)
            | Meaning::EitherPhi(unit)
            | Meaning::AnyAngle(unit)
            | Meaning::Number(_, unit, _) => *unit,
            _ => None,
        }
    }
}
