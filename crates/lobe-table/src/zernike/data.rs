//! The terms of an expansion.

use std::f64::consts::PI;

use crate::Channels;
use crate::invalid::Invalid;

/// The highest radial order.
pub const MAX_ORDER: u8 = 15;
/// The highest power of the wavelength.
const MAX_POWER: u8 = 8;
/// What coefficients are below, so that sums of terms are numbers that an `f32` can hold.
const TOO_LARGE: f64 = 1e20;

/// A term of an expansion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// The radial orders n and m, n not below m.
    pub radial: [u8; 2],
    /// The azimuthal order l: at most m, and even or odd as n and m are.
    pub azimuthal: u8,
    /// The power of the wavelength in micrometres by which the term is multiplied.
    pub power: u8,
    /// The coefficient.
    pub coefficient: f64,
}

impl Term {
    /// The factor of the products of the polynomials for light of this wavelength, in micrometres.
    pub(super) fn factor(&self, micrometres: f64) -> f64 {
        let [n, m] = self.radial.map(f64::from);
        let half = |is: bool| if is { 0.5 } else { 1.0 };
        let square = (n + 1.0) * (m + 1.0) * half(self.radial[0] == self.radial[1]) * half(self.azimuthal == 0);
        self.coefficient * square.sqrt() / (2.0 * PI) * micrometres.powi(self.power.into())
    }

    fn is_valid(&self) -> bool {
        let ([n, m], l) = (self.radial, self.azimuthal);
        let are_ordered = l <= m && m <= n && n <= MAX_ORDER;
        are_ordered
            && (n - l) % 2 == 0
            && (m - l) % 2 == 0
            && self.power <= MAX_POWER
            && self.coefficient.abs() < TOO_LARGE
    }
}

/// An expansion, and the wavelengths at which it is evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    terms: Vec<Term>,
    channels: Channels,
}

impl Data {
    /// Checks the orders of the terms. Channels are wavelengths, or one channel without a wavelength if no term depends
    /// on it.
    ///
    /// # Errors
    /// [`Invalid`] names `terms` or `channels`.
    pub fn new(terms: Vec<Term>, channels: Channels) -> Result<Self, Invalid> {
        if terms.is_empty() {
            return Err(Invalid::new("terms", "none", "at least one"));
        }
        if let Some(at) = terms.iter().position(|term| !term.is_valid()) {
            let Term { radial: [n, m], azimuthal: l, power, coefficient } = terms[at];
            let found = format!("n {n}, m {m}, l {l}, power {power} and coefficient {coefficient} at index {at}");
            let expected = format!(
                "l <= m <= n <= {MAX_ORDER}, all even or all odd, powers up to {MAX_POWER}, and coefficients below \
                 {TOO_LARGE:e}"
            );
            return Err(Invalid::new("terms", found, expected));
        }
        let is_fit = match &channels {
            Channels::Mono => terms.iter().all(|term| term.power == 0),
            Channels::Spectral(wavelengths) => {
                !wavelengths.is_empty() && wavelengths.iter().all(|nm| *nm > 0.0 && *nm < 1e6)
            }
            _ => false,
        };
        match is_fit {
            true => Ok(Data { terms, channels }),
            false => Err(Invalid::new(
                "channels",
                format!("{channels:?}"),
                "wavelengths, or one channel if no term depends on the wavelength",
            )),
        }
    }

    /// The terms.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// The wavelength of each channel in micrometres.
    pub(super) fn micrometres(&self) -> Vec<f64> {
        match &self.channels {
            Channels::Spectral(wavelengths) => wavelengths.iter().map(|nm| nm / 1000.0).collect(),
            // No term depends on it.
            _ => vec![1.0],
        }
    }

    /// The highest radial order.
    pub(super) fn order(&self) -> usize {
        self.terms.iter().map(|term| usize::from(term.radial[0])).max().unwrap_or(0)
    }
}
