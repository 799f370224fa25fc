//! Anisotropic materials on the uniform grid of the UTIA database.
//!
//! Filip and Vavra, "Template-Based Sampling of Anisotropic BRDFs", Computer Graphics Forum 33(7), 2014: zenith angles
//! of 0, 15, ... 75 degrees and azimuths of 0, 7.5, ... 352.5 degrees for both directions.
//!
//! [`Data`] are the values as measured, with an evaluation in `f64`; a [`Table`] is made ready for evaluation in SIMD
//! lanes.

mod data;
#[cfg(feature = "utia")]
mod prepared;
mod reference;
mod representation;
#[cfg(feature = "utia")]
mod table;
#[cfg(all(test, feature = "utia"))]
mod tests;

pub use data::{Data, Decode, PHIS, PLANE, THETAS};
pub use representation::KIND;
#[cfg(feature = "utia")]
pub use table::Table;
