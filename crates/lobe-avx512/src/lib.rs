//! The 16-lane backend of x86_64: [`Avx512`], with masks in separate registers, searches of up to 64 cells inside
//! registers, and hardware gathers.
//!
//! Quads, octs and the narrow backend are those of [`Avx2`], whose instructions every CPU with AVX-512 has.
//!
//! `unsafe` occurs in three places: in the `op!` macro (register-only intrinsics, safe because the token proves the
//! features), in `memory.rs` and `gathers.rs` (each access is checked where it is made), and in `vectorize`, the entry
//! point.
#![cfg(target_arch = "x86_64")]
#![no_std]

extern crate std;

use lobe_avx::Avx2;

/// Calls intrinsics that touch nothing but registers.
macro_rules! op {
    ($call:expr) => {{
        // SAFETY: a value of these types, or the token itself, exists only where the CPU has the features of the token, and
        // the intrinsic touches registers only.
        unsafe { $call }
    }};
}

mod gathers;
mod lanes;
mod memory;
mod texels;
mod values;

pub use values::{Floats, Ints, Mask};

/// A proof that the CPU has AVX-512 F, VL, DQ, BW and VBMI2, and the features of [`Avx2`]: sixteen lanes. Intel has had
/// these since Ice Lake, and AMD since Zen 4.
#[derive(Clone, Copy, Debug)]
pub struct Avx512 {
    narrow: Avx2,
}

impl Avx512 {
    /// The token, if the CPU has the features.
    pub fn detect() -> Option<Self> {
        let has = std::is_x86_feature_detected!("avx512f")
            && std::is_x86_feature_detected!("avx512vl")
            && std::is_x86_feature_detected!("avx512dq")
            && std::is_x86_feature_detected!("avx512bw")
            && std::is_x86_feature_detected!("avx512vbmi2");
        let narrow = Avx2::detect()?;
        has.then_some(Avx512 { narrow })
    }

    /// The token without a check of the CPU.
    ///
    /// # Safety
    /// Safe from code compiled with the features of the attribute; elsewhere the CPU must have them.
    #[inline]
    #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx512vbmi2")]
    #[target_feature(enable = "avx2,fma,f16c,bmi1,bmi2,lzcnt,popcnt")]
    pub fn new() -> Self {
        Avx512 { narrow: Avx2::new() }
    }
}
