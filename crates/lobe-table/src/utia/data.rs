//! The values as measured.

use crate::invalid::{Invalid, count};

/// Degrees between two zenith angles, and between two azimuths.
pub(super) const STEPS: [f64; 2] = [15.0, 7.5];
/// Stored values are divided by this before the sRGB curve is undone.
pub(super) const SCALE: f64 = 140.0;

/// The number of zenith angles of each direction.
pub const THETAS: usize = 6;
/// The number of azimuths of each direction.
pub const PHIS: usize = 48;
/// The values of one channel.
pub const PLANE: usize = THETAS * PHIS * THETAS * PHIS;

/// A material of the UTIA database.
///
/// The unit of the stored values is not documented, and the programs that read them disagree; see [`Decode`].
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    pub(super) values: Vec<f64>,
}

/// The conversion of the stored values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Decode {
    /// The stored values, interpolated.
    #[default]
    Raw,
    /// The reading of Dupuy's BRDF library: negative values become zero and all are divided by 140; after the
    /// interpolation the sRGB curve, with its threshold at 0.0375, is undone and the result multiplied by 100.
    Srgb,
}

impl Data {
    /// Checks that there are `[channel][theta_i][phi_i][theta_v][phi_v]` values, 3 x 6 x 48 x 6 x 48, all finite.
    ///
    /// # Errors
    /// [`Invalid`] names `values`.
    pub fn new(values: Vec<f64>) -> Result<Self, Invalid> {
        count("values", values.len(), &[3, THETAS, PHIS, THETAS, PHIS])?;
        match values.iter().position(|v| !v.is_finite()) {
            Some(at) => Err(Invalid::new("values", format!("{} at index {at}", values[at]), "finite numbers")),
            None => Ok(Data { values }),
        }
    }

    /// All values as stored: `[channel][theta_i][phi_i][theta_v][phi_v]`.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}
