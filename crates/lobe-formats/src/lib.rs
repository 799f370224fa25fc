//! Readers and writers for the file formats of measured BRDFs and BSDFs.
#![forbid(unsafe_code)]

mod error;
mod replace;
pub mod window_xml;

pub use error::{FormatError, Place};
