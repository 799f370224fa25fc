//! Numbers by wavelength.

use thiserror::Error;

use crate::illuminants::{D50, D65, F2, F11, FIRST, STEP};

/// Numbers that cannot form a spectrum.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SpectrumError {
    /// The numbers of values and wavelengths differ.
    #[error("found {values} values at {wavelengths} wavelengths; expected one each")]
    Length {
        /// The number of wavelengths.
        wavelengths: usize,
        /// The number of values.
        values: usize,
    },
    /// No wavelengths, or too many.
    #[error("found {found} wavelengths; expected {expected}")]
    Count {
        /// The number found.
        found: usize,
        /// The allowed number.
        expected: &'static str,
    },
    /// A wavelength that is not a positive number, or not above the one before.
    #[error("wavelength {index} is {value} nm; expected ascending positive numbers")]
    Wavelength {
        /// Its position.
        index: usize,
        /// What was found.
        value: f64,
    },
    /// A value that is negative or not finite.
    #[error("value {index} is {value}; expected finite numbers, not negative")]
    Value {
        /// Its position.
        index: usize,
        /// What was found.
        value: f64,
    },
    /// A temperature at which nothing glows.
    #[error("found {0} K; expected a temperature from 500 to 100000 K")]
    Temperature(f64),
    /// No visible wavelength.
    #[error("found wavelengths from {first} to {last} nm; expected some from 380 to 780 nm")]
    Invisible {
        /// The first wavelength.
        first: f64,
        /// The last wavelength.
        last: f64,
    },
}

/// Numbers by wavelength: linear between the wavelengths, constant beyond the first and the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    wavelengths: Vec<f64>,
    values: Vec<f64>,
}

/// Checks that there are wavelengths, and that they are positive and ascend.
pub(crate) fn ascending(wavelengths: &[f64]) -> Result<(), SpectrumError> {
    let mut before = 0.0;
    for (index, &value) in wavelengths.iter().enumerate() {
        if !(value > before && value.is_finite()) {
            return Err(SpectrumError::Wavelength { index, value });
        }
        before = value;
    }
    if wavelengths.is_empty() {
        return Err(SpectrumError::Count { found: 0, expected: "at least one" });
    }
    Ok(())
}

impl Spectrum {
    /// A table.
    ///
    /// # Errors
    /// [`SpectrumError`] if wavelengths do not ascend, or a value is negative or not finite.
    pub fn new(wavelengths: Vec<f64>, values: Vec<f64>) -> Result<Self, SpectrumError> {
        if wavelengths.len() != values.len() {
            return Err(SpectrumError::Length { wavelengths: wavelengths.len(), values: values.len() });
        }
        ascending(&wavelengths)?;
        if let Some(index) = values.iter().position(|value| !(*value >= 0.0 && value.is_finite())) {
            return Err(SpectrumError::Value { index, value: values[index] });
        }
        Ok(Spectrum { wavelengths, values })
    }

    /// The same number at all wavelengths.
    ///
    /// # Errors
    /// If it is negative or not finite.
    pub fn constant(value: f64) -> Result<Self, SpectrumError> {
        Spectrum::new(vec![550.0], vec![value])
    }

    /// The radiation of a black body at a temperature in K, by Planck's law, relative to its largest visible value.
    ///
    /// # Errors
    /// If the temperature is out of range.
    pub fn black_body(kelvin: f64) -> Result<Self, SpectrumError> {
        if !(500.0..=100_000.0).contains(&kelvin) {
            return Err(SpectrumError::Temperature(kelvin));
        }
        Ok(Spectrum::planck(kelvin, 1.438_776_877e7))
    }

    /// Planck's law with the second radiation constant in nm K.
    fn planck(kelvin: f64, constant: f64) -> Self {
        let wavelengths: Vec<f64> = (0..=200).map(|k| 300.0 + 5.0 * f64::from(k)).collect();
        let radiance = |nm: &f64| 1.0 / (nm * nm * nm * nm * nm * libm::expm1(constant / (nm * kelvin)));
        let visible = wavelengths.iter().filter(|nm| (380.0..=780.0).contains(*nm));
        let most = visible.map(radiance).fold(f64::MIN_POSITIVE, f64::max);
        let values = wavelengths.iter().map(|nm| radiance(nm) / most).collect();
        Spectrum { wavelengths, values }
    }

