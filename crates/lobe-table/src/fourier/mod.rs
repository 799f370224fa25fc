//! Isotropic materials as cosine series in the difference of the azimuths, interpolated between knots of the cosines of
//! both polar angles.
//!
//! Jakob, d'Eon, Jakob and Marschner, "A Comprehensive Framework for Rendering Layered Materials", ACM TOG 33(4), 2014;
//! the Fourier BSDF of pbrt-v3 and the results of layerlab.
//!
//! [`Data`] are the coefficients as they were computed, with their evaluation in `f64`; a [`Table`] sums the series in
//! lanes, eight coefficients at a time.

mod data;
mod place;
#[cfg(feature = "fourier")]
mod prepared;
mod reference;
mod representation;
#[cfg(feature = "fourier")]
mod table;
#[cfg(all(test, feature = "fourier"))]
mod tests;

pub use data::{Data, Parts, Series};
pub use representation::KIND;
#[cfg(feature = "fourier")]
pub use table::Table;
