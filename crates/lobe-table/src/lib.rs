//! Tabulated BRDFs and BTDFs on non-uniform angular grids, evaluated in SIMD lanes.
#![forbid(unsafe_code)]

pub mod klems;
mod mesh;
mod samples;
pub mod scattered;
pub mod spherical_grid;
pub mod tensor_tree;
pub mod window;

pub use samples::{AXIS_NAMES, Channels, Samples, SamplesError, Scatter};
