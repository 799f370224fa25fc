//! The token of the 16-lane backend.

use core::arch::x86_64::*;

use lobe_avx::Avx2;
use lobe_lane::{Block, Floats as _, Kernel, Lanes};

use crate::{Avx512, Floats, Ints, Mask, gathers, memory};

impl Lanes for Avx512 {
    type F = Floats;
    type I = Ints;
    type M = Mask;
    type Narrow = Avx2;

    const LANES: usize = 16;
    const NAME: &'static str = "avx512";
    const FUSED: bool = true;
    const PERMUTES: bool = true;

    #[inline(always)]
    fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
        #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx512vbmi2")]
        #[target_feature(enable = "avx2,fma,f16c,bmi1,bmi2,lzcnt,popcnt")]
        fn inner<K: Kernel>(token: Avx512, kernel: K) -> K::Out {
            kernel.run(token)
        }
        // SAFETY: the token proves these features.
        unsafe { inner(self, kernel) }
    }

    #[inline(always)]
    fn narrow(self) -> Avx2 {
        self.narrow
    }

    #[inline(always)]
    fn splat(self, x: f32) -> Floats {
        Floats(op!(_mm512_set1_ps(x)))
    }
    #[inline(always)]
    fn first_four(self, [a, b, c, d]: [f32; 4]) -> Floats {
        Floats(op!(_mm512_zextps128_ps512(_mm_setr_ps(a, b, c, d))))
    }
    #[inline(always)]
    fn splat_int(self, x: i32) -> Ints {
        Ints(op!(_mm512_set1_epi32(x)))
    }
    #[inline(always)]
    fn iota(self) -> Ints {
        Ints(op!(_mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)))
    }
    #[inline(always)]
    fn first_n(self, n: usize) -> Mask {
        Mask(memory::first(n))
    }
    #[inline(always)]
    fn mul_add(self, a: Floats, b: Floats, c: Floats) -> Floats {
        Floats(op!(_mm512_fmadd_ps(a.0, b.0, c.0)))
    }
    #[inline(always)]
    fn select(self, mask: Mask, a: Floats, b: Floats) -> Floats {
        Floats(op!(_mm512_mask_blend_ps(mask.0, b.0, a.0)))
    }
    #[inline(always)]
    fn select_int(self, mask: Mask, a: Ints, b: Ints) -> Ints {
        Ints(op!(_mm512_mask_blend_epi32(mask.0, b.0, a.0)))
    }
    #[inline(always)]
    fn select_negative(self, sign: Ints, a: Floats, b: Floats) -> Floats {
        Floats(op!(_mm512_mask_blend_ps(_mm512_movepi32_mask(sign.0), b.0, a.0)))
    }

    #[inline(always)]
    fn load(self, src: &[f32]) -> Floats {
        Floats(memory::load(self, src))
    }
    #[inline(always)]
    fn store(self, dst: &mut [f32], x: Floats) {
        memory::store(self, dst, x.0);
    }
    #[inline(always)]
    fn load_int(self, src: &[i32]) -> Ints {
        Ints(memory::load_int(self, src))
    }
    #[inline(always)]
    fn store_int(self, dst: &mut [i32], x: Ints) {
        memory::store_int(self, dst, x.0);
    }
    #[inline(always)]
    fn load_partial(self, src: &[f32]) -> Floats {
        Floats(memory::load_partial(self, src))
    }
    #[inline(always)]
    fn store_partial(self, dst: &mut [f32], x: Floats) {
        memory::store_partial(self, dst, x.0);
    }
    #[inline(always)]
    fn store_int_partial(self, dst: &mut [i32], x: Ints) {
        memory::store_int_partial(self, dst, x.0);
    }
    #[inline(always)]
    fn prefetch<const LINES: usize, T>(self, memory: &[T], at: usize) {
        self.narrow.prefetch::<LINES, T>(memory, at);
    }
    #[inline(always)]
    fn load_xyz(self, src: &[[f32; 3]]) -> [Floats; 3] {
        let flat = src[..16].as_flattened();
        let a = memory::load(self, flat);
        let b = memory::load(self, &flat[16..]);
        let c = memory::load(self, &flat[32..]);
        // The first two registers hold the first ten or eleven floats of each axis, the third has the others.
        op!({
            let x = _mm512_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30, 0, 0, 0, 0, 0);
            let y = _mm512_setr_epi32(1, 4, 7, 10, 13, 16, 19, 22, 25, 28, 31, 0, 0, 0, 0, 0);
            let z = _mm512_setr_epi32(2, 5, 8, 11, 14, 17, 20, 23, 26, 29, 0, 0, 0, 0, 0, 0);
            let x_end = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 17, 20, 23, 26, 29);
            let y_end = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 18, 21, 24, 27, 30);
            let z_end = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 19, 22, 25, 28, 31);
            [
                Floats(_mm512_permutex2var_ps(_mm512_permutex2var_ps(a, x, b), x_end, c)),
                Floats(_mm512_permutex2var_ps(_mm512_permutex2var_ps(a, y, b), y_end, c)),
                Floats(_mm512_permutex2var_ps(_mm512_permutex2var_ps(a, z, b), z_end, c)),
            ]
        })
    }

    #[inline(always)]
    fn gather(self, table: &[f32], index: Ints) -> Floats {
        gathers::single(self, table, index.0)
    }
    #[inline(always)]
    fn gather_pair(self, table: &[[f32; 2]], index: Ints) -> [Floats; 2] {
        gathers::pair(self, table, index.0)
    }
    #[inline(always)]
    fn gather_quads<const N: usize>(self, block: &Block<'_, N, 4>, base: Ints) -> [[Floats; 4]; N] {
        gathers::quads(self, block, base.0)
    }
    #[inline(always)]
    fn gather_quads_at<const N: usize>(self, block: &Block<'_, N, 4>, bases: &[i32]) -> [[Floats; 4]; N] {
        gathers::quads_at(self, block, bases)
    }
    #[inline(always)]
    fn gather_quads_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: Ints) -> [[Floats; 4]; N] {
        gathers::half_quads(self, block, base.0)
    }
    #[inline(always)]
    fn oct_lookup(self, table: lobe_avx::Floats, index: Ints) -> Floats {
        // The table twice, so that only the low three bits matter.
        Floats(op!(_mm512_permutexvar_ps(index.0, _mm512_broadcast_f32x8(table.into()))))
    }
    #[inline(always)]
    fn look_up<const N: usize>(self, table: [Floats; N], index: Ints) -> Floats {
        const { assert!(N == 1 || N == 2 || N == 4, "a table in 1, 2 or 4 registers") };
        if N == 1 {
            return Floats(op!(_mm512_permutexvar_ps(index.0, table[0].0)));
        }
        let low = op!(_mm512_permutex2var_ps(table[0].0, index.0, table[1].0));
        if N == 2 {
            return Floats(low);
        }
        let high = op!(_mm512_permutex2var_ps(table[N - 2].0, index.0, table[N - 1].0));
        self.select_negative(lobe_lane::Ints::shl::<26>(index), Floats(high), Floats(low))
    }
    #[inline(always)]
    fn descend(self, node: Ints, difference: Floats) -> Ints {
        Ints(op!(_mm512_shldi_epi32::<1>(node.0, difference.bits().0)))
    }
}
