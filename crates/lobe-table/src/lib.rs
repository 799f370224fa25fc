//! Tabulated BRDFs and BTDFs on non-uniform angular grids, evaluated in SIMD lanes.
//!
//! [`Samples`] are a material as it was measured, [`Edges`] say what holds outside its knots, and a [`Table`] is both made
//! ready to be evaluated on any [`lobe_lane`] backend. [`mod@reference`] is the same evaluation in `f64`, written for the
//! reader; [`coords`] explains the four angles.
#![forbid(unsafe_code)]

mod axis;
pub mod coords;
mod directions;
mod edges;
mod eval;
mod function;
mod layout;
pub mod paper;
mod passes;
pub mod reference;
mod samples;
mod search;
mod storage;
mod table;

pub use axis::{Axis, AxisError};
pub use directions::{Directions, Soa};
pub use edges::{Edge, Edges};
pub use function::Function;
pub use samples::{AXIS_NAMES, Channels, Samples, SamplesError, Scatter};
pub use search::Cell;
pub use table::{Table, TableError};
