//! A sheet with two sides: blocks of values, selected by the sides of a pair of directions.
//!
//! [`Blocks`] are the values of one band of wavelengths, with an evaluation in `f64`; [`Data`] holds several bands, and
//! a [`Table`] has them prepared for evaluation in SIMD lanes.

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
