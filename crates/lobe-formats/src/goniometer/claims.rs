//! What lines outside the rows say of all values or all angles, if it is not what is read: a factor, another unit,
//! another quantity, relative values. They are too free in form to be applied, so the options have to settle them.

use super::meaning::{Meaning, Name};
use super::names::meaning;
use super::stated::{FACTOR, LOGARITHMS, QUANTITY, RELATIVE, Remedy, Stated, is_not_f, is_percent, other_values};
use super::words::{AZIMUTHS, POLARS};
use crate::RESAMPLED;
use crate::reading::{Quantity, ReadOptions};

/// A statement of a line that options have to settle.
#[derive(Clone, Debug)]
pub(super) struct Claim {
    /// The line.
    pub line: usize,
    pub text: String,
    pub stated: Stated,
    /// The quantity that it states, which the names of columns may state as well.
    quantity: Option<Quantity>,
}

impl Claim {
    /// What a line says; `parts` are its name and its value, if it has them.
    pub fn of(line: usize, text: &str, parts: Option<(&str, &str)>) -> Option<Self> {
        if text.starts_with(RESAMPLED) || parts.is_some_and(|(_, value)| is_no(value)) {
            return None;
        }
        let said = parts.and_then(|(name, value)| named(name, value)).or_else(|| prose(text));
        said.map(|Said { stated, quantity }| Claim { line, text: text.into(), stated, quantity })
    }

    /// `true` if the options, or the names of the values, say the same or how it is meant.
    pub fn is_settled(&self, quantity: Option<Quantity>, options: &ReadOptions) -> bool {
        self.stated.remedy.is_said(options) || (self.quantity.is_some() && self.quantity == quantity)
    }
}

struct Said {
    stated: Stated,
    quantity: Option<Quantity>,
}

fn said(found: impl Into<String>, expected: &'static str, remedy: Remedy) -> Option<Said> {
    Some(Said { stated: Stated { found: found.into(), expected, remedy }, quantity: None })
}

/// A quantity other than `f`.
fn quantity(quantity: Quantity) -> Option<Said> {
    let stated = Stated { found: format!("values as {quantity}"), expected: QUANTITY, remedy: Remedy::Either };
    Some(Said { stated, quantity: Some(quantity) })
}

/// Names of factors.
const SCALES: &[&str] = &[
    "scale",
    "scaling",
    "scalefactor",
    "scalingfactor",
    "multiplier",
    "multiplicator",
    "multiplikator",
    "multiply",
    "multiplied",
    "divisor",
    "divide",
    "divided",
    "skalierung",
    "skalierungsfaktor",
    "skalenfaktor",
    "umrechnungsfaktor",
    "kalibrierfaktor",
    "korrekturfaktor",
    "normierungsfaktor",
];

/// Scales of other things.
const OTHER_SCALES: &[&str] = &[
    "bar",
    "colour",
    "color",
    "grey",
    "gray",
    "temperature",
    "time",
    "image",
    "spatial",
    "length",
    "zoom",
    "map",
    "wavelength",
    "lambda",
    "energy",
    "motor",
    "stage",
    "encoder",
    "full",
    "range",
    "date",
];

/// Names of factors if the other words are about values.
const FACTORS: &[&str] = &["factor", "faktor", "gain", "verstärkung"];

/// Words about values.
const VALUES: &[&str] = &[
    "value",
    "values",
    "data",
    "brdf",
    "btdf",
    "bsdf",
    "f",
    "fr",
    "fs",
    "y",
    "z",
    "ordinate",
    "wert",
    "werte",
    "daten",
    "messwerte",
    "signal",
    "amplitude",
    "intensity",
    "reading",
    "readings",
    "numbers",
    "entries",
];

/// Words that may stand next to those.
const COMMON: &[&str] = &[
    "column",
    "table",
    "all",
    "total",
    "overall",
    "global",
    "common",
    "conversion",
    "calibration",
    "correction",
    "normalization",
    "normalisation",
];

/// Names of a power of ten.
const EXPONENTS: &[&str] = &["exponent", "powerten", "poweroften", "zehnerpotenz"];

/// Names of lines that state a quantity.
const QUANTITIES: &[&str] = &[
    "quantity",
    "measuredquantity",
    "physicalquantity",
    "measurand",
    "value",
    "values",
    "valuetype",
    "ordinate",
    "yaxis",
    "zaxis",
    "ylabel",
    "zlabel",
    "messgröße",
    "messgroesse",
];

/// Units after a number that make it something else than a factor.
const OTHER_UNITS: &[&str] = &[
    "mm", "cm", "m", "um", "µm", "μm", "nm", "px", "pixel", "pixels", "bit", "bits", "s", "ms", "min", "h", "k", "c",
    "°c", "v", "mv", "hz", "khz", "db",
];

