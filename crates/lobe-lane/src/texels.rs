//! Whole texels of one query: four floats (a *quad*) and two neighbouring texels (an *oct*).
//!
//! The corners of an interpolation are far apart in memory, but the channels of a texel are adjacent. Loading a whole
//! texel takes one load; gathering its channels lane by lane takes one load each, so the inner loop of a table runs
//! along a query and not across queries. Quads and octs have the same width on every backend.
//!
//! Tables may also hold half-precision floats (IEEE 754 binary16, as `u16`). They must be finite: the conversion of
//! infinities and NaNs is not defined.

use core::fmt::Debug;
use core::ops::{Add, Mul, Sub};

use crate::strict::backend_trait;
use crate::{Block, Lanes, Strict};

backend_trait! {
    /// Operations on the channels of one query, with the same bits on all backends that fuse, and on all that do not.
    pub trait Texels: Copy + Debug + Send + Sync + 'static {
        /// Four floats.
        type Quad: Copy + Debug + Add<Output = Self::Quad> + Sub<Output = Self::Quad> + Mul<Output = Self::Quad>;
        /// Eight floats.
        type Oct: Copy + Debug + Add<Output = Self::Oct> + Mul<Output = Self::Oct>;

        /// `a * b + c` of single floats; rounded once if the backend fuses.
        fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32;
        /// `a * b + c`, float by float; rounded once if the backend fuses.
        fn quad_mul_add(self, a: Self::Quad, b: Self::Quad, c: Self::Quad) -> Self::Quad;
        /// `a * b + c`, float by float; rounded once if the backend fuses.
        fn oct_mul_add(self, a: Self::Oct, b: Self::Oct, c: Self::Oct) -> Self::Oct;
    }

    handed_on as TEXELS_HANDED_ON {
        /// The first four floats of `src`.
        ///
        /// # Panics
        /// If `src` is shorter.
        fn quad_load(self, src: &[f32]) -> Self::Quad;
        /// Writes to the first four floats of `dst`.
        ///
        /// # Panics
        /// If `dst` is shorter.
        fn quad_store(self, dst: &mut [f32], x: Self::Quad);
        /// The four floats at `base + offset` of the block, for each of its offsets; `base` is clamped to the block's
        /// last base.
        fn quad_corners<const N: usize>(self, block: &Block<'_, N, 4>, base: usize) -> [Self::Quad; N];
        /// Like [`quad_corners`](Texels::quad_corners), from half-precision floats.
        fn quad_corners_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: usize) -> [Self::Quad; N];
        /// `x` four times.
        fn quad_splat(self, x: f32) -> Self::Quad;
        /// `if a > b { a } else { b }`, float by float, so `b` if either is NaN.
        fn quad_max(self, a: Self::Quad, b: Self::Quad) -> Self::Quad;

        /// The first eight floats of `src`.
        ///
        /// # Panics
        /// If `src` is shorter.
        fn oct_load(self, src: &[f32]) -> Self::Oct;
        /// Writes to the first eight floats of `dst`.
        ///
        /// # Panics
        /// If `dst` is shorter.
        fn oct_store(self, dst: &mut [f32], x: Self::Oct);
        /// `x` eight times.
        fn oct_splat(self, x: f32) -> Self::Oct;
        /// The floats at `base + offset` of the block, for each of its offsets; `base` is clamped to the block's last base.
        fn oct_corners<const N: usize>(self, block: &Block<'_, N, 8>, base: usize) -> [Self::Oct; N];
        /// Like [`oct_corners`](Texels::oct_corners), from half-precision floats.
        fn oct_corners_half<const N: usize>(self, block: &Block<'_, N, 8, u16>, base: usize) -> [Self::Oct; N];
        /// `if a > b { a } else { b }`, float by float, so `b` if either is NaN.
        fn oct_max(self, a: Self::Oct, b: Self::Oct) -> Self::Oct;
        /// The first four and the last four floats.
        fn oct_halves(self, x: Self::Oct) -> [Self::Quad; 2];
        /// How many of the eight floats are `<= x`, counted up to the first that is not: all of them if they ascend.
        fn oct_count_le(self, knots: Self::Oct, x: f32) -> u32;
    }

    strict {
        type Quad = L::Quad;
        type Oct = L::Oct;

        #[inline(always)]
        fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
            a * b + c
        }

        #[inline(always)]
        fn quad_mul_add(self, a: L::Quad, b: L::Quad, c: L::Quad) -> L::Quad {
            a * b + c
        }

        #[inline(always)]
        fn oct_mul_add(self, a: L::Oct, b: L::Oct, c: L::Oct) -> L::Oct {
            a * b + c
        }
    }
}
