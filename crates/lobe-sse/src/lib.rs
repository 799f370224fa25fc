//! The 4-lane backends of x86_64: [`Sse2`], which every such CPU has, and [`Sse41`].
//!
//! Both share their code, which is generic over a [`Level`], the few instructions that differ. `unsafe` occurs in three
//! places: in the `op!` macro (register-only intrinsics, safe because the token proves the feature), in `memory.rs`
//! (loads and stores, each checked where it is used), and in `vectorize`, the entry point.
#![cfg(target_arch = "x86_64")]
#![no_std]

extern crate std;

/// Calls intrinsics that touch nothing but registers.
macro_rules! op {
    ($call:expr) => {{
        // SAFETY: a value of these types, or the token itself, exists only where the CPU has the level's instructions,
        // and the intrinsic touches registers only.
        unsafe { $call }
    }};
}

mod lanes;
mod level;
mod memory;
mod texels;
mod values;

pub use level::{Level, V2, V41};
pub use values::{Floats, Ints, Mask, Oct};

use core::marker::PhantomData;

/// A proof that the CPU has the instructions of `V`.
#[derive(Clone, Copy, Debug)]
pub struct Sse<V: Level>(PhantomData<V>);

/// Four lanes on SSE2, the baseline of x86_64.
pub type Sse2 = Sse<V2>;
/// Four lanes on SSE4.1.
pub type Sse41 = Sse<V41>;

impl Sse2 {
    /// The token; every x86_64 CPU has SSE2.
    #[inline(always)]
    pub fn new() -> Self {
        Sse(PhantomData)
    }
}

impl Default for Sse2 {
    fn default() -> Self {
        Sse2::new()
    }
}

impl Sse41 {
    /// The token, if the CPU has SSE4.1.
    pub fn detect() -> Option<Self> {
        std::is_x86_feature_detected!("sse4.1").then_some(Sse(PhantomData))
    }

    /// The token without a check of the CPU.
    ///
    /// # Safety
    /// Safe from code compiled with SSE4.1, as the attribute says; elsewhere the CPU must have it.
    #[inline]
    #[target_feature(enable = "sse4.1")]
    pub fn new() -> Self {
        Sse(PhantomData)
    }
}
