//! Measured BRDFs and BTDFs, in the representations in which they were measured, evaluated in SIMD lanes.
//!
//! Each representation has a module with its `Data`, as measured, a readable evaluation of them in `f64`, and, except
//! for mirrors, a `Table` prepared for evaluation on any [`lobe_lane`] backend:
//!
//! - [`specular`]: a grid in specular coordinates, whose axes follow the peak;
//! - [`spherical`]: a grid in spherical coordinates of both directions;
//! - [`scattered`]: any number of directions, on no grid;
//! - [`rgl`]: the adaptive parameterisation of the EPFL database;
//! - [`fourier`]: cosine series in the azimuth, between knots of both polar angles;
//! - [`zernike`]: expansions in Zernike polynomials of both directions;
//! - [`half_diff`]: a grid of half and difference angles, as in the MERL database;
//! - [`mueller`]: matrices of polarised reflection over half and difference angles;
//! - [`polarised`]: matrices of polarised reflection on a grid in specular coordinates;
//! - [`utia`]: the grid of the UTIA database;
//! - [`window`]: Klems matrices and tensor trees of the two sides of a sheet;
//! - [`mirror`]: mirror reflectances, which have no value for a pair of directions.
//!
//! [`Data`] holds any of them, and the trait [`Representation`] gives access to it.
//!
//! They share [`Axis`] and the other parts of a grid, and [`Channels`] and [`Scatter`], which describe the values.
//!
//! # Features
//!
//! | feature | enables the `Table` of |
//! |---|---|
//! | `fourier` | [`fourier`] |
//! | `half-diff` | [`half_diff`] |
//! | `mueller` | [`mueller`], [`polarised`] |
//! | `rgl` | [`rgl`] |
//! | `scattered` | [`scattered`] |
//! | `spherical` | [`spherical`] |
//! | `utia` | [`utia`] |
//! | `window` | [`window`] |
//! | `zernike` | [`zernike`] |
//!
//! All of them are on by default. [`specular`] is always there, and so are the data of every representation with their
//! evaluation in `f64`: only the kernels take long to compile.
#![forbid(unsafe_code)]
// Without some of the kernels, some of their shared code is unused.
#![cfg_attr(
    not(all(
        feature = "fourier",
        feature = "half-diff",
        feature = "mueller",
        feature = "rgl",
        feature = "scattered",
        feature = "spherical",
        feature = "utia",
        feature = "window",
        feature = "zernike"
    )),
    allow(dead_code, unused_imports)
)]

pub mod bsdf;
pub mod data;
mod direction;
mod directions;
pub mod fourier;
mod grid;
pub mod half_diff;
mod invalid;
pub mod mirror;
pub mod mueller;
pub mod paper;
mod passes;
pub mod polarised;
mod representations;
pub mod rgl;
mod sampling;
mod scatter;
pub mod scattered;
pub mod specular;
pub mod spherical;
pub mod utia;
pub mod window;
pub mod zernike;

pub use bsdf::{Bsdf, BsdfLanes};
pub use data::{Aspect, Kind, Options, PrepareError, Representation, Side, Uses};
pub use directions::Directions;
pub use grid::{Axis, AxisError, Cell, Edge, Edges, Function, GridError, Precision, TableError};
pub use invalid::Invalid;
pub use lobe_colour::{Channels, luminance};
pub use representations::Data;
pub use sampling::{
    Distribution, DistributionError, DistributionOptions, Given, PatchSampler, Sampled, Sampler, SamplerError,
    SamplerOptions,
};
pub use scatter::Scatter;
