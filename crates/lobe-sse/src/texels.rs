//! Quads in one register, octs in two.

use core::arch::x86_64::*;

use lobe_lane::{Block, Texels};

use crate::values::floats;
use crate::{Floats, Level, Oct, Sse, memory};

impl<V: Level> Texels for Sse<V> {
    type Quad = Floats<V>;
    type Oct = Oct<V>;

    #[inline(always)]
    fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        a * b + c
    }
    #[inline(always)]
    fn quad_load(self, src: &[f32]) -> Floats<V> {
        floats(memory::load(src))
    }
    #[inline(always)]
    fn quad_store(self, dst: &mut [f32], x: Floats<V>) {
        memory::store(dst, x.0);
    }
    #[inline(always)]
    fn quad_corners<const N: usize>(self, block: &Block<'_, N, 4>, base: usize) -> [Floats<V>; N] {
        let mut corners = [self.quad_splat(0.0); N];
        let mut corner = 0;
        while corner < N {
            corners[corner] = floats(memory::load_corner(block, base, corner, 0));
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn quad_splat(self, x: f32) -> Floats<V> {
        floats(op!(_mm_set1_ps(x)))
    }
    #[inline(always)]
    fn quad_mul_add(self, a: Floats<V>, b: Floats<V>, c: Floats<V>) -> Floats<V> {
        a * b + c
    }
    #[inline(always)]
    fn quad_max(self, a: Floats<V>, b: Floats<V>) -> Floats<V> {
        floats(op!(_mm_max_ps(a.0, b.0)))
    }

    #[inline(always)]
    fn oct_load(self, src: &[f32]) -> Oct<V> {
        let src = &src[..8];
        Oct(floats(memory::load(src)), floats(memory::load(&src[4..])))
    }
    #[inline(always)]
    fn oct_store(self, dst: &mut [f32], x: Oct<V>) {
        let dst = &mut dst[..8];
        memory::store(dst, x.0.0);
        memory::store(&mut dst[4..], x.1.0);
    }
    #[inline(always)]
    fn oct_splat(self, x: f32) -> Oct<V> {
        Oct(self.quad_splat(x), self.quad_splat(x))
    }
    #[inline(always)]
    fn oct_corners<const N: usize>(self, block: &Block<'_, N, 8>, base: usize) -> [Oct<V>; N] {
        let mut corners = [self.oct_splat(0.0); N];
        let mut corner = 0;
        while corner < N {
            corners[corner] = Oct(
                floats(memory::load_corner(block, base, corner, 0)),
                floats(memory::load_corner(block, base, corner, 1)),
            );
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn oct_mul_add(self, a: Oct<V>, b: Oct<V>, c: Oct<V>) -> Oct<V> {
        a * b + c
    }
    #[inline(always)]
    fn oct_max(self, a: Oct<V>, b: Oct<V>) -> Oct<V> {
        Oct(self.quad_max(a.0, b.0), self.quad_max(a.1, b.1))
    }
    #[inline(always)]
    fn oct_halves(self, x: Oct<V>) -> [Floats<V>; 2] {
        [x.0, x.1]
    }
    #[inline(always)]
    fn oct_count_le(self, knots: Oct<V>, x: f32) -> u32 {
        let x = op!(_mm_set1_ps(x));
        let bits = op!(_mm_movemask_ps(_mm_cmple_ps(knots.0.0, x)) | _mm_movemask_ps(_mm_cmple_ps(knots.1.0, x)) << 4);
        (bits as u32).trailing_ones()
    }
}