/// Angle units that are not read; others, such as lengths, may belong to something else.
const OTHER_ANGLES: &[&str] = &["gon", "gons", "gradian", "gradians", "arcmin", "arcmins", "arcsec", "arcsecs", "urad"];

fn is_any(words: &[String], list: &[&str]) -> bool {
    words.iter().any(|word| list.contains(&word.as_str()))
}

fn is_no(value: &str) -> bool {
    let first = value.split_whitespace().next().unwrap_or_default().trim_matches(['"', ',', ';', '.']);
    ["no", "none", "false", "off", "0", "-", "not", "nein", "keine", "absolute", "unknown", "n/a"]
        .contains(&first.to_lowercase().as_str())
}

/// `Scale: 1000`, `Units: a.u.`, `Quantity: luminance factor`.
fn named(name: &str, value: &str) -> Option<Said> {
    let Name { words, compact, .. } = Name::new(name);
    let is_angle = is_any(&words, POLARS)
        || is_any(&words, AZIMUTHS)
        || words.iter().any(|word| word.starts_with("angle") || word.starts_with("angular") || word.contains("winkel"));
    let is_unit = words.iter().any(|word| word.starts_with("unit") || word.contains("einheit"));
    let is_scale = is_any(&words, SCALES);
    if (is_unit || words.iter().all(|word| word.starts_with("angle") || word == "winkel"))
        && let Some(unit) = value.to_lowercase().split_whitespace().find(|word| OTHER_ANGLES.contains(word))
    {
        return said(
            format!("angles in {unit}"),
            "degrees, radians or mrad, or --unit if the line is wrong",
            Remedy::Unit,
        );
    }
    if is_unit && !is_angle {
        return unit(value);
    }
    if is_angle {
        let is_factor = is_scale && factor(value);
        return if is_factor { said("a factor of angles", "angles without a factor", Remedy::None) } else { None };
    }
    let is_value = |word: &String| [VALUES, COMMON].iter().any(|list| list.contains(&word.as_str()));
    let is_about_values = words.iter().all(|word| is_value(word) || FACTORS.contains(&word.as_str()));
    if is_scale && !is_any(&words, OTHER_SCALES) || is_about_values && is_any(&words, FACTORS) {
        return match (factor(value), is_logarithm(value)) {
            (true, _) => said(format!("a factor of {}", lobe_files::excerpt(value, 40)), FACTOR, Remedy::Scale),
            (_, true) if is_scale => said("a logarithm", QUANTITY, Remedy::Either),
            _ => None,
        };
    }
    if EXPONENTS.contains(&compact.as_str()) && value.trim().parse().is_ok_and(|power: f64| power != 0.0) {
        return said(format!("a power of ten, {}", value.trim()), FACTOR, Remedy::Scale);
    }
    let is_relative = |word: &String| {
        RELATIVE.contains(&word.as_str())
            || LOGARITHMS.contains(&word.as_str())
            || ["to", "by", "peak", "maximum"].contains(&word.as_str())
            || is_value(word)
    };
    if (is_any(&words, RELATIVE) || is_any(&words, LOGARITHMS) || is_any(&words, &["normalization", "normalisation"]))
        && words.iter().all(is_relative)
    {
        return said("relative values", QUANTITY, Remedy::Either);
    }
    if !QUANTITIES.contains(&compact.as_str()) {
        return None;
    }
    if let Some(stated) = other_values(value) {
        return Some(Said { stated: Stated { remedy: Remedy::Either, ..stated }, quantity: None });
    }
    match meaning(value) {
        Meaning::Values { quantity: Some(other), .. } if other != Quantity::F => quantity(other),
        Meaning::Signal => said("another quantity", QUANTITY, Remedy::Either),
        _ => None,
    }
}

/// A unit of values, or a list of the units of all columns.
fn unit(value: &str) -> Option<Said> {
    let pieces = value.split([',', ';']).map(str::trim).filter(|piece| !piece.is_empty());
    for piece in pieces.flat_map(|piece| [piece].into_iter().chain(piece.split_whitespace())) {
        if is_percent(piece) {
            return said("values in %", QUANTITY, Remedy::Either);
        }
        // As a whole, a piece may be a list.
        if is_not_f(piece) && (!piece.contains(' ') || is_relative_unit(piece)) {
            return said(format!("the unit {}", lobe_files::excerpt(piece, 40)), FACTOR, Remedy::Either);
        }
    }
    None
}

fn is_relative_unit(piece: &str) -> bool {
    RELATIVE.contains(&piece.to_lowercase().replace(' ', "").as_str())
}

fn is_logarithm(value: &str) -> bool {
    let first = value.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default().to_lowercase();
    LOGARITHMS.contains(&first.as_str()) || first.starts_with("logarithm")
}

