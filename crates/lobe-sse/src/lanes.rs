//! The token of a 4-lane backend.

use core::arch::x86_64::*;

use lobe_lane::{Block, Kernel, Lanes};

use crate::values::{floats, ints};
use crate::{Floats, Ints, Level, Mask, Oct, Sse, memory};

impl<V: Level> Lanes for Sse<V> {
    type F = Floats<V>;
    type I = Ints<V>;
    type M = Mask<V>;
    type Narrow = Self;

    const LANES: usize = 4;
    const NAME: &'static str = V::NAME;
    const FUSED: bool = false;
    const PERMUTES: bool = false;

    #[inline(always)]
    fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
        V::enter(self, kernel)
    }

    #[inline(always)]
    fn narrow(self) -> Self {
        self
    }

    #[inline(always)]
    fn splat(self, x: f32) -> Floats<V> {
        floats(op!(_mm_set1_ps(x)))
    }
    #[inline(always)]
    fn first_four(self, [a, b, c, d]: [f32; 4]) -> Floats<V> {
        floats(op!(_mm_setr_ps(a, b, c, d)))
    }
    #[inline(always)]
    fn splat_int(self, x: i32) -> Ints<V> {
        ints(op!(_mm_set1_epi32(x)))
    }
    #[inline(always)]
    fn iota(self) -> Ints<V> {
        ints(op!(_mm_setr_epi32(0, 1, 2, 3)))
    }
    #[inline(always)]
    fn mul_add(self, a: Floats<V>, b: Floats<V>, c: Floats<V>) -> Floats<V> {
        a * b + c
    }
    #[inline(always)]
    fn select(self, mask: Mask<V>, a: Floats<V>, b: Floats<V>) -> Floats<V> {
        floats(V::select(self, mask.0, a.0, b.0))
    }
    #[inline(always)]
    fn select_int(self, mask: Mask<V>, a: Ints<V>, b: Ints<V>) -> Ints<V> {
        ints(op!(_mm_castps_si128(V::select(self, mask.0, _mm_castsi128_ps(a.0), _mm_castsi128_ps(b.0)))))
    }

    #[inline(always)]
    fn select_negative(self, sign: Ints<V>, a: Floats<V>, b: Floats<V>) -> Floats<V> {
        floats(V::select_negative(self, op!(_mm_castsi128_ps(sign.0)), a.0, b.0))
    }

    #[inline(always)]
    fn load(self, src: &[f32]) -> Floats<V> {
        floats(memory::load(src))
    }
    #[inline(always)]
    fn store(self, dst: &mut [f32], x: Floats<V>) {
        memory::store(dst, x.0);
    }
    #[inline(always)]
    fn load_int(self, src: &[i32]) -> Ints<V> {
        ints(memory::load_int(src))
    }
    #[inline(always)]
    fn store_int(self, dst: &mut [i32], x: Ints<V>) {
        memory::store_int(dst, x.0);
    }
    #[inline(always)]
    fn prefetch<const LINES: usize, T>(self, memory: &[T], at: usize) {
        memory::prefetch::<LINES, T>(memory, at);
    }
    #[inline(always)]
    fn load_xyz(self, src: &[[f32; 3]]) -> [Floats<V>; 3] {
        let flat = src[..4].as_flattened();
        // a = x0 y0 z0 x1, b = y1 z1 x2 y2, c = z2 x3 y3 z3
        let (a, b, c) = (memory::load(flat), memory::load(&flat[4..]), memory::load(&flat[8..]));
        op!({
            let x23 = _mm_shuffle_ps::<0b01_01_10_10>(b, c);
            let y01 = _mm_shuffle_ps::<0b00_00_01_01>(a, b);
            let y23 = _mm_shuffle_ps::<0b10_10_11_11>(b, c);
            let z01 = _mm_shuffle_ps::<0b01_01_10_10>(a, b);
            [
                floats(_mm_shuffle_ps::<0b10_00_11_00>(a, x23)),
                floats(_mm_shuffle_ps::<0b10_00_10_00>(y01, y23)),
                floats(_mm_shuffle_ps::<0b11_00_10_00>(z01, c)),
            ]
        })
    }

    #[inline(always)]
    fn gather(self, table: &[f32], index: Ints<V>) -> Floats<V> {
        let last = table.len().checked_sub(1).expect("a gather from an empty table");
        let [a, b, c, d] = memory::indices(index.0);
        floats(op!(_mm_setr_ps(table[a.min(last)], table[b.min(last)], table[c.min(last)], table[d.min(last)])))
    }
    #[inline(always)]
    fn gather_pair(self, table: &[[f32; 2]], index: Ints<V>) -> [Floats<V>; 2] {
        let [a, b, c, d] = memory::indices(index.0);
        let (a, b) = (memory::load_pair(table, a), memory::load_pair(table, b));
        let (c, d) = (memory::load_pair(table, c), memory::load_pair(table, d));
        op!({
            let (ab, cd) = (_mm_unpacklo_ps(a, b), _mm_unpacklo_ps(c, d));
            [floats(_mm_movelh_ps(ab, cd)), floats(_mm_movehl_ps(cd, ab))]
        })
    }
    #[inline(always)]
    fn gather_quads<const N: usize>(self, block: &Block<'_, N, 4>, base: Ints<V>) -> [[Floats<V>; 4]; N] {
        let bases = memory::indices(base.0);
        let mut corners = [[self.splat(0.0); 4]; N];
        let mut corner = 0;
        while corner < N {
            let mut rows = [self.splat(0.0); 4];
            let mut row = 0;
            while row < 4 {
                rows[row] = floats(memory::load_corner(block, bases[row], corner, 0));
                row += 1;
            }
            corners[corner] = transpose(rows);
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn gather_quads_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: Ints<V>) -> [[Floats<V>; 4]; N] {
        let bases = memory::indices(base.0);
        let mut corners = [[self.splat(0.0); 4]; N];
        let mut corner = 0;
        while corner < N {
            let mut rows = [self.splat(0.0); 4];
            let mut row = 0;
            while row < 4 {
                rows[row] = floats(memory::load_half_corner(block, bases[row], corner, 0));
                row += 1;
            }
            corners[corner] = transpose(rows);
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn oct_lookup(self, table: Oct<V>, index: Ints<V>) -> Floats<V> {
        let mut buffer = [0.0; 8];
        memory::store(&mut buffer, table.0.0);
        memory::store(&mut buffer[4..], table.1.0);
        let [a, b, c, d] = memory::indices(index.0);
        floats(op!(_mm_setr_ps(buffer[a & 7], buffer[b & 7], buffer[c & 7], buffer[d & 7])))
    }
}

/// Transposes rows to columns.
#[inline(always)]
fn transpose<V: Level>([a, b, c, d]: [Floats<V>; 4]) -> [Floats<V>; 4] {
    let (a, b, c, d) = (a.0, b.0, c.0, d.0);
    op!({
        let (ab_low, ab_high) = (_mm_unpacklo_ps(a, b), _mm_unpackhi_ps(a, b));
        let (cd_low, cd_high) = (_mm_unpacklo_ps(c, d), _mm_unpackhi_ps(c, d));
        [
            floats(_mm_movelh_ps(ab_low, cd_low)),
            floats(_mm_movehl_ps(cd_low, ab_low)),
            floats(_mm_movelh_ps(ab_high, cd_high)),
            floats(_mm_movehl_ps(cd_high, ab_high)),
        ]
    })
}
