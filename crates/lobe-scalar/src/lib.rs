//! Scalar backends: the reference, and emulated widths.
//!
//! [`Scalar<1>`] defines what every other backend must give, bit for bit in strict form. [`Scalar<4>`], `<8>` and
//! `<16>` run width-generic kernels at the widths of real hardware anywhere, which is how kernels are tested where the
//! hardware is absent.
#![forbid(unsafe_code)]

mod lanes;
mod texels;
mod values;

pub use texels::Texel;
pub use values::{Floats, Ints, Mask};

/// A backend of `N` lanes in plain Rust; `N` is 1, 2, 4, 8 or 16.
///
/// It needs no CPU feature, so the token is free to make.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scalar<const N: usize>;

/// The reference backend.
pub type Reference = Scalar<1>;
