//! Tabulated BRDFs and BTDFs on non-uniform angular grids, evaluated in SIMD lanes.
//!
//! [`Samples`] are a material as it was measured, [`Edges`] say what holds outside its knots, and a [`Table`] is both made
//! ready to be evaluated on any [`lobe_lane`] backend. [`reference`] is the same evaluation in `f64`, written for the
//! reader; [`coords`] explains the four angles.
#![forbid(unsafe_code)]

mod axis;
pub mod coords;
mod direction;
mod directions;
mod edges;
mod eval;
mod function;
pub mod half_diff;
mod invalid;
mod knots;
mod layout;
pub mod mueller;
mod passes;
pub mod reference;
pub mod rgl;
mod samples;
mod search;
mod single;
pub mod spherical;
mod storage;
mod table;
pub mod utia;

pub use axis::{Axis, AxisError};
pub use directions::{Directions, Soa};
pub use edges::{Edge, Edges};
pub use function::Function;
pub use invalid::Invalid;
pub use samples::{AXIS_NAMES, Channels, Samples, SamplesError, Scatter};
pub use search::Cell;
pub use table::{Table, TableError};
