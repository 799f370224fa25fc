//! BRDFs and BTDFs on a grid of ordinary spherical coordinates of both directions.
//!
//! [`Data`] are the values as they were measured, with their evaluation in `f64`.

mod data;
mod reference;
mod representation;

pub use data::Data;
pub use representation::KIND;
