//! Measured materials for Python: the module `lobe_bsdf._lobe`, whose names the package in `python/lobe_bsdf`
//! re-exports.
//!
//! Arrays become batches (`batches`), errors become exceptions (`errors`), and work runs without the lock of the
//! interpreter, in a way that Ctrl-C can end (`threads`). What is computed is in the crates below.
#![forbid(unsafe_code)]

mod arrays;
mod aspects;
mod batches;
mod content;
mod errors;
mod files;
mod labels;
mod material;
mod opened;
mod operations;
mod options;
mod pictures;
mod resampling;
mod results;
mod sampler;
mod samples;
mod saving;
mod scattered;
mod strided;
mod tasks;
mod threads;
mod unit;

/// The native part of `lobe_bsdf`.
#[pyo3::pymodule]
mod _lobe {
    #[pymodule_export]
    use crate::files::{backends, formats, from_bytes, open};
    #[pymodule_export]
    use crate::material::Material;
    #[pymodule_export]
    use crate::pictures::{Picture, finished_parts, merge, render};
    #[pymodule_export]
    use crate::sampler::Sampler;
    #[pymodule_export]
    use crate::samples::from_samples;
    #[pymodule_export]
    use crate::unit::normalize;
}
