//! Operations on measured materials: what people who own them ask for.
//!
//! - [`albedo`]: how much of the light from one direction comes back;
//! - [`reciprocity`], [`check`]: is the measurement sound, and what does it cover;
//! - [`energy`], [`symmetrise`], [`fill`]: repairs of a table, each of which says what it changed;
//! - [`resample`]: any material into a table of specular coordinates, with given knots or with as many as an error bound
//!   asks for, and the error that was made;
//! - [`colour`]: spectra to CIE XYZ and to RGB;
//! - [`compare`]: how far two materials are apart, in numbers and to the eye.
//!
//! What has values is a [`Scattering`]: a [`lobe::Material`], or a model. A [`Subject`] is a file, opened, with what the
//! operations have to know about it. Directions point away from the surface, normal on +z; angles are radians; values are
//! `f` in 1/sr, without the cosine.
#![forbid(unsafe_code)]

pub mod albedo;
pub mod check;
pub mod colour;
pub mod compare;
mod directions;
pub mod energy;
pub mod fill;
pub mod hemisphere;
pub mod reciprocity;
pub mod resample;
mod samples;
mod scattering;
mod subject;
pub mod symmetrise;
#[cfg(test)]
mod testing;

pub use lobe_table::Aspect;
pub use scattering::Scattering;
pub use subject::Subject;
