//! The 8-lane backend of x86_64: [`Avx2`], with fused multiply-add, half-precision loads, and the bit-manipulation
//! instructions that came with it, because kernels iterate over masks.
//!
//! `unsafe` occurs in three places: in the `op!` macro (register-only intrinsics, safe because the token proves the
//! features), in `memory.rs` (loads and stores, each checked where it is used), and in `vectorize`, the entry point.
#![cfg(target_arch = "x86_64")]
#![no_std]

extern crate std;

/// Calls intrinsics that touch nothing but registers.
macro_rules! op {
    ($call:expr) => {{
        // SAFETY: a value of these types, or the token itself, exists only where the CPU has AVX2, FMA and F16C, and the
        // intrinsic touches registers only.
        unsafe { $call }
    }};
}

mod lanes;
mod memory;
mod texels;
mod values;

pub use values::{Floats, Ints, Mask, Quad};

/// A proof that the CPU has AVX2, FMA, F16C, BMI1, BMI2, LZCNT and POPCNT: eight lanes. All CPUs with AVX2 so far have
/// the others.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

impl Avx2 {
    /// The token, if the CPU has the features.
    pub fn detect() -> Option<Self> {
        let has = std::is_x86_feature_detected!("avx2")
            && std::is_x86_feature_detected!("fma")
            && std::is_x86_feature_detected!("f16c")
            && std::is_x86_feature_detected!("bmi1")
            && std::is_x86_feature_detected!("bmi2")
            && std::is_x86_feature_detected!("lzcnt")
            && std::is_x86_feature_detected!("popcnt");
        has.then_some(Avx2(()))
    }

    /// The token without a check of the CPU.
    ///
    /// # Safety
    /// Safe from code compiled with the features of the attribute; elsewhere the CPU must have them.
    #[inline]
    #[target_feature(enable = "avx2,fma,f16c,bmi1,bmi2,lzcnt,popcnt")]
    pub fn new() -> Self {
        Avx2(())
    }
}
