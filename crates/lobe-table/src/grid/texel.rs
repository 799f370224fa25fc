//! The number formats that texels are stored in.

use half::f16;
use lobe_lane::{Block, Lanes};

/// How the values of a table are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 32-bit floats: the values of the file.
    #[default]
    Single,
    /// 16-bit floats, half the memory, scaled by a power of two so that the largest value fits. Each value is rounded to
    /// 11 significant bits, an error of at most 2^-11 of the value, or of 2^-39 of the largest value of the table where
    /// that is more. Faster for tables that do not fit the caches.
    Half,
}

/// A number as it lies in memory, which loads turn into floats.
pub(crate) trait Stored: Copy + Default + bytemuck::Pod + Send + Sync {
    /// The number nearest to `x`.
    fn from_f32(x: f32) -> Self;

    fn octs<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 8, Self>, base: usize) -> [L::Oct; N];
    fn quads<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4, Self>, base: usize) -> [L::Quad; N];
    fn gather<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4, Self>, base: L::I) -> [[L::F; 4]; N];
}

impl Stored for f32 {
    fn from_f32(x: f32) -> Self {
        x
    }
    #[inline(always)]
    fn octs<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 8>, base: usize) -> [L::Oct; N] {
        lanes.oct_corners(block, base)
    }
    #[inline(always)]
    fn quads<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4>, base: usize) -> [L::Quad; N] {
        lanes.quad_corners(block, base)
    }
    #[inline(always)]
    fn gather<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4>, base: L::I) -> [[L::F; 4]; N] {
        lanes.gather_quads(block, base)
    }
}

/// The bits of a half-precision float.
impl Stored for u16 {
    fn from_f32(x: f32) -> Self {
        f16::from_f32(x).to_bits()
    }
    #[inline(always)]
    fn octs<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 8, u16>, base: usize) -> [L::Oct; N] {
        lanes.oct_corners_half(block, base)
    }
    #[inline(always)]
    fn quads<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4, u16>, base: usize) -> [L::Quad; N] {
        lanes.quad_corners_half(block, base)
    }
    #[inline(always)]
    fn gather<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4, u16>, base: L::I) -> [[L::F; 4]; N] {
        lanes.gather_quads_half(block, base)
    }
}

/// The power of two by which values of at most `largest` are multiplied so that they fit a half-precision float.
pub(crate) fn half_scale(largest: f32) -> f32 {
    // 2^15 leaves room for the rounding up of the largest value. Powers beyond 2^100 would overflow on the way back.
    let exponent = if largest > 0.0 { 15 - largest.log2().ceil() as i32 } else { 0 };
    2f32.powi(exponent.clamp(-100, 100))
}
