//! Measured BRDFs and BSDFs: open a file, evaluate it in batches on the best SIMD backend of the machine.
//!
//! [`Material`] is what most programs want: any format, any representation. [`Brdf`] is a specular table, evaluated
//! wherever its batches lie. A renderer that is itself vectorised takes a [`specular::Table`] and calls
//! [`specular::Table::eval_lanes`] inside a [`Kernel`] of its own, which [`Backend::run`] runs.
#![forbid(unsafe_code)]

mod brdf;
mod material;
mod sampler;

pub use brdf::{Brdf, OpenError, PARALLEL_FROM};
pub use lobe_backend::{BACKEND_VARIABLE, Backend, BackendError};
pub use lobe_formats as formats;
pub use lobe_lane::{Floats, Ints, Kernel, Lanes, Mask};
pub use lobe_math as math;
pub use lobe_table as table;
pub use lobe_table::utia::Decode;
pub use lobe_table::{
    Aspect, Axis, Channels, Data, Directions, Edge, Edges, Function, Given, Precision, Sampled, SamplerError,
    SamplerOptions, Scatter, Side, luminance, specular,
};
pub use material::{Kind, Lookup, Material, Options};
pub use sampler::Sampler;
