//! The 4-lane backend of 64-bit Arm: `Neon`, with fused multiply-add and half-precision loads. Octs are two registers.
//!
//! `unsafe` occurs in two places: in the `op!` macro (register-only intrinsics, safe because the target has NEON), and
//! in `memory.rs` (loads and stores, each checked where it is used). The crate is empty unless the whole target has
//! NEON, as all targets with an operating system do, so nothing needs to be compiled with an additional feature.
#![cfg(all(target_arch = "aarch64", target_feature = "neon", target_endian = "little"))]
#![no_std]

extern crate std;

/// Calls intrinsics that touch nothing but registers.
macro_rules! op {
    ($call:expr) => {{
        // SAFETY: this crate is compiled only for targets with NEON, and the intrinsic touches registers only.
        unsafe { $call }
    }};
}

/// Methods of one expression, which are inlined.
macro_rules! methods {
    ($(
        fn $name:ident $(<const $n:ident: $number:ty $(, $t:ident)?>)? ($self:ident $(, $argument:ident: $type:ty)*)
            $(-> $out:ty)? = $value:expr;
    )*) => {$(
        #[inline(always)]
        fn $name $(<const $n: $number $(, $t)?>)? ($self $(, $argument: $type)*) $(-> $out)? {
            $value
        }
    )*};
}

mod lanes;
mod memory;
mod texels;
mod values;

pub use values::{Floats, Ints, Mask, Oct};

/// A proof that the CPU has NEON: four lanes.
#[derive(Clone, Copy, Debug)]
pub struct Neon(());

impl Neon {
    /// The token, if the CPU has NEON.
    pub fn detect() -> Option<Self> {
        std::arch::is_aarch64_feature_detected!("neon").then_some(Neon(()))
    }
}
