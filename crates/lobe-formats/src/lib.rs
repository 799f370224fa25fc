//! Readers and writers for the file formats of measured BRDFs and BSDFs.
//!
//! [`open`] reads any of them, and [`open_with`] also those that leave something open, which a [`sidecar`] may supply
//! too; each format has a module with its own reader, and a writer if that makes sense. `docs/formats.md` describes the
//! formats, and how their open questions are settled.
//!
//! # Features
//!
//! | feature | formats |
//! |---|---|
//! | `json` | OpenMaterial, and users' own tables in JSON |
//! | `mueller` | `pbsdf`, Mueller matrices in specular coordinates |
//! | `rgl` | the EPFL database |
//! | `spherical` | MDL |
//! | `window` | WINDOW XML |
//!
//! All of them are on by default. The other formats are always there.
#![forbid(unsafe_code)]
// Without some of the formats, some of their shared code is unused.
#![cfg_attr(
    not(all(feature = "json", feature = "mueller", feature = "rgl", feature = "spherical", feature = "window")),
    allow(dead_code, unused_imports)
)]

mod adjust;
pub mod alta;
mod angle;
pub mod astm;
mod averages;
mod bytes;
mod columns;
mod convert;
pub mod cornell;
mod document;
mod facts;
mod folder;
pub mod fourier;
pub mod fred;
pub mod goniometer;
pub mod integra;
pub mod light_tools;
mod lines;
mod listed;
pub mod lumos;
#[cfg(feature = "spherical")]
pub mod mbsdf;
pub mod merl;
#[cfg(feature = "mueller")]
pub mod mueller_csv;
pub mod nist;
pub mod npz;
mod open;
#[cfg(feature = "json")]
pub mod openmaterial;
pub mod pab;
#[cfg(feature = "mueller")]
pub mod pbsdf;
mod plain;
#[cfg(feature = "mueller")]
pub mod polarised;
pub mod reading;
mod records;
mod registry;
#[cfg(feature = "rgl")]
mod restored;
pub mod rgl;
mod sheet;
pub mod sidecar;
mod spec;
pub mod speos;
pub mod ssdd;
#[cfg(any(feature = "mueller", feature = "rgl"))]
pub mod tensor;
mod text;
mod totals;
pub mod tracepro;
mod unknown;
pub mod utia;
#[cfg(feature = "window")]
pub mod window_xml;
mod words;
pub mod zemax;
pub mod zernike;
mod zip;

pub use convert::{ChannelMap, ConvertError, ENDS, Written, convert};
pub use document::{Document, Measured, Part};
pub use integra::{ddr, sdr};
pub use lobe_files::{FormatError, Place, write_whole};
pub use open::{from_bytes, from_bytes_with, open, open_with, read, read_with};
pub use plain::{decoded, text as plain_text};
pub use reading::ReadOptions;
pub use registry::{Format, sniff};
pub use sheet::Sides;
pub use spec::{FormatSpec, RESAMPLED, Read, ReadSet, Writer};
pub use text::nine_digits;
