//! Scalar backends: the reference, and emulated widths.
//!
//! [`Scalar<1>`] defines the results that every other backend must give, bit for bit in strict form. [`Scalar<4>`],
//! `<8>` and `<16>` run width-generic kernels at the widths of real hardware on any machine, so that kernels can be
//! tested without the hardware.
#![forbid(unsafe_code)]

mod lanes;
mod texels;
mod values;

pub use texels::Texel;
pub use values::{Floats, Ints, Mask};

/// A backend of `N` lanes in plain Rust; `N` is 1, 2, 4, 8 or 16.
///
/// It needs no CPU feature, so anyone can create the token.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scalar<const N: usize>;

/// The reference backend.
pub type Reference = Scalar<1>;
