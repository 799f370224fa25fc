//! Isotropic materials on a grid of half and difference angles.
//!
//! Matusik et al., "A Data-Driven Reflectance Model", ACM TOG 22(3), 2003, in the coordinates of Rusinkiewicz, "A New
//! Change of Variables for Efficient BRDF Representation", 1998.
//!
//! [`Data`] are the bins as measured, with an evaluation in `f64`; a [`Table`] is prepared for evaluation in SIMD
//! lanes.

mod data;
#[cfg(feature = "half-diff")]
mod prepared;
mod reference;
mod representation;
#[cfg(feature = "half-diff")]
mod table;
#[cfg(all(test, feature = "half-diff"))]
mod tests;

pub use data::{Data, Lookup};
pub use representation::KIND;
#[cfg(feature = "half-diff")]
pub use table::Table;
