//! Readers and writers for the file formats of measured BRDFs and BSDFs.
//!
//! [`open`] reads any of them; each format has a module with its own reader, and a writer if one makes sense. What the
//! formats look like, and what is done if a file leaves a question open, is described in `docs/formats.md`.
#![forbid(unsafe_code)]

pub mod alta;
pub mod astm;
mod bytes;
mod columns;
pub mod cornell;
pub mod ddr;
mod document;
mod error;
pub mod fred;
pub mod goniometer;
mod grid;
mod integra;
pub mod light_tools;
mod lines;
pub mod lumos;
pub mod mbsdf;
pub mod merl;
pub mod nist;
pub mod npz;
pub mod openmaterial;
pub mod pbsdf;
mod records;
pub mod rgl;
pub mod sdr;
mod sheet;
mod sniff;
pub mod speos;
pub mod ssdd;
pub mod tensor;
mod text;
mod units;
pub mod utia;
pub mod window_xml;
mod write;
pub mod zemax;
mod zip;

pub use document::{Document, Measured, Part, from_bytes, open, read};
pub use error::{FormatError, Place};
pub use sheet::Sides;
pub use sniff::{Format, sniff};
pub use text::nine_digits;
pub use write::write_whole;
