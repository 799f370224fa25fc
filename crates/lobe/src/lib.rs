//! Measured BRDFs and BSDFs: open a file, evaluate it in batches on the best SIMD backend of the machine.
//!
//! [`Material`] is what most programs want: from a file of any format, from bytes in memory, or from samples, in any
//! representation; [`Sampler`] draws directions for it. Both are a [`Bsdf`], and so are the models of `lobe-model`. A
//! renderer that is itself vectorised takes a [`specular::Table`] and calls [`specular::Table::eval_lanes`] inside a
//! [`Kernel`] of its own, which [`Backend::run`] runs.
//!
//! The crates below are here by their contents: [`table`] has the representations, [`formats`] the readers and writers,
//! [`math`] the functions in lanes. What most programs name is re-exported at the top.
//!
//! # Features
//!
//! All are on by default; `default-features = false` builds specular tables only. A file of a representation that was left
//! out opens with an error that says so.
//!
//! | feature | what it adds |
//! |---|---|
//! | `rayon` | large batches are shared among the threads of the current rayon pool |
//! | `half-diff` | grids of half and difference angles, as in the MERL database |
//! | `mueller` | Mueller matrices |
//! | `rgl` | materials of the EPFL database |
//! | `spherical` | grids of spherical coordinates |
//! | `utia` | materials of the UTIA database |
//! | `window` | Klems matrices and tensor trees |
#![forbid(unsafe_code)]

mod error;
mod material;
mod parallel;
mod sampler;

pub use error::{OpenError, ShapeError};
pub use lobe_backend::{BACKEND_VARIABLE, Backend, BackendError};
pub use lobe_formats as formats;
pub use lobe_lane::{Floats, Ints, Kernel, Lanes, Mask};
pub use lobe_math as math;
pub use lobe_table as table;
pub use lobe_table::half_diff::Lookup;
pub use lobe_table::utia::Decode;
pub use lobe_table::{
    Aspect, Axis, Bsdf, BsdfLanes, Channels, Data, Directions, Edge, Edges, Function, Given, Kind, Options, Precision,
    Sampled, SamplerError, SamplerOptions, Scatter, Side, luminance, specular,
};
pub use material::{Material, SHEET};
pub use parallel::PARALLEL_FROM;
pub use sampler::Sampler;
