//! BRDFs and BTDFs on a grid in specular coordinates, whose axes follow the peak.
//!
//! [`Data`] is a material as measured, and a [`Table`] is prepared for evaluation in SIMD lanes. [`mod@reference`] is
//! the same evaluation in readable `f64`; [`coords`] explains the four angles.

pub(crate) mod angles;
pub mod coords;
mod data;
mod eval;
pub(crate) mod frame;
mod interpolate;
mod prepared;
pub mod reference;
mod representation;
mod single;
mod table;

pub use data::{AXIS_NAMES, Data};
pub use representation::KIND;
pub use table::Table;

pub(crate) const SIGMA: usize = 0;
pub(crate) const PSI: usize = 1;
pub(crate) const THETA: usize = 2;
pub(crate) const PHI: usize = 3;
