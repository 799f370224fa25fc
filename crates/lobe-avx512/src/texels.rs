//! Quads and octs: those of AVX2, whose registers are as wide as they are.

use lobe_avx::Quad;
use lobe_lane::{Block, Texels};

use crate::Avx512;

impl Texels for Avx512 {
    type Quad = Quad;
    type Oct = lobe_avx::Floats;

    #[inline(always)]
    fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        self.narrow.scalar_mul_add(a, b, c)
    }
    #[inline(always)]
    fn quad_load(self, src: &[f32]) -> Quad {
        self.narrow.quad_load(src)
    }
    #[inline(always)]
    fn quad_store(self, dst: &mut [f32], x: Quad) {
        self.narrow.quad_store(dst, x);
    }
    #[inline(always)]
    fn quad_corners<const N: usize>(self, block: &Block<'_, N, 4>, base: usize) -> [Quad; N] {
        self.narrow.quad_corners(block, base)
    }
    #[inline(always)]
    fn quad_corners_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: usize) -> [Quad; N] {
        self.narrow.quad_corners_half(block, base)
    }
    #[inline(always)]
    fn quad_splat(self, x: f32) -> Quad {
        self.narrow.quad_splat(x)
    }
    #[inline(always)]
    fn quad_mul_add(self, a: Quad, b: Quad, c: Quad) -> Quad {
        self.narrow.quad_mul_add(a, b, c)
    }
    #[inline(always)]
    fn quad_max(self, a: Quad, b: Quad) -> Quad {
        self.narrow.quad_max(a, b)
    }

    #[inline(always)]
    fn oct_load(self, src: &[f32]) -> Self::Oct {
        self.narrow.oct_load(src)
    }
    #[inline(always)]
    fn oct_store(self, dst: &mut [f32], x: Self::Oct) {
        self.narrow.oct_store(dst, x);
    }
    #[inline(always)]
    fn oct_splat(self, x: f32) -> Self::Oct {
        self.narrow.oct_splat(x)
    }
    #[inline(always)]
    fn oct_corners<const N: usize>(self, block: &Block<'_, N, 8>, base: usize) -> [Self::Oct; N] {
        self.narrow.oct_corners(block, base)
    }
    #[inline(always)]
    fn oct_corners_half<const N: usize>(self, block: &Block<'_, N, 8, u16>, base: usize) -> [Self::Oct; N] {
        self.narrow.oct_corners_half(block, base)
    }
    #[inline(always)]
    fn oct_mul_add(self, a: Self::Oct, b: Self::Oct, c: Self::Oct) -> Self::Oct {
        self.narrow.oct_mul_add(a, b, c)
    }
    #[inline(always)]
    fn oct_max(self, a: Self::Oct, b: Self::Oct) -> Self::Oct {
        self.narrow.oct_max(a, b)
    }
    #[inline(always)]
    fn oct_halves(self, x: Self::Oct) -> [Quad; 2] {
        self.narrow.oct_halves(x)
    }
    #[inline(always)]
    fn oct_count_le(self, knots: Self::Oct, x: f32) -> u32 {
        self.narrow.oct_count_le(knots, x)
    }
}
