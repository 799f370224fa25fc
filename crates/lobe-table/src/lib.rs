//! Tabulated BRDFs and BTDFs on non-uniform angular grids, evaluated in SIMD lanes.
#![forbid(unsafe_code)]

mod direction;
mod invalid;
pub mod rgl;
mod samples;

pub use invalid::Invalid;
pub use samples::{AXIS_NAMES, Channels, Samples, SamplesError, Scatter};
