//! Polarised reflection: a 4 x 4 Mueller matrix for every pair of directions and wavelength.
//!
//! Baek et al., "Image-Based Acquisition and Modeling of Polarimetric Reflectance", ACM TOG 39(4), 2020. The material is
//! isotropic; matrices are tabulated over the coordinates of Rusinkiewicz, in Stokes frames that follow the plane of
//! the two directions.
//!
//! [`Data`] are the matrices as they were measured, with their evaluation in `f64`; a [`Table`] has what
//! unpolarised light sees of them, made ready for evaluation in SIMD lanes.

#[cfg(feature = "mueller")]
mod lanes;
#[cfg(feature = "mueller")]
mod prepared;
mod reference;
mod representation;
#[cfg(all(test, feature = "mueller"))]
mod tests;

use crate::invalid::{Invalid, ascending, count};

#[cfg(feature = "mueller")]
pub use lanes::Table;
pub use reference::{coordinates, plane_normal, rounding, stokes_basis};
pub use representation::KIND;

/// A 4 x 4 matrix, `[row][column]`, that turns a Stokes vector of the incoming light into one of the outgoing light.
pub type Matrix = [[f64; 4]; 4];

/// The elements of a matrix.
const ELEMENTS: usize = 16;

/// Tabulated Mueller matrices.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    knots: [Vec<f32>; 4],
    values: Vec<f32>,
}

/// The axes of the tables, with the names that the file format gives them.
pub const AXES: [&str; 4] = ["phi_d", "theta_d", "theta_h", "wvls"];

impl Data {
    /// Checks the knots of `phi_d`, `theta_d`, `theta_h`, in radians, and the wavelengths in nm, all ascending, and that
    /// there is a matrix for each combination: `[phi_d][theta_d][theta_h][wavelength][row][column]`.
    ///
    /// A matrix whose first element is NaN was not measured.
    ///
    /// # Errors
    /// [`Invalid`] names the axis, or `M` for the matrices.
    pub fn new(knots: [Vec<f32>; 4], values: Vec<f32>) -> Result<Self, Invalid> {
        for (name, axis) in AXES.into_iter().zip(&knots) {
            ascending(name, axis)?;
        }
        let [p, d, h, w] = [0, 1, 2, 3].map(|axis: usize| knots[axis].len());
        count("M", values.len(), &[p, d, h, w, 4, 4])?;
        match values.iter().position(|v| v.is_infinite()) {
            Some(at) => Err(Invalid::new("M", format!("{} at index {at}", values[at]), "finite numbers, or NaN")),
            None => Ok(Data { knots, values }),
        }
    }

    /// The knots of `phi_d`, `theta_d`, `theta_h` in radians, and the wavelengths in nm.
    pub fn knots(&self) -> &[Vec<f32>; 4] {
        &self.knots
    }

    /// All elements in 1/sr, without the cosine: `[phi_d][theta_d][theta_h][wavelength][row][column]`.
    pub fn values(&self) -> &[f32] {
        &self.values
    }
}
