//! Anisotropic materials on the uniform grid of the UTIA database.
//!
//! Filip and Vavra, "Template-Based Sampling of Anisotropic BRDFs", Computer Graphics Forum 33(7), 2014: zenith angles
//! of 0, 15, ... 75 degrees and azimuths of 0, 7.5, ... 352.5 degrees for both directions.
//!
//! [`Data`] are the values as they were measured, with their evaluation in `f64`; a [`Table`] is made ready for
//! evaluation in SIMD lanes.

#[cfg(feature = "utia")]
mod lanes;
#[cfg(feature = "utia")]
mod prepared;
mod reference;
mod representation;
#[cfg(all(test, feature = "utia"))]
mod tests;

use crate::invalid::{Invalid, count};

#[cfg(feature = "utia")]
pub use lanes::Table;
pub use representation::KIND;

/// Degrees between two zenith angles, and between two azimuths.
const STEPS: [f64; 2] = [15.0, 7.5];
/// Stored values are divided by this before the sRGB curve is undone.
const SCALE: f64 = 140.0;

/// How many zenith angles each direction has.
pub const THETAS: usize = 6;
/// How many azimuths each direction has.
pub const PHIS: usize = 48;
/// The values of one channel.
pub const PLANE: usize = THETAS * PHIS * THETAS * PHIS;

/// A material of the UTIA database.
///
/// The unit of the stored values is not documented, and the programs that read them disagree; see [`Decode`].
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    values: Vec<f64>,
}

/// What to make of the stored values.
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
