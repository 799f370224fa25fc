//! Fits of materials with known parameters.

mod measured;
mod outputs;
mod recovery;
