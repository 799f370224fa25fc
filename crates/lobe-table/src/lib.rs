//! Tabulated BRDFs and BTDFs on non-uniform angular grids, evaluated in SIMD lanes.
#![forbid(unsafe_code)]

mod direction;
pub mod half_diff;
mod invalid;
mod knots;
pub mod mueller;
pub mod rgl;
mod samples;
pub mod spherical;
pub mod utia;

pub use invalid::Invalid;
pub use samples::{AXIS_NAMES, Channels, Samples, SamplesError, Scatter};
