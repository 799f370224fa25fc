//! The adaptive parameterisation of the EPFL material database.
//!
//! Dupuy and Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM TOG 37(6),
//! 2018. A measurement is kept on the unit square, warped for every incident direction so that the samples lie where
//! the microfacet distribution of the material puts its energy.
//!
//! The direction that a table is indexed by is `wi`; the other one is `wo`. Renderers that trace from the camera put
//! the viewer into `wi`, so that [`Reference::sample`] yields the next direction of a path.
//!
//! [`Data`] is the data; [`Reference`] evaluates it one query at a time in `f64`; [`Table`]
//! evaluates many in SIMD lanes; [`Warp`] is the interpolant between.

mod data;
mod images;
#[cfg(feature = "rgl")]
mod lanes;
mod marginal;
#[cfg(feature = "rgl")]
mod prepared;
mod reference;
mod representation;
#[cfg(all(test, feature = "rgl"))]
mod tests;

pub use data::{Data, Parts};
pub use images::Images;
#[cfg(feature = "rgl")]
pub use lanes::{Drawn, Options, Table, Wanted};
pub use marginal::{Blend, Warp};
pub use reference::{Reference, Sample, UniformOrder};
pub use representation::KIND;
