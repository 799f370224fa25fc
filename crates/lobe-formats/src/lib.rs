//! Readers and writers for the file formats of measured BRDFs and BSDFs.
#![forbid(unsafe_code)]

mod error;

pub use error::{FormatError, Place};
