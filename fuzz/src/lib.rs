//! What all fuzz targets do: read, check the memory used, evaluate.
//!
//! `docs/fuzzing.md` says how to run them.
#![forbid(unsafe_code)]

use std::path::Path;

use lobe_formats::Format;
use lobe_testing::probe::probe;

lobe_testing::count_memory!();

/// Reads `bytes` as a file of `format` and evaluates what is in it.
///
/// # Panics
/// If a reader or an evaluation does, or a reader used more memory than the size of the file justifies.
pub fn read(format: Format, bytes: &[u8]) {
    // Whether it is a valid file does not matter here.
    let _ = probe(format, bytes, Path::new("fuzz"));
}

/// The target of a reader, which is named by its variant of [`Format`].
#[macro_export]
macro_rules! reader {
    ($format:ident) => {
        libfuzzer_sys::fuzz_target!(|bytes: &[u8]| $crate::read(lobe_formats::Format::$format, bytes));
    };
}
