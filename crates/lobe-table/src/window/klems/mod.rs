//! Klems matrices: a BSDF that is constant on pairs of patches of two hemispheres.
//!
//! A basis cuts a hemisphere into rings of polar angle and each ring into equal sectors of azimuth, the first of which
//! is centred on +x (J. H. Klems, "A new method for predicting the solar heat gain of complex fenestration systems",
//! ASHRAE Transactions 100(1), 1994). Nothing is interpolated: a value belongs to a whole patch.
//!
//! [`Table`](super::Table) evaluates it in SIMD lanes.

#[cfg(feature = "window")]
pub(crate) mod lanes;
mod matrix;
mod reference;
#[cfg(test)]
mod tests;

pub use matrix::{AngleBasis, KIND, KlemsError, KlemsMatrix, Ring};
