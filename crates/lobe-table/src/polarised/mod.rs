//! Polarised reflection on a grid of specular coordinates: a 4 x 4 Mueller matrix for every node and wavelength.
//!
//! The axes are those of [`specular`](crate::specular), so they follow the peak; the Stokes frames of the matrices are
//! those of [`mueller`](crate::mueller): the x axis is the normal of the plane of the two directions, before and after
//! the reflection. A surface of microfacets, whose matrices depend on that plane, then has smooth elements everywhere,
//! including around the peak for light from the zenith.
//!
//! [`Data`] are the matrices with an evaluation in `f64`; [`Matrices`] are prepared for evaluation in SIMD lanes.

mod data;
#[cfg(feature = "mueller")]
mod matrices;
#[cfg(feature = "mueller")]
mod prepared;
mod reference;
mod representation;

pub use data::Data;
#[cfg(feature = "mueller")]
pub use matrices::Matrices;
pub use representation::KIND;
