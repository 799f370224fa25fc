//! What the names of columns say: which angle, in which unit, or which values.

use std::f64::consts::PI;
use std::fmt;

use super::words::{AZIMUTHS, FILLERS, INCOMING, OF_NO_VALUE, OUTGOING, POLARS, RELATIVE, WHOLE};
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
struct Name {
    words: Vec<String>,
    /// All letters, digits and points in one word.
    compact: String,
    /// The name in lower case without its unit.
    text: String,
    /// What stands in brackets at the end, in lower case, if it is no word of a name.
    unit: String,
    angle_unit: Option<Unit>,
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

/// Names of what is measured on the way to `f`.
const SIGNALS: &[&str] = &[
    "intensity",
    "radiance",
    "luminance",
    "irradiance",
    "illuminance",
    "signal",
    "counts",
    "power",
    "current",
    "voltage",
    "flux",
    "adc",
    "adu",
    "reflectance",
    "reflectivity",
    "transmittance",
    "reflexionsgrad",
    "leuchtdichte",
    "intensität",
    "signal",
    "spannung",
    "strom",
];

/// Units that values of `f` cannot have.
pub(super) fn is_signal_unit(unit: &str) -> bool {
    let unit = unit.replace(['µ', 'μ'], "u");
    [
        "ua", "na", "ma", "a", "v", "mv", "uv", "w", "mw", "uw", "cd", "cd/m2", "cd/m^2", "lx", "lm", "counts", "cts",
        "w/sr", "w/m2/sr", "db",
    ]
    .contains(&unit.as_str())
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

    /// An angle, if each word has to do with one.
    fn angle(&self) -> Option<Meaning> {
        let (mut is_polar, mut is_azimuth, mut is_angle, mut is_relative) = (false, false, false, false);
        let mut sides: Vec<Side> = Vec::new();
        for word in &self.words {
            let word = word.as_str();
            match () {
                () if POLARS.contains(&word) => is_polar = true,
                () if AZIMUTHS.contains(&word) => is_azimuth = true,
                () if ["angle", "angles", "ang", "winkel"].contains(&word) => is_angle = true,
                () if RELATIVE.contains(&word) => is_relative = true,
                () => match side(word) {
                    Some(side) => sides.push(side),
                    None => {
                        // One word of both, as in `thetai` and `Einfallswinkel`.
                        let (part, kind) = parted(word)?;
                        match kind {
                            Kind::Polar => is_polar = true,
                            Kind::Azimuth => is_azimuth = true,
                            Kind::Angle => is_angle = true,
                        }
                        match side(part) {
                            Some(side) => sides.push(side),
                            None if RELATIVE.contains(&part) => is_relative = true,
                            None => return None,
                        }
                    }
                },
            }
        }
        let unit = self.angle_unit;
        let side = match sides[..] {
            [] => None,
            [first, ref others @ ..] if others.iter().all(|other| *other == first) => Some(first),
            _ => return None,
        };
        match (is_polar, is_azimuth, side) {
            (true, true, _) => None,
            (_, true, None) if is_relative => Some(Meaning::Angle(Angle::PhiO, unit)),
            _ if is_relative => None,
            (_, true, Some(Side::Light)) => Some(Meaning::Angle(Angle::PhiI, unit)),
            (_, true, Some(Side::Viewer)) => Some(Meaning::Angle(Angle::PhiO, unit)),
            (_, true, Some(Side::Either)) => Some(Meaning::EitherPhi(unit)),
            (true, _, Some(Side::Light)) => Some(Meaning::Angle(Angle::ThetaI, unit)),
            (true, _, Some(Side::Viewer)) => Some(Meaning::Angle(Angle::ThetaO, unit)),
            (true, _, Some(Side::Either)) => Some(Meaning::EitherTheta(unit)),
            // A letter next to `angle` says too little.
            (_, _, Some(Side::Light)) if is_angle && self.is_spelled() => Some(Meaning::Angle(Angle::ThetaI, unit)),
            (_, _, Some(Side::Viewer)) if is_angle && self.is_spelled() => Some(Meaning::Angle(Angle::ThetaO, unit)),
            (true, _, None) if self.compact == "theta" => Some(Meaning::Angle(Angle::Theta, unit)),
            (_, true, None) if self.compact == "phi" => Some(Meaning::Angle(Angle::Phi, unit)),
            (_, true, None) => Some(Meaning::Angle(Angle::PhiO, unit)),
            (true, _, None) => Some(Meaning::AnyAngle(unit)),
            (_, _, None) if is_angle => Some(Meaning::AnyAngle(unit)),
            _ => None,
        }
    }

    fn is_spelled(&self) -> bool {
        self.words.iter().all(|word| word.len() > 1)
    }

    /// The wavelength of rows.
    fn wavelength(&self) -> Option<Meaning> {
        let is = ["lambda", "wavelength", "wl", "wellenlänge", "wellenlaenge"].contains(&self.words.first()?.as_str());
        let last = self.words.get(1).map_or(self.unit.as_str(), String::as_str);
        let nm = match last {
            "" | "nm" => 1.0,
            "um" | "µm" | "μm" | "micron" | "microns" | "micrometer" | "micrometre" => 1e3,
            "m" => 1e9,
            _ => return None,
        };
        (is && self.words.len() <= 2).then_some(Meaning::Wavelength(nm))
    }

    /// A name that is a number, perhaps after the name of an angle: `30`, `-30°`, `theta_i=30`, `AOI 10`.
    fn number(&self) -> Option<Meaning> {
        let number = |word: &str| {
            let word = word.trim().trim_end_matches('°').replace(',', ".");
            word.parse().ok().filter(|number: &f64| number.is_finite())
        };
        if let Some(found) = number(&self.text) {
            return Some(Meaning::Number(found, self.angle_unit, None));
        }
        let (head, tail) = self.text.rsplit_once(['=', ':', ' ', '_'])?;
        match meaning(head) {
            Meaning::Angle(angle, unit) => Some(Meaning::Number(number(tail)?, self.angle_unit.or(unit), Some(angle))),
            _ => None,
        }
    }

    /// Values: `BRDF`, `R`, `550nm`, `BRDF_550nm`, `f(450 nm)`.
    fn values(&self) -> Option<Meaning> {
        let mut quantity = None;
        let mut is_transmission = false;
        let mut rest = Vec::new();
        let mut is_named = false;
        for word in &self.words {
            match word.as_str() {
                "brdf" | "bsdf" | "f" | "fr" | "fs" => (is_named, quantity) = (true, quantity.or(Some(Quantity::F))),
                "btdf" | "ft" => {
                    (is_named, is_transmission, quantity) = (true, true, quantity.or(Some(Quantity::F)));
                }
                "ccbrdf" | "ccbtdf" | "ccbsdf" | "brdfcos" | "fcos" | "arb" => {
                    (is_named, quantity) = (true, Some(Quantity::FCos));
                    is_transmission |= word == "ccbtdf";
                }
                "cos" | "cosine" if is_named => quantity = Some(Quantity::FCos),
                "corrected" if quantity == Some(Quantity::FCos) => {}
                "brf" | "leuchtdichtefaktor" | "leuchtdichtekoeffizient" => {
                    (is_named, quantity) = (true, Some(Quantity::LuminanceFactor));
                }
                "value" | "values" | "channel" | "mean" | "avg" | "average" => is_named = true,
                word => rest.push(word),
            }
        }
        if let ["luminance" | "radiance" | "reflectance" | "brightness", "factor"] = rest[..] {
            (is_named, quantity) = (true, Some(Quantity::LuminanceFactor));
            rest.clear();
        }
        let channel = match rest[..] {
            [] => String::new(),
            [colour] if COLOURS.iter().any(|names| names.contains(&colour)) => {
                let names = COLOURS.iter().find(|names| names.contains(&colour))?;
                names[0].to_uppercase()
            }
            _ => format!("{}nm", nanometres(&rest.concat(), &self.unit)?),
        };
        let is_values = is_named || !channel.is_empty();
        // A wavelength in brackets is a unit that was used up.
        let unit = if channel.ends_with("nm") && LENGTHS.contains(&self.unit.as_str()) { "" } else { &self.unit };
        let unit = unit.to_string();
        is_values.then_some(Meaning::Values { channel, quantity, unit, is_transmission })
    }
}

const COLOURS: [&[&str]; 6] =
    [&["r", "red", "rot"], &["g", "green", "grün"], &["b", "blue", "blau"], &["x"], &["y"], &["z"]];
const LENGTHS: [&str; 4] = ["nm", "um", "µm", "μm"];

/// A wavelength in nm: `550nm`, `0.55um`, `wl550nm`, or 550 with its unit in brackets.
fn nanometres(word: &str, unit: &str) -> Option<f64> {
    let word = ["lambda", "wavelength", "wl"].iter().find_map(|prefix| word.strip_prefix(prefix)).unwrap_or(word);
    let digits = word.trim_end_matches(|c: char| c.is_alphabetic());
    let suffix = if digits.len() < word.len() { &word[digits.len()..] } else { unit };
    let scale = match suffix {
        "nm" => 1.0,
        "um" | "µm" | "μm" => 1e3,
        _ => return None,
    };
    let nm = digits.parse().ok().map(|number: f64| (number * scale * 1e6).round() / 1e6)?;
    (nm.is_finite() && nm > 0.0).then_some(nm)
}

#[derive(Clone, Copy, PartialEq)]
enum Side {
    Light,
    Viewer,
    Either,
}

enum Kind {
    Polar,
    Azimuth,
    Angle,
}

fn side(word: &str) -> Option<Side> {
    match word {
        "s" => Some(Side::Either),
        _ if INCOMING.contains(&word) => Some(Side::Light),
        _ if OUTGOING.contains(&word) => Some(Side::Viewer),
        _ => None,
    }
}

/// The part of a compound word that says which direction, and the kind of angle that the rest says.
fn parted(word: &str) -> Option<(&str, Kind)> {
    for (prefix, kind) in [
        ("theta", Kind::Polar),
        ("phi", Kind::Azimuth),
        ("azimuth", Kind::Azimuth),
        ("zenith", Kind::Polar),
        ("th", Kind::Polar),
    ] {
        if let Some(rest) = word.strip_prefix(prefix)
            && (side(rest).is_some() || RELATIVE.contains(&rest))
        {
            return Some((rest, kind));
        }
    }
    for (suffix, kind) in [
        ("swinkel", Kind::Angle),
        ("winkel", Kind::Angle),
        ("angle", Kind::Angle),
        ("theta", Kind::Polar),
        ("phi", Kind::Azimuth),
    ] {
        if let Some(rest) = word.strip_suffix(suffix)
            && (side(rest).is_some() || RELATIVE.contains(&rest))
        {
            return Some((rest, kind));
        }
    }
    None
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

/// What a name of values that are not `f` is called in errors.
impl fmt::Display for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Meaning::Angle(angle, _) => write!(f, "{angle}"),
            Meaning::EitherTheta(_) | Meaning::EitherPhi(_) | Meaning::AnyAngle(_) => f.write_str("an angle"),
            Meaning::Wavelength(_) => f.write_str("wavelength"),
            Meaning::Values { channel, .. } if channel.is_empty() => f.write_str("values"),
            Meaning::Values { channel, .. } => f.write_str(channel),
            Meaning::Number(number, ..) => write!(f, "{number}"),
            Meaning::Signal => f.write_str("a signal"),
            Meaning::NoValue | Meaning::Unknown => f.write_str("not read"),
        }
    }
}
