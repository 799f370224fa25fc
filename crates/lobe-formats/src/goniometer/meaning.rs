//! The meaning of a column, and the words of its name.

use crate::angle::{Angle, Unit};
use crate::reading::Quantity;

/// The meaning of a column, from its name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Meaning {
    Angle(Angle, Option<Unit>),
    /// A polar angle of either direction: `theta_s` may belong to the sun or to the scattered light.
    EitherTheta(Option<Unit>),
    /// An azimuth of either direction.
    EitherPhi(Option<Unit>),
    /// An angle whose name says nothing else.
    AnyAngle(Option<Unit>),
    /// The wavelength of a row, with its factor to nm.
    Wavelength(f64),
    /// `f` or a similar quantity, for the channel with this name, which is empty for a single channel.
    Values {
        channel: String,
        quantity: Option<Quantity>,
        unit: String,
        is_transmission: bool,
    },
    /// A number, which may be a wavelength or an angle, and the angle if the name states it, as in `theta_i=30`.
    Number(f64, Option<Unit>, Option<Angle>),
    /// A measured quantity that is not `f`: intensities, currents, counts.
    Signal,
    /// A column that does not matter: uncertainties, comments, row numbers.
    NoValue,
    Unknown,
}

/// A name, split into words, and its unit.
pub(super) struct Name {
    pub words: Vec<String>,
    /// All letters, digits and points in one word.
    pub compact: String,
    /// The name in lower case without its unit.
    pub text: String,
    /// The text in brackets at the end, in lower case, if it is not part of the name.
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
