//! Tabulated BRDFs and BTDFs on non-uniform angular grids, evaluated in SIMD lanes.
//!
//! [`Samples`] are a material as it was measured in specular coordinates, [`Edges`] say what holds outside its knots, and a
//! [`Table`] is both made ready to be evaluated on any [`lobe_lane`] backend. [`mod@reference`] is the same evaluation in
//! `f64`, written for the reader; [`coords`] explains the four angles.
//!
//! The other modules hold the representations that materials are measured in elsewhere, each with its evaluation in `f64` and,
//! but for spherical grids and scattered samples, made ready for lanes.
#![forbid(unsafe_code)]

mod axis;
pub mod coords;
mod direction;
mod directions;
mod edges;
mod eval;
mod function;
pub mod half_diff;
mod interpolate;
mod invalid;
pub mod klems;
mod knots;
mod layout;
mod line;
mod mesh;
pub mod mueller;
pub mod paper;
mod passes;
pub mod reference;
pub mod rgl;
mod samples;
mod sampling;
pub mod scattered;
mod search;
mod single;
pub mod spherical_grid;
use lobe_memory as storage;
mod table;
pub mod tensor_tree;
mod texel;
pub mod utia;
pub mod window;

pub use axis::{Axis, AxisError};
pub use directions::{Directions, Soa};
pub use edges::{Edge, Edges};
pub use function::Function;
pub use invalid::Invalid;
pub use samples::{AXIS_NAMES, Channels, Samples, SamplesError, Scatter};
pub use sampling::{
    Distribution, DistributionError, DistributionOptions, Given, PatchSampler, Sampled, Sampler, SamplerError,
    SamplerOptions, luminance,
};
pub use search::Cell;
pub use table::{Table, TableError};
pub use texel::Precision;
