//! Readers and writers for the file formats of measured BRDFs and BSDFs.
#![forbid(unsafe_code)]

mod bytes;
mod error;
pub mod mbsdf;
pub mod merl;
pub mod pbsdf;
mod replace;
pub mod rgl;
pub mod tensor;
pub mod utia;

pub use error::{FormatError, Place};
