//! Complex refractive indices of metals.

use crate::metals::{ALUMINIUM, CHROMIUM, COPPER, GOLD, IRON, NICKEL, SILVER, TITANIUM};
use crate::{Spectrum, SpectrumError};

/// The complex refractive index `n + i k` of a metal by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Metal {
    /// The real part.
    pub n: Spectrum,
    /// The imaginary part.
    pub k: Spectrum,
}

const NAMED: [(&str, &[[f64; 3]]); 8] = [
    ("aluminium", &ALUMINIUM),
    ("chromium", &CHROMIUM),
    ("copper", &COPPER),
    ("gold", &GOLD),
    ("iron", &IRON),
    ("nickel", &NICKEL),
    ("silver", &SILVER),
    ("titanium", &TITANIUM),
];

impl Metal {
    /// The names of metals with known indices.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMED.iter().map(|(name, _)| *name)
    }

    /// The metal with this name.
    pub fn named(name: &str) -> Option<Self> {
        let (_, rows) = NAMED.iter().find(|(known, _)| *known == name)?;
        Metal::of_rows(rows).ok()
    }

    /// A metal from rows of wavelength in nm, `n` and `k`.
    ///
    /// # Errors
    /// The same as for [`Spectrum::new`].
    pub fn of_rows(rows: &[[f64; 3]]) -> Result<Self, SpectrumError> {
        let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
        Ok(Metal { n: Spectrum::new(column(0), column(1))?, k: Spectrum::new(column(0), column(2))? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metals_have_their_colours() {
        let reflectance = |metal: &Metal, nm: f64| {
            let (n, k) = (metal.n.at(nm), metal.k.at(nm));
            ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k)
        };
        for name in Metal::names() {
            assert!(Metal::named(name).is_some(), "{name}");
        }
        let [gold, silver, copper] = ["gold", "silver", "copper"].map(|name| Metal::named(name).expect("known"));
        assert!(reflectance(&gold, 650.0) > 0.94 && reflectance(&gold, 450.0) < 0.45);
        assert!(reflectance(&copper, 650.0) > 0.9 && reflectance(&copper, 500.0) < 0.65);
        assert!(reflectance(&silver, 450.0) > 0.95 && Metal::named("brass").is_none());
    }
}
