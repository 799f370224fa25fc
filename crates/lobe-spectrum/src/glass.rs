//! Refractive indices of transparent media.

/// The refractive index of a transparent medium, as a formula of the wavelength.
#[derive(Clone, Debug, PartialEq)]
pub enum Glass {
    /// `n^2 = 1 + sum(b x / (x - c))`, with `x` the squared wavelength in micrometres.
    Sellmeier {
        /// The strength of each term.
        b: Vec<f64>,
        /// The squared resonance of each term, in square micrometres.
        c: Vec<f64>,
    },
    /// `n = a + b / x + c / x^2 + ...`, with `x` the squared wavelength in micrometres.
    Cauchy(Vec<f64>),
}

/// Names of media, and the constants of Sellmeier's formula.
type Named = (&'static str, [f64; 3], [f64; 3]);

/// The Schott catalogue; silica and sapphire (ordinary): I. H. Malitson 1965, 1962; diamond: F. Peter 1923; as
/// collected by refractiveindex.info (public domain).
const NAMED: [Named; 9] = [
    ("BK7", [1.039_612_12, 0.231_792_344, 1.010_469_45], [0.006_000_698_67, 0.020_017_914_4, 103.560_653]),
    ("F2", [1.345_333_59, 0.209_073_176, 0.937_357_162], [0.009_977_438_71, 0.047_045_076_7, 111.886_764]),
    ("SF11", [1.738_484_03, 0.311_168_974, 1.174_908_71], [0.013_606_860_4, 0.061_596_046_3, 121.922_711]),
    ("N-SF11", [1.737_596_95, 0.313_747_346, 1.898_781_01], [0.013_188_707, 0.062_306_814_2, 155.236_29]),
    ("N-SF66", [2.024_597_6, 0.470_187_196, 2.599_704_33], [0.014_705_322_5, 0.069_299_827_6, 161.817_601]),
    ("N-FK51A", [0.971_247_817, 0.216_901_417, 0.904_651_666], [0.004_723_019_95, 0.015_357_561_2, 168.681_33]),
    (
        "silica",
        [0.696_166_3, 0.407_942_6, 0.897_479_4],
        [0.068_404_3 * 0.068_404_3, 0.116_241_4 * 0.116_241_4, 9.896_161 * 9.896_161],
    ),
    (
        "sapphire",
        [1.431_349_3, 0.650_547_13, 5.341_402_1],
        [0.072_663_1 * 0.072_663_1, 0.119_324_2 * 0.119_324_2, 18.028_251 * 18.028_251],
    ),
    ("diamond", [0.3306, 4.3356, 0.0], [0.175 * 0.175, 0.106 * 0.106, 1.0]),
];

/// Water at 20 degrees Celsius: M. Daimon and A. Masumura 2007.
const WATER: [[f64; 4]; 2] = [
    [5.684_027_565e-1, 1.726_177_391e-1, 2.086_189_578e-2, 1.130_748_688e-1],
    [5.101_829_712e-3, 1.821_153_936e-2, 2.620_722_293e-2, 1.069_792_721e1],
];

impl Glass {
    /// The names of media with known constants.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMED.iter().map(|(name, ..)| *name).chain(["water"])
    }

    /// The medium with this name.
    pub fn named(name: &str) -> Option<Self> {
        if name == "water" {
            let [b, c] = WATER.map(Vec::from);
            return Some(Glass::Sellmeier { b, c });
        }
        let (_, b, c) = NAMED.iter().find(|(known, ..)| *known == name)?;
        Some(Glass::Sellmeier { b: b.to_vec(), c: c.to_vec() })
    }

    /// The index at a wavelength in nm. NaN if the formula has no value there.
    pub fn index(&self, nm: f64) -> f64 {
        let x = (nm / 1000.0).powi(2);
        match self {
            Glass::Sellmeier { b, c } => (1.0 + b.iter().zip(c).map(|(b, c)| b * x / (x - c)).sum::<f64>()).sqrt(),
            Glass::Cauchy(terms) => terms.iter().rev().fold(0.0, |sum, term| sum / x + term),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_agree_with_the_catalogues() {
        // The index at the helium d line, and Abbe's number.
        for (name, d, abbe) in [
            ("BK7", 1.5168, 64.17),
            ("F2", 1.62004, 36.37),
            ("SF11", 1.78472, 25.76),
            ("N-FK51A", 1.48656, 84.47),
            ("silica", 1.45846, 67.82),
            ("diamond", 2.4175, 55.3),
            ("water", 1.33335, 55.8),
        ] {
            let glass = Glass::named(name).unwrap_or_else(|| panic!("{name}"));
            let [f, found, c] = [486.1327, 587.5618, 656.2725].map(|nm| glass.index(nm));
            assert!((found - d).abs() < 2e-4, "{name}: {found}, not {d}");
            let number = (found - 1.0) / (f - c);
            assert!((number / abbe - 1.0).abs() < 0.01, "{name}: Abbe's number {number}, not {abbe}");
        }
        let cauchy = Glass::Cauchy(vec![1.5, 0.004]);
        assert!((cauchy.index(500.0) - 1.516).abs() < 1e-12);
        assert!(Glass::names().all(|name| Glass::named(name).is_some()) && Glass::named("amber").is_none());
    }
}
