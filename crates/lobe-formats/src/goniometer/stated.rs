//! What names state of angles and values that is neither a unit of angles that is read, nor `f` in 1/sr.

use super::angles::{Side, side};
use super::meaning::Name;
use super::quantities::is_signal_unit;
use crate::reading::ReadOptions;

/// Units of angles, and of other things, in which instruments state a direction.
const OTHER_ANGLES: &[&str] = &[
    "gon",
    "gons",
    "gradian",
    "gradians",
    "arcmin",
    "arcmins",
    "arcsec",
    "arcsecs",
    "min",
    "sec",
    "'",
    "''",
    "\"",
    "′",
    "″",
    "turn",
    "turns",
    "rev",
    "revs",
    "revolutions",
    "cycles",
    "urad",
    "µrad",
    "μrad",
    "hours",
    "mm",
    "cm",
    "m",
    "px",
    "pixel",
    "pixels",
    "step",
    "steps",
    "counts",
    "cos",
    "sin",
    "tan",
    "%",
];

/// Forms of 1/sr, without blanks, brackets and carets.
const PER_STERADIAN: &[&str] = &[
    "sr",
    "1/sr",
    "/sr",
    "sr-1",
    "sr⁻¹",
    "sr**-1",
    "persr",
    "1/steradian",
    "1/sterad",
    "1/steradians",
    "steradian-1",
    "persteradian",
];

/// Parts of units that are powers of ten or other factors.
const FACTORS: &[&str] = &["10-", "10⁻", "10**", "10e", "1e", "x10", "×", "*10", "·10", "e-", "pi", "π"];

/// Words of units, and of names, for numbers without a known scale.
pub(super) const RELATIVE: &[&str] = &[
    "a.u.",
    "a.u",
    "au",
    "arb",
    "arb.",
    "arb.units",
    "arb.unit",
    "arbitrary",
    "arbitraryunits",
    "rel",
    "rel.",
    "relative",
    "rel.units",
    "relativ",
    "norm",
    "norm.",
    "normed",
    "normalised",
    "normalized",
    "normiert",
    "peak",
    "scaled",
    "skaliert",
];

pub(super) const LOGARITHMS: &[&str] = &["log", "log10", "logarithm", "lg", "ln", "db", "decibel", "loge"];

/// Words in brackets after an angle that is not from the normal.
const OTHER_ORIGINS: &[&str] = &["specular", "mirror", "glanz", "spiegel", "surface", "horizon", "grazing", "relative"];

pub(super) const FACTOR: &str = "f in 1/sr, or the factor that converts to it: scale";
pub(super) const QUANTITY: &str = "f in 1/sr, or their quantity: values = f, luminance-factor or f-cos, and scale";

/// What a name says of its values that is not `f` in 1/sr.
#[derive(Clone, Debug)]
pub(super) struct Stated {
    pub found: String,
    pub expected: &'static str,
    pub remedy: Remedy,
}

/// The options with which such values are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Remedy {
    Scale,
    /// Their quantity or their scale.
    Either,
    /// The unit of angles.
    Unit,
    None,
}

impl Remedy {
    /// `true` if the options say what is left open.
    pub fn is_said(self, options: &ReadOptions) -> bool {
        match self {
            Remedy::Scale => options.scale.is_some(),
            Remedy::Either => options.values.is_some() || options.scale.is_some(),
            Remedy::Unit => options.unit.is_some(),
            Remedy::None => false,
        }
    }
}

/// `true` for a unit in hundredths.
pub(super) fn is_percent(unit: &str) -> bool {
    ["%", "percent", "pct", "prozent"].contains(&unit.trim().to_lowercase().replace(' ', "").as_str())
}

/// `true` for a unit, or a factor, of values that are not `f` in 1/sr. Units of angles may be lists of several.
pub(super) fn is_not_f(unit: &str) -> bool {
    let plain = plain(&unit.to_lowercase());
    let plain = plain.as_str();
    is_signal_unit(plain) || LOGARITHMS.contains(&plain) || RELATIVE.contains(&plain) || is_other_scale(plain)
}

/// `true` for a unit with another scale than 1/sr, without blanks, brackets and carets.
fn is_other_scale(unit: &str) -> bool {
    const PARTS: &[&str] = &["‰", "permil", "promille", "ppm", "ppb"];
    !PER_STERADIAN.contains(&unit)
        && (unit.contains("sr") || unit.contains("sterad") || has_factor(unit) || PARTS.contains(&unit))
}

/// A unit or an origin of an angle that is not read.
pub(super) fn unit_of_angle(name: &str) -> Option<String> {
    let Name { unit, angle_unit, .. } = Name::new(name);
    let is_other = OTHER_ANGLES.contains(&unit.as_str()) || OTHER_ORIGINS.iter().any(|word| unit.contains(word));
    (angle_unit.is_none() && is_other).then_some(unit)
}

/// `true` for a unit without brackets, in a line of units.
pub(super) fn is_unit(word: &str) -> bool {
    let unit = plain(&word.to_lowercase());
    let is_angle = OTHER_ANGLES.contains(&unit.as_str()) && unit != "m";
    let is_per = unit.len() <= 16 && unit.contains("sr") && unit.contains(['/', '-', '⁻']);
    is_angle || is_per || PER_STERADIAN.contains(&unit.as_str())
}

/// A unit without blanks, brackets and carets.
fn plain(unit: &str) -> String {
    unit.chars().filter(|c| !" ^{}()[]$\\".contains(*c)).collect()
}

/// What a name states of values, if they are not numbers of `f` in 1/sr, `f cos` or luminance factors as they are.
pub(super) fn other_values(name: &str) -> Option<Stated> {
    let name = Name::new(name);
    let unit = plain(&name.unit);
    let is =
        |list: &[&str]| list.contains(&unit.as_str()) || name.words.iter().any(|word| list.contains(&word.as_str()));
    let stated = |found: String, expected, remedy| Some(Stated { found, expected, remedy });
    if is(LOGARITHMS) || name.compact.ends_with("db") {
        return stated("a logarithm".into(), "f in 1/sr itself", Remedy::None);
    }
    if is(RELATIVE) {
        return stated("relative values".into(), QUANTITY, Remedy::Either);
    }
    if is(&["pi", "π"]) || name.text.contains('π') {
        return stated("a factor of pi".into(), QUANTITY, Remedy::Either);
    }
    let unit = unit.as_str();
    if is_other_scale(unit) {
        return stated(format!("the unit {}", name.unit), FACTOR, Remedy::Scale);
    }
    if name.is_of_incident_cosine() {
        return stated("a cosine of the incident light".into(), QUANTITY, Remedy::Either);
    }
    None
}

/// `true` if a text in brackets is a factor.
fn has_factor(unit: &str) -> bool {
    let has_digit = unit.contains(|c: char| c.is_ascii_digit());
    // Other numbers may be wavelengths.
    let is_power = ["10", "100", "1000", "10000", "100000", "1000000"].contains(&unit.trim_start_matches(['x', '*']));
    is_power || (has_digit && FACTORS.iter().any(|factor| unit.contains(factor)))
}

impl Name {
    /// `true` for `f cos(theta_i)`.
    fn is_of_incident_cosine(&self) -> bool {
        let Some(at) = self.words.iter().position(|word| word.contains("cos")) else { return false };
        let in_brackets = self.unit.split(|c: char| !c.is_alphanumeric());
        let after = self.words[at..].iter().map(String::as_str).chain(in_brackets);
        after
            .map(|word| word.trim_start_matches("cos").trim_start_matches("theta"))
            .any(|word| matches!(side(word), Some(Side::Light)))
    }
}
