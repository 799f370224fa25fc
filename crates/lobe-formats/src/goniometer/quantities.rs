//! Names of values and of wavelengths.

use super::angles::{Side, side};
use super::meaning::{Meaning, Name};
use super::words::POLARS;
use crate::reading::Quantity;

/// Names of quantities that are measured on the way to `f`.
pub(super) const SIGNALS: &[&str] = &[
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
    "spannung",
    "strom",
    // Reflectance factors and other quantities of remote sensing that are not pi f.
    "hdrf",
    "hcrf",
    "bcrf",
    "ccrf",
    "radf",
    "bhr",
    "dhr",
    "dn",
    "albedo",
    "tis",
];

/// Units that values of `f` cannot have.
pub(super) fn is_signal_unit(unit: &str) -> bool {
    // Names are already split into words, including `uA`.
    let unit = unit.replace(['µ', 'μ'], "u").replace(' ', "");
    [
        "ua", "na", "ma", "a", "v", "mv", "uv", "w", "mw", "uw", "cd", "cd/m2", "cd/m^2", "lx", "lm", "counts", "cts",
        "w/sr", "w/m2/sr", "db",
    ]
    .contains(&unit.as_str())
}

impl Name {
    /// The wavelength of rows.
    pub fn wavelength(&self) -> Option<Meaning> {
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

    /// Values: `BRDF`, `R`, `550nm`, `BRDF_550nm`, `f(450 nm)`.
    pub fn values(&self) -> Option<Meaning> {
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
                "ccbrdf" | "ccbtdf" | "ccbsdf" | "brdfcos" | "btdfcos" | "bsdfcos" | "fcos" | "arb" | "ars" | "dsf" => {
                    (is_named, quantity) = (true, Some(Quantity::FCos));
                    is_transmission |= ["ccbtdf", "btdfcos"].contains(&word.as_str());
                }
                // `ccBRDF` is two words.
                "cc" => quantity = Some(Quantity::FCos),
                "cos" | "cosine" | "costheta" | "costhetao" | "costhetas" | "costhetar" if is_named => {
                    quantity = Some(Quantity::FCos);
                }
                // The angle of the cosine.
                word if quantity == Some(Quantity::FCos) && is_polar_angle(word) => {}
                "corrected" if quantity == Some(Quantity::FCos) => {}
                "brf" | "reff" | "leuchtdichtefaktor" | "leuchtdichtekoeffizient" => {
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
        // A wavelength in brackets was parsed as a unit.
        let unit = if channel.ends_with("nm") && LENGTHS.contains(&self.unit.as_str()) { "" } else { &self.unit };
        let unit = unit.to_string();
        is_values.then_some(Meaning::Values { channel, quantity, unit, is_transmission })
    }
}

/// `true` for words of the viewer's polar angle after a cosine: `theta`, `thetas`, and the letter after `theta`.
fn is_polar_angle(word: &str) -> bool {
    let is_viewer = matches!(side(word.strip_prefix("theta").unwrap_or(word)), Some(Side::Viewer | Side::Either));
    POLARS.contains(&word) || (is_viewer && !COLOURS.iter().any(|names| names.contains(&word)))
}

pub(super) const COLOURS: [&[&str]; 6] =
    [&["r", "red", "rot"], &["g", "green", "grün"], &["b", "blue", "blau"], &["x"], &["y"], &["z"]];
pub(super) const LENGTHS: [&str; 4] = ["nm", "um", "µm", "μm"];

/// A wavelength in nm: `550nm`, `0.55um`, `wl550nm`, or 550 with its unit in brackets.
pub(super) fn nanometres(word: &str, unit: &str) -> Option<f64> {
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
