//! Tabulated BRDFs and BTDFs on non-uniform angular grids, evaluated in SIMD lanes.
#![forbid(unsafe_code)]

pub mod coords;
mod edges;
pub mod reference;
mod samples;

pub use edges::{Edge, Edges};
pub use samples::{AXIS_NAMES, Channels, Samples, SamplesError, Scatter};
