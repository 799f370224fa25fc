//! BRDFs and BTDFs on a grid in spherical coordinates of both directions.
//!
//! [`Data`] are the values as measured, with an evaluation in `f64`; a [`Table`] is made ready for evaluation in SIMD
//! lanes.

pub(crate) mod coordinates;
mod data;
#[cfg(feature = "spherical")]
mod prepared;
mod reference;
mod representation;
#[cfg(feature = "spherical")]
mod table;

pub use data::{AXIS_NAMES, Data};
pub use representation::KIND;
#[cfg(feature = "spherical")]
pub use table::Table;
