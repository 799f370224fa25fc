//! Fits of materials whose parameters are known.

mod measured;
mod outputs;
mod recovery;
