//! The evaluation of a block of queries in short passes over small arrays.
//!
//! One long kernel would be bound by latency: the reorder buffer of a core holds a few hundred instructions, and the
//! chain from a direction to a texel is longer than that. Short passes over a block keep many independent queries in
//! flight, with the same arithmetic. The order is
//!
//! 1. [`frame`]: directions to the sines and cosines of the four angles;
//! 2. [`angles`]: inverse trigonometry;
//! 3. [`cells`]: for each axis the cell and the fraction, summed up to the index of a texel;
//! 4. [`weights`]: fractions to corner weights;
//! 5. [`texels`]: the corners of each query, weighted and summed.
//!
//! Representations in other coordinates begin with [`half_vector`] or [`unit`] and go on the same way; [`batch`] takes
//! them through their blocks.

pub(crate) mod batch;
pub(crate) mod block;
pub(crate) mod half_vector;
pub(crate) mod unit;
