//! The adaptive parameterisation of the EPFL material database.
//!
//! Dupuy and Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM TOG 37(6),
//! 2018. A measurement is stored on the unit square, warped for every incident direction so that the samples are dense
//! where the microfacet distribution of the material has its energy.
//!
//! `wi` is the direction that indexes a table, and `wo` the other one. Renderers that trace from the camera pass the
//! viewer as `wi`, so that [`Reference::sample`] yields the next direction of a path.
//!
//! [`Data`] holds the data; [`Reference`] evaluates them one query at a time in `f64`; [`Table`] evaluates many queries
//! in SIMD lanes; [`Warp`] is the interpolated warp of the unit square.

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
