//! Readers and writers for the file formats of measured BRDFs and BSDFs.
#![forbid(unsafe_code)]

pub mod alta;
pub mod astm;
mod columns;
pub mod cornell;
mod error;
pub mod fred;
pub mod goniometer;
pub mod light_tools;
mod lines;
pub mod lumos;
pub mod nist;
pub mod openmaterial;
mod records;
mod replace;
pub mod speos;
pub mod ssdd;
#[allow(dead_code, reason = "other readers use the rest")]
mod text;
pub mod window_xml;

pub use error::{FormatError, Place};
