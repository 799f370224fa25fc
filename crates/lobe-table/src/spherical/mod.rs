//! BRDFs and BTDFs on a grid of spherical coordinates of both directions.
//!
//! [`Data`] are the values as they were measured, with their evaluation in `f64`; a [`Table`] is made ready for evaluation in
//! SIMD lanes.

pub(crate) mod coordinates;
mod data;
mod prepared;
mod reference;
mod representation;
mod table;

pub use data::{AXIS_NAMES, Data};
pub use representation::KIND;
pub use table::Table;
