//! A sheet of material with two sides: which block of values answers for which pair of directions.
//!
//! [`Blocks`] are the values of one band of wavelengths, with their evaluation in `f64`; [`Data`] are several bands, and a
//! [`Table`] is the same made ready for evaluation in SIMD lanes.

mod blocks;
mod data;
pub mod klems;
#[cfg(feature = "window")]
mod prepared;
mod representation;
#[cfg(feature = "window")]
mod table;
pub mod tensor_tree;
#[cfg(all(test, feature = "window"))]
mod tests;

pub use blocks::{Block, Blocks, Component};
pub use data::{Band, Data};
#[cfg(feature = "window")]
pub use table::Table;