    /// The wavelengths in nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// The numbers at the wavelengths.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The number at a wavelength.
    pub fn at(&self, nm: f64) -> f64 {
        let upper = self.wavelengths.partition_point(|x| *x <= nm);
        if upper == 0 || upper == self.wavelengths.len() {
            return self.values[upper.saturating_sub(usize::from(upper > 0))];
        }
        let ([a, b], [from, to]) =
            ([self.wavelengths[upper - 1], self.wavelengths[upper]], [self.values[upper - 1], self.values[upper]]);
        from + (nm - a) / (b - a) * (to - from)
    }
}

/// A standard illuminant of the CIE (CIE 15, Colorimetry).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Illuminant {
    /// Incandescent light: a black body at 2848 K on the temperature scale of its time.
    A,
    /// Daylight at 5003 K.
    D50,
    /// Daylight at 6504 K.
    D65,
    /// The same energy at every wavelength.
    E,
    /// A fluorescent lamp, cool white.
    F2,
    /// A fluorescent lamp with three narrow bands.
    F11,
}

impl Illuminant {
    /// All of them.
    pub const ALL: [Illuminant; 6] =
        [Illuminant::A, Illuminant::D50, Illuminant::D65, Illuminant::E, Illuminant::F2, Illuminant::F11];

    /// The name: `A`, `D50`, `D65`, `E`, `F2` or `F11`.
    pub fn name(self) -> &'static str {
        match self {
            Illuminant::A => "A",
            Illuminant::D50 => "D50",
            Illuminant::D65 => "D65",
            Illuminant::E => "E",
            Illuminant::F2 => "F2",
            Illuminant::F11 => "F11",
        }
    }

    /// The illuminant with this name.
    pub fn named(name: &str) -> Option<Self> {
        Illuminant::ALL.into_iter().find(|illuminant| illuminant.name() == name)
    }

    /// Its relative spectrum.
    pub fn spectrum(self) -> Spectrum {
        let table = |values: &[f64]| Spectrum {
            wavelengths: (0..values.len()).map(|k| FIRST + STEP * k as f64).collect(),
            values: values.to_vec(),
        };
        match self {
            // The definition: 100 (560 / nm)^5 (e^(c / (2848 560)) - 1) / (e^(c / (2848 nm)) - 1), with the c of 1931.
            Illuminant::A => Spectrum::planck(2848.0, 1.435e7),
            Illuminant::D50 => table(&D50),
            Illuminant::D65 => table(&D65),
            Illuminant::E => Spectrum { wavelengths: vec![550.0], values: vec![1.0] },
            Illuminant::F2 => table(&F2),
            Illuminant::F11 => table(&F11),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectra_are_linear_between_their_wavelengths_and_constant_beyond() {
        let spectrum = Spectrum::new(vec![400.0, 500.0, 700.0], vec![1.0, 3.0, 0.0]).unwrap();
        for (nm, expected) in [(300.0, 1.0), (400.0, 1.0), (450.0, 2.0), (500.0, 3.0), (600.0, 1.5), (900.0, 0.0)] {
            assert!((spectrum.at(nm) - expected).abs() < 1e-12, "{nm}");
        }
    }

    #[test]
    fn errors_name_the_invalid_number() {
        for (nm, values, expected) in [
            (vec![500.0, 400.0], vec![1.0, 1.0], "wavelength 1 is 400 nm"),
            (vec![500.0, 500.0], vec![1.0, 1.0], "wavelength 1 is 500 nm"),
            (vec![f64::NAN], vec![1.0], "wavelength 0 is NaN nm"),
            (vec![400.0, 500.0], vec![1.0], "1 values at 2 wavelengths"),
            (vec![400.0], vec![-0.5], "value 0 is -0.5"),
            (vec![400.0], vec![f64::INFINITY], "value 0 is inf"),
            (vec![], vec![], "0 wavelengths"),
        ] {
            let error = Spectrum::new(nm, values).expect_err(expected).to_string();
            assert!(error.contains(expected), "{error}");
        }
        assert!(Spectrum::black_body(100.0).is_err() && Spectrum::black_body(f64::NAN).is_err());
    }

    #[test]
    fn illuminant_a_agrees_with_the_standard() {
        let a = Illuminant::A.spectrum();
        // CIE 15, table T.1, relative to 560 nm.
        for (nm, expected) in [(400.0, 14.708), (450.0, 33.0859), (500.0, 59.8611), (600.0, 129.043), (700.0, 198.261)]
        {
            let found = 100.0 * a.at(nm) / a.at(560.0);
            assert!((found - expected).abs() < 2e-3, "{found} at {nm} nm, not {expected}");
        }
    }
}
