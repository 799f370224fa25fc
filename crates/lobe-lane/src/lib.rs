//! Portable SIMD lanes for measured-material kernels.
//!
//! A *kernel* is written once, generic over [`Lanes`], and runs with whatever instructions the processor has. This
//! crate holds only the trait: no `unsafe`, no intrinsics, no backend. Backends are in separate crates.
//!
//! - A backend is a zero-sized **token** that only detection can create, so holding one proves that the CPU has the
//!   feature.
//! - Lane values ([`Lanes::F`], [`Lanes::I`], [`Lanes::M`]) come only from a token, so their operators are ordinary
//!   safe Rust: kernels read like formulas.
//! - [`Lanes::vectorize`] is the only entry into code compiled with the feature. **Everything generic over `L: Lanes`
//!   must be `#[inline(always)]`**, or it is compiled without the feature and runs many times slower.
//! - Only a handful of loads and stores touch memory, each bounds-safe by itself. A wrong backend gives wrong
//!   numbers, never undefined behaviour.
//! - [`Lanes::strict`] gives the same backend with multiply-add rounded twice: bit-identical on every backend.
//!
//! ```
//! use lobe_lane::{Kernel, Lanes};
//!
//! /// y = a x + y over whole slices.
//! struct Axpy<'a>(f32, &'a [f32], &'a mut [f32]);
//!
//! impl Kernel for Axpy<'_> {
//!     type Out = ();
//!
//!     #[inline(always)]
//!     fn run<L: Lanes>(self, lanes: L) {
//!         let Axpy(a, x, y) = self;
//!         let a = lanes.splat(a);
//!         for (x, y) in x.chunks(L::LANES).zip(y.chunks_mut(L::LANES)) {
//!             let sum = lanes.mul_add(a, lanes.load_partial(x), lanes.load_partial(y));
//!             lanes.store_partial(y, sum);
//!         }
//!     }
//! }
//! ```
#![no_std]
#![forbid(unsafe_code)]

mod block;
mod lanes;
mod strict;
mod texels;
mod values;

pub use block::Block;
pub use lanes::{Kernel, Lanes, MAX_LANES, call};
pub use strict::Strict;
pub use texels::Texels;
pub use values::{Floats, Ints, Mask};
#[doc(hidden)]
pub use {lanes::LANES_HANDED_ON, texels::TEXELS_HANDED_ON};
