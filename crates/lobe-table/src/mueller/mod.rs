//! Polarised reflection: a 4 x 4 Mueller matrix for every pair of directions and wavelength.
//!
//! Baek et al., "Image-Based Acquisition and Modeling of Polarimetric Reflectance", ACM TOG 39(4), 2020. The material
//! is isotropic; matrices are tabulated over the coordinates of Rusinkiewicz, in Stokes frames that follow the plane of
//! the two directions.
//!
//! [`Data`] are the matrices as measured, with an evaluation in `f64`. A [`Table`] holds the element that applies to
//! unpolarised light, and [`Matrices`] hold all elements, prepared for evaluation in SIMD lanes.

mod data;
#[cfg(feature = "mueller")]
mod matrices;
#[cfg(feature = "mueller")]
mod places;
#[cfg(feature = "mueller")]
mod prepared;
mod reference;
mod representation;
#[cfg(feature = "mueller")]
mod table;
#[cfg(all(test, feature = "mueller"))]
mod tests;

pub(crate) use data::ELEMENTS;
pub use data::{AXES, Data, Matrix};
#[cfg(feature = "mueller")]
pub use matrices::Matrices;
pub(crate) use reference::in_frames;
pub use reference::{coordinates, plane_normal, rounding, stokes_basis, turned};
pub use representation::KIND;
#[cfg(feature = "mueller")]
pub use table::Table;
