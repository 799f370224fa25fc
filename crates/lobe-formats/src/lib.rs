//! Readers and writers for the file formats of measured BRDFs and BSDFs.
//!
//! [`open`] reads any of them, and [`open_with`] those that leave something open, which a [`sidecar`] may say too; each
//! format has a module with its own reader, and a writer if one makes sense. What the
//! formats look like, and how their open questions are settled, is described in `docs/formats.md`.
#![forbid(unsafe_code)]

mod adjust;
pub mod alta;
pub mod astm;
mod bytes;
mod columns;
mod convert;
pub mod cornell;
mod document;
pub mod fred;
pub mod goniometer;
pub mod integra;
pub mod light_tools;
mod lines;
pub mod lumos;
pub mod mbsdf;
pub mod merl;
pub mod nist;
pub mod npz;
pub mod openmaterial;
pub mod pbsdf;
mod plain;
pub mod reading;
mod records;
mod registry;
pub mod rgl;
mod sheet;
pub mod sidecar;
mod spec;
pub mod speos;
pub mod ssdd;
pub mod tensor;
mod text;
pub mod utia;
pub mod window_xml;
pub mod zemax;
mod zip;

pub use convert::{ChannelMap, ConvertError, Written, convert};
pub use document::{Document, Measured, Part};
pub use integra::{ddr, sdr};
pub use lobe_files::{FormatError, Place, write_whole};
pub use reading::ReadOptions;
pub use registry::{Format, from_bytes, from_bytes_with, open, open_with, read, read_with, sniff};
pub use sheet::Sides;
pub use spec::{FormatSpec, Read, Writer};
pub use text::nine_digits;
