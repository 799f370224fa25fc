//! The 4-lane backend of WebAssembly: `Simd128`. Octs are two registers.
//!
//! A module declares before it runs which instructions it uses, and an engine that lacks them refuses it. So the crate
//! is empty unless it is compiled with `-C target-feature=+simd128`, and then the token needs no detection. Intrinsics
//! that touch only registers are safe functions; `unsafe` occurs only in `memory.rs` (loads and stores, each checked
//! where it is used).
//!
//! Multiply-add rounds twice. Relaxed SIMD has one that rounds once or twice, as the engine chooses, which is neither
//! of the two forms of a backend: each of these has the same bits everywhere.
#![cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
#![no_std]

/// Methods of one expression, which are inlined.
macro_rules! methods {
    ($(
        fn $name:ident $(<const $n:ident: $number:ty>)? ($self:ident $(, $argument:ident: $type:ty)*)
            $(-> $out:ty)? = $value:expr;
    )*) => {$(
        #[inline(always)]
        fn $name $(<const $n: $number>)? ($self $(, $argument: $type)*) $(-> $out)? {
            $value
        }
    )*};
}

mod lanes;
mod memory;
mod texels;
mod values;

pub use values::{Floats, Ints, Mask, Oct};

/// A proof that the engine has `simd128`, for which this was compiled: four lanes.
#[derive(Clone, Copy, Debug)]
pub struct Simd128(());

impl Simd128 {
    /// The token: any engine that runs this has the instructions.
    #[inline(always)]
    pub fn new() -> Self {
        Simd128(())
    }
}

impl Default for Simd128 {
    fn default() -> Self {
        Simd128::new()
    }
}
