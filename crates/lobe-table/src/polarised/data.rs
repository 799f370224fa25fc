//! The matrices as measured or computed.

use std::cmp::Ordering;

use crate::mueller::ELEMENTS;
use crate::{Channels, GridError, Scatter, specular};

/// Mueller matrices on a grid in specular coordinates.
///
/// Axes as in [`specular::Data`], in radians; an isotropic table has one psi knot. Elements are in 1/sr, without the
/// cosine, in the order `[sigma][psi][theta][phi][wavelength][row][column]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// The values for unpolarised light: the first elements.
    pub(super) first: specular::Data,
    pub(super) values: Vec<f32>,
}

impl Data {
    /// Checks that there is a matrix of finite numbers for each combination of knots and each wavelength, in nm, which
    /// ascend.
    ///
    /// # Errors
    /// [`GridError`] names the axis, the position, what was found and what was expected.
    pub fn new(knots: [Vec<f64>; 4], wavelengths: Vec<f64>, values: Vec<f32>) -> Result<Self, GridError> {
        if let Some(at) = wavelengths.windows(2).position(|pair| pair[0].partial_cmp(&pair[1]) != Some(Ordering::Less))
        {
            let [before, after] = [wavelengths[at], wavelengths[at + 1]];
            return Err(GridError::Channels(format!(
                "wavelength {after} after {before}; expected ascending ones in nm"
            )));
        }
        let matrices = knots.iter().try_fold(wavelengths.len(), |all, knots| all.checked_mul(knots.len()));
        let expected = matrices.and_then(|all| all.checked_mul(ELEMENTS)).ok_or(GridError::TooLarge)?;
        if values.len() != expected {
            return Err(GridError::ValueCount { found: values.len(), expected });
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(GridError::ValueNotFinite { index, value: values[index] });
        }
        let first = values.iter().copied().step_by(ELEMENTS).collect();
        let first = specular::Data::new(Scatter::Reflection, knots, Channels::Spectral(wavelengths), first)?;
        Ok(Data { first, values })
    }

    /// The knots of sigma, psi, theta and phi, in radians.
    pub fn knots(&self) -> &[Vec<f64>; 4] {
        self.first.knots()
    }

    /// The wavelengths in nm.
    pub fn wavelengths(&self) -> &[f64] {
        match self.first.channels() {
            Channels::Spectral(wavelengths) => wavelengths,
            _ => &[],
        }
    }

    /// All elements in 1/sr, without the cosine: `[sigma][psi][theta][phi][wavelength][row][column]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The values for unpolarised light: the first elements.
    pub fn unpolarised(&self) -> &specular::Data {
        &self.first
    }
}
