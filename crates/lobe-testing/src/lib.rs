//! What the tests of the workspace share. It is never published: crates depend on it for their tests alone, by its path.
//!
//! | module | what it has |
//! |---|---|
//! | [`backends`] | running a test on every backend, in every form, and on emulated widths |
//! | [`conformance`](mod@conformance) | every method of a backend against plain scalar arithmetic |
//! | [`patterns`] | floats and integers on which implementations differ |
//! | [`files`] | the fixtures of the repository, and measured files beside it |
//! | [`golden`] | the answers of other programs about such files |
//! | [`made`] | files that are made by a rule |
//! | [`damage`] | truncated, corrupted and randomly damaged files |
//! | [`memory`] | the peak of memory that a piece of work takes |
//! | `examples`, `probe` | a small file of every format; reading any bytes (feature `formats`) |
#![forbid(unsafe_code)]

pub mod backends;
pub mod conformance;
pub mod damage;
#[cfg(feature = "formats")]
pub mod examples;
pub mod files;
pub mod golden;
pub mod made;
pub mod memory;
pub mod patterns;
#[cfg(feature = "formats")]
pub mod probe;

#[doc(hidden)]
pub use peak_alloc::PeakAlloc;
