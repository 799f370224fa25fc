//! BRDFs and BTDFs on a grid of specular coordinates, whose axes follow the peak.
//!
//! [`Data`] are a material as it was measured, and a [`Table`] is made ready for evaluation in SIMD lanes. [`mod@reference`]
//! is the same evaluation in `f64`, written for the reader; [`coords`] explains the four angles.

pub mod coords;
mod data;
pub(crate) mod eval;
mod interpolate;
pub mod reference;
mod representation;
mod single;
mod table;

pub use data::{AXIS_NAMES, Data};
pub use representation::KIND;
pub use table::{Table, TableError};