/// `true` if a text begins with a number other than 1, with a power, a fraction or a percentage.
fn factor(text: &str) -> bool {
    let mut words = text.split_whitespace().map(|word| word.trim_matches(['(', ')', '[', ']', '"', ';']));
    let is_sign = |c: char| ['x', 'X', '×', '*', '·'].contains(&c);
    let Some(first) = words.by_ref().map(|word| word.trim_matches(is_sign)).find(|word| !word.is_empty()) else {
        return false;
    };
    let first = first.trim_end_matches([',', '.']).replace('−', "-");
    if !first.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
        return false;
    }
    let number = |text: &str| text.trim().replace(',', ".").parse::<f64>().ok();
    match number(&first) {
        // A comma may separate thousands.
        Some(1.0) => first.ends_with(",000"),
        Some(_) => !words.next().is_some_and(|unit| OTHER_UNITS.contains(&unit.to_lowercase().as_str())),
        None => {
            let is_power = first.contains(['^', '⁻', '⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹', '%'])
                || first.contains("**");
            let ratio = first.split_once(['/', ':']).and_then(|(a, b)| Some((number(a)?, number(b)?)));
            is_power || ratio.is_some_and(|(a, b)| a != b)
        }
    }
}

/// `BRDF values multiplied by 1000`, `values in %`, `normalised to the peak`.
fn prose(text: &str) -> Option<Said> {
    let lower = text.to_lowercase();
    let words: Vec<&str> = lower
        .split_whitespace()
        .map(|word| word.trim_matches([',', ';', ':', '(', ')', '[', ']', '"', '\'']).trim_end_matches('.'))
        .filter(|word| !word.is_empty())
        .collect();
    let is_value =
        |word: &&str| VALUES.contains(word) || ["brdf", "btdf", "bsdf"].iter().any(|name| word.contains(name));
    let has_values = words.iter().any(is_value);
    let is_denied = |at: usize| at > 0 && ["not", "no", "without", "nicht", "ohne", "non"].contains(&words[at - 1]);
    for (at, word) in words.iter().enumerate() {
        let after = &words[at + 1..];
        let is_product = word.starts_with("multipl")
            || ["scaled", "skaliert", "divided", "divide", "dividiert"].contains(word)
            || (has_values && ["times", "x", "×", "*"].contains(word) && at > 0 && !words[at - 1].ends_with(digit));
        if is_product && !is_denied(at) {
            const SKIPPED: [&str; 12] =
                ["by", "with", "mit", "um", "durch", "a", "the", "all", "values", "data", "factor", "of"];
            let mut rest = after.iter().skip_while(|word| SKIPPED.contains(word) || is_value(word));
            match rest.next() {
                Some(next) if next.starts_with("cos") => return quantity(Quantity::FCos),
                Some(next) if factor(next) || *next == "pi" || *next == "π" => {
                    return said(format!("a factor of {}", lobe_files::excerpt(next, 40)), FACTOR, Remedy::Scale);
                }
                _ => {}
            }
        }
        let signed = word.strip_prefix(['x', '×', '*']).filter(|rest| rest.starts_with(digit));
        if has_values && signed.is_some_and(factor) {
            return said(format!("a factor of {word}"), FACTOR, Remedy::Scale);
        }
        let is_of_units = *word == "of" && at > 0 && words[at - 1].starts_with("unit");
        // A single letter may be a word, and a number a count.
        let is_unit = |unit: &&&str| unit.len() > 1 && unit.parse::<f64>().is_err() && is_not_f(unit);
        if (has_values && *word == "in" || is_of_units)
            && let Some(unit) = after.first().filter(|unit| is_percent(unit) || is_unit(unit))
        {
            return said(format!("the unit {}", lobe_files::excerpt(unit, 40)), FACTOR, Remedy::Either);
        }
        let is_normalised = ["normaliz", "normalis", "normiert"].iter().any(|start| word.starts_with(start));
        if is_normalised && !is_denied(at) && (has_values || words.len() <= 4) && !word.ends_with("ation") {
            return said("relative values", QUANTITY, Remedy::Either);
        }
        if has_values && (LOGARITHMS.contains(word) || word.starts_with("log10") || word.starts_with("logarithm")) {
            return said("a logarithm", QUANTITY, Remedy::Either);
        }
        let is_corrected = after.first().is_some_and(|next| next.starts_with("correct") || next.starts_with("weight"));
        let is_cosine =
            word.starts_with("cos") && (word.contains("correct") || word.contains("weight") || is_corrected);
        if is_cosine && !is_denied(at) {
            return quantity(Quantity::FCos);
        }
    }
    None
}

fn digit(c: char) -> bool {
    c.is_ascii_digit()
}
