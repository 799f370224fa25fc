//! What the names of columns say: which angle, in which unit, or which values.

use std::f64::consts::PI;

use super::angles::side;
use super::quantities::{COLOURS, SIGNALS, is_signal_unit, nanometres};
use super::words::{FILLERS, OF_NO_VALUE, WHOLE};
use crate::reading::{Quantity, words};

words! {
    /// An angle of a table.
    Angle:
    /// The polar angle of the light.
    ThetaI = "theta_i",
    /// Its azimuth.
    PhiI = "phi_i",
    /// The polar angle of the viewer.
    ThetaO = "theta_o",
    /// Its azimuth.
    PhiO = "phi_o",
    /// The polar angle of the light, in specular coordinates.
    Sigma = "sigma",
    /// Its azimuth.
    Psi = "psi",
    /// The angle between the viewer and the mirror direction.
    Theta = "theta",
    /// The azimuth about the mirror direction.
    Phi = "phi",
}

words! {
    /// A unit of angles.
    Unit:
    /// Degrees.
    Deg = "deg" or "degree" or "degrees" or "°" or "grad",
    /// Radians.
    Rad = "rad" or "radian" or "radians",
    /// Thousandths of a radian.
    Mrad = "mrad",
}

impl Unit {
    /// What makes radians of it.
    pub fn radians(self) -> f64 {
        match self {
            Unit::Deg => PI / 180.0,
            Unit::Rad => 1.0,
            Unit::Mrad => 1e-3,
        }
    }
}

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

/// What the name of a column says.
pub(crate) fn meaning(name: &str) -> Meaning {
    let name = Name::new(name);
    if let Some((_, meaning)) = WHOLE.iter().find(|(word, _)| *word == name.compact) {
        return Meaning::Angle(*meaning, name.angle_unit);
    }
    name.angle().or_else(|| name.wavelength()).or_else(|| name.number()).or_else(|| name.values()).unwrap_or_else(
        || {
            let is = |list: &[&str]| name.words.iter().any(|word| list.contains(&word.as_str()));
            match () {
                () if is(OF_NO_VALUE) => Meaning::NoValue,
                () if is(SIGNALS) || is_signal_unit(&name.unit) => Meaning::Signal,
                () => Meaning::Unknown,
            }
        },
    )
}

impl Name {
    fn new(text: &str) -> Self {
        let text = text.trim().trim_matches('"');
        let mut spelled = String::new();
        let mut before = ' ';
        for c in text.chars() {
            // `thetaIn` is two words; `BRDF` is one, and so is `nm`.
            if c.is_uppercase() && before.is_lowercase() {
                spelled.push(' ');
            }
            match c {
                'θ' | 'ϑ' | 'Θ' => spelled.push_str(" theta "),
                'φ' | 'ϕ' | 'Φ' => spelled.push_str(" phi "),
                'λ' => spelled.push_str(" lambda "),
                'Δ' => spelled.push_str(" delta "),
                'ᵢ' => spelled.push_str(" i"),
                'ₒ' => spelled.push_str(" o"),
                'ᵣ' => spelled.push_str(" r"),
                'ₛ' => spelled.push_str(" s"),
                _ => spelled.extend(c.to_lowercase()),
            }
            before = c;
        }
        let mut spelled = spelled.trim().to_string();
        let (mut unit, mut angle_unit) = (String::new(), None);
        if let Some((open, close)) = [('[', ']'), ('(', ')')].into_iter().find(|(_, close)| spelled.ends_with(*close))
            && let Some((head, inner)) = spelled.trim_end_matches(close).rsplit_once(open)
        {
            let inner = inner.trim().trim_start_matches("in ");
            angle_unit = inner.parse().ok();
            if angle_unit.is_some() || !is_part_of_a_name(inner) {
                unit = inner.to_string();
                spelled = head.trim().to_string();
            }
        }
        let is_apart = |c: char| !(c.is_alphanumeric() || c == '.' || c == '°' || c == '%');
        let mut words: Vec<String> = spelled.split(is_apart).filter(|w| !w.is_empty()).map(String::from).collect();
        if angle_unit.is_none() && words.len() > 1 {
            angle_unit = words.last().and_then(|word| word.parse().ok());
            if angle_unit.is_some()
                && let Some(unit) = words.pop()
            {
                spelled.truncate(spelled.trim_end().len() - unit.len());
                spelled.truncate(spelled.trim_end_matches(is_apart).len());
            }
        }
        if let Some(last) = words.last_mut()
            && let Some(short) = last.strip_suffix('°')
        {
            angle_unit = Some(Unit::Deg);
            *last = short.into();
        }
        words.retain(|word| !FILLERS.contains(&word.as_str()) && !word.is_empty());
        let compact = words.concat();
        Name { words, compact, text: spelled, unit, angle_unit }
    }
}

/// Whether what stands in brackets belongs to the name: `theta (in)`, `f(450 nm)`, `BRDF (R)`.
fn is_part_of_a_name(inner: &str) -> bool {
    let word = inner.trim();
    side(word).is_some()
        || COLOURS.iter().any(|names| names.contains(&word))
        || nanometres(&word.replace(' ', ""), "").is_some()
        || ["incident", "scattered", "reflected"].contains(&word)
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
