//! Tabulated BRDFs and BTDFs on non-uniform angular grids, evaluated in SIMD lanes.
#![forbid(unsafe_code)]

mod samples;

pub use samples::{AXIS_NAMES, Channels, Samples, SamplesError, Scatter};
