//! The matrices as measured.

use crate::invalid::{Invalid, ascending, count};

/// A 4 x 4 matrix, `[row][column]`, that maps the Stokes vector of incoming light to that of outgoing light.
pub type Matrix = [[f64; 4]; 4];

/// The elements of a matrix.
pub(crate) const ELEMENTS: usize = 16;

/// Tabulated Mueller matrices.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    pub(super) knots: [Vec<f32>; 4],
    pub(super) values: Vec<f32>,
}

/// The axes of the tables, with their names in the file format.
pub const AXES: [&str; 4] = ["phi_d", "theta_d", "theta_h", "wvls"];

impl Data {
    /// Checks the knots of `phi_d`, `theta_d`, `theta_h`, in radians, and the wavelengths in nm, all ascending, and
    /// that there is a matrix for each combination: `[phi_d][theta_d][theta_h][wavelength][row][column]`.
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
