//! Readers and writers for the file formats of measured BRDFs and BSDFs.
//!
//! [`open`] reads any of them; each format has a module with its own reader, and a writer where it makes sense. What
//! the formats look like, and what is done where a file leaves a question open, is described in `docs/formats.md`.
#![forbid(unsafe_code)]

mod bytes;
pub mod ddr;
mod document;
mod error;
mod grid;
mod integra;
pub mod mbsdf;
pub mod merl;
pub mod pbsdf;
pub mod rgl;
pub mod sdr;
mod sniff;
mod specular;
pub mod tensor;
mod text;
mod units;
pub mod utia;
mod write;
pub mod zemax;

pub use document::{Document, Measured, open};
pub use error::{FormatError, Place};
pub use sniff::{Format, sniff};
pub use specular::Specular;
pub use text::nine_digits;
