//! Operations on measured materials.
//!
//! - [`albedo`]: the share of the light from one direction that is scattered;
//! - [`reciprocity`], [`check`]: whether a measurement is sound, and what it covers;
//! - [`energy`], [`symmetrise`], [`fill`]: repairs of a table, each of which reports what it changed;
//! - [`resample`]: any material into a table of specular coordinates, with given knots or with as many as an error
//!   bound asks for, and the error that was made;
//! - [`remeasure`]: any material at the nodes of another representation;
//! - [`colour`]: from spectra to CIE XYZ and RGB;
//! - [`describe`](mod@describe): the contents of a file, in names, numbers and words;
//! - [`compare`]: the difference of two materials, in numbers and in appearance;
//! - [`certify`](mod@certify), [`certificate`]: the error of a converted file.
//!
//! Operations evaluate any [`Bsdf`](lobe_table::Bsdf) on a backend, such as a [`lobe::Material`]. A [`Subject`] is an
//! opened file with the information that operations need. Directions point away from the surface, normal on +z; angles
//! are radians; values are `f` in 1/sr, without the cosine.
#![forbid(unsafe_code)]

pub mod albedo;
pub mod certificate;
pub mod certify;
pub mod check;
pub mod colour;
pub mod compare;
pub mod daylight;
pub mod describe;
mod directions;
pub mod energy;
pub mod fill;
pub mod hemisphere;
pub mod matrices;
mod pairs;
pub mod reciprocity;
pub mod remeasure;
pub mod resample;
mod samples;
mod subject;
pub mod symmetrise;
#[cfg(test)]
mod testing;

pub use directions::pairs as direction_pairs;
pub use lobe_table::Aspect;
pub use lobe_table::bsdf::OnBackend;
pub use subject::Subject;
