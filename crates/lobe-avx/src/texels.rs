//! Quads in an `xmm` register, octs in a `ymm` register.

use core::arch::x86_64::*;

use lobe_lane::{Block, Texels};

use crate::{Avx2, Floats, Quad, memory};

impl Texels for Avx2 {
    type Quad = Quad;
    type Oct = Floats;

    #[inline(always)]
    fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        a.mul_add(b, c)
    }
    #[inline(always)]
    fn quad_load(self, src: &[f32]) -> Quad {
        Quad(memory::load4(self, src))
    }
    #[inline(always)]
    fn quad_store(self, dst: &mut [f32], x: Quad) {
        memory::store4(self, dst, x.0);
    }
    #[inline(always)]
    fn quad_corners<const N: usize>(self, block: &Block<'_, N, 4>, base: usize) -> [Quad; N] {
        let mut corners = [self.quad_splat(0.0); N];
        let mut corner = 0;
        while corner < N {
            corners[corner] = Quad(memory::load_quad(self, block, base, corner));
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn quad_splat(self, x: f32) -> Quad {
        Quad(op!(_mm_set1_ps(x)))
    }
    #[inline(always)]
    fn quad_mul_add(self, a: Quad, b: Quad, c: Quad) -> Quad {
        Quad(op!(_mm_fmadd_ps(a.0, b.0, c.0)))
    }
    #[inline(always)]
    fn quad_max(self, a: Quad, b: Quad) -> Quad {
        Quad(op!(_mm_max_ps(a.0, b.0)))
    }

    #[inline(always)]
    fn oct_load(self, src: &[f32]) -> Floats {
        Floats(memory::load8(self, src))
    }
    #[inline(always)]
    fn oct_store(self, dst: &mut [f32], x: Floats) {
        memory::store8(self, dst, x.0);
    }
    #[inline(always)]
    fn oct_splat(self, x: f32) -> Floats {
        Floats(op!(_mm256_set1_ps(x)))
    }
    #[inline(always)]
    fn oct_corners<const N: usize>(self, block: &Block<'_, N, 8>, base: usize) -> [Floats; N] {
        let mut corners = [self.oct_splat(0.0); N];
        let mut corner = 0;
        while corner < N {
            corners[corner] = Floats(memory::load_oct(self, block, base, corner));
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn oct_mul_add(self, a: Floats, b: Floats, c: Floats) -> Floats {
        Floats(op!(_mm256_fmadd_ps(a.0, b.0, c.0)))
    }
    #[inline(always)]
    fn oct_max(self, a: Floats, b: Floats) -> Floats {
        Floats(op!(_mm256_max_ps(a.0, b.0)))
    }
    #[inline(always)]
    fn oct_halves(self, x: Floats) -> [Quad; 2] {
        op!([Quad(_mm256_castps256_ps128(x.0)), Quad(_mm256_extractf128_ps::<1>(x.0))])
    }
    #[inline(always)]
    fn oct_count_le(self, knots: Floats, x: f32) -> u32 {
        let bits = op!(_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(knots.0, _mm256_set1_ps(x))));
        (bits as u32).trailing_ones()
    }
}
