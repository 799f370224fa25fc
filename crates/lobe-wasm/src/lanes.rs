//! The token.

use core::arch::wasm32::*;

use lobe_lane::{Block, Kernel, Lanes};

use crate::memory::Stored;
use crate::{Floats, Ints, Mask, Oct, Simd128, memory};

impl Lanes for Simd128 {
    type F = Floats;
    type I = Ints;
    type M = Mask;
    type Narrow = Self;

    const LANES: usize = 4;
    const NAME: &'static str = "simd128";
    const FUSED: bool = false;
    const PERMUTES: bool = false;

    #[inline(always)]
    fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
        kernel.run(self)
    }

    methods! {
        fn narrow(self) -> Self = self;
        fn splat(self, x: f32) -> Floats = Floats(f32x4_splat(x));
        fn first_four(self, x: [f32; 4]) -> Floats = Floats(memory::load(&x));
        fn splat_int(self, x: i32) -> Ints = Ints(i32x4_splat(x));
        fn iota(self) -> Ints = Ints(i32x4(0, 1, 2, 3));
        fn mul_add(self, a: Floats, b: Floats, c: Floats) -> Floats = a * b + c;
        fn select(self, mask: Mask, a: Floats, b: Floats) -> Floats = Floats(v128_bitselect(a.0, b.0, mask.0));
        fn select_int(self, mask: Mask, a: Ints, b: Ints) -> Ints = Ints(v128_bitselect(a.0, b.0, mask.0));
        fn select_negative(self, sign: Ints, a: Floats, b: Floats) -> Floats =
            Floats(v128_bitselect(a.0, b.0, i32x4_shr(sign.0, 31)));
        fn load(self, src: &[f32]) -> Floats = Floats(memory::load(src));
        fn store(self, dst: &mut [f32], x: Floats) = memory::store(dst, x.0);
        fn load_int(self, src: &[i32]) -> Ints = Ints(memory::load(src));
        fn store_int(self, dst: &mut [i32], x: Ints) = memory::store_int(dst, x.0);
        fn load_xyz(self, src: &[[f32; 3]]) -> [Floats; 3] = {
            let flat = src[..4].as_flattened();
            // a = x0 y0 z0 x1, b = y1 z1 x2 y2, c = z2 x3 y3 z3
            let (a, b, c) = (memory::load(flat), memory::load(&flat[4..]), memory::load(&flat[8..]));
            let (x01, x23) = (i32x4_shuffle::<0, 3, 0, 3>(a, b), i32x4_shuffle::<2, 5, 2, 5>(b, c));
            let (y01, y23) = (i32x4_shuffle::<1, 4, 1, 4>(a, b), i32x4_shuffle::<3, 6, 3, 6>(b, c));
            let z01 = i32x4_shuffle::<2, 5, 2, 5>(a, b);
            [
                Floats(i32x4_shuffle::<0, 1, 4, 5>(x01, x23)),
                Floats(i32x4_shuffle::<0, 1, 4, 5>(y01, y23)),
                Floats(i32x4_shuffle::<0, 1, 4, 7>(z01, c)),
            ]
        };
        fn gather(self, table: &[f32], index: Ints) -> Floats = Floats(memory::gather(table, index.0));
        fn gather_pair(self, table: &[[f32; 2]], index: Ints) -> [Floats; 2] = {
            let [a, b, c, d] = memory::load_pairs(table, index.0);
            let (ab, cd) = (i32x4_shuffle::<0, 4, 1, 5>(a, b), i32x4_shuffle::<0, 4, 1, 5>(c, d));
            [Floats(i64x2_shuffle::<0, 2>(ab, cd)), Floats(i64x2_shuffle::<1, 3>(ab, cd))]
        };
        // A byte outside a table becomes 0, so each of the two lookups is 0 where the other one is not.
        fn oct_lookup(self, table: Oct, index: Ints) -> Floats = {
            let entry = i32x4_mul(v128_and(index.0, i32x4_splat(7)), i32x4_splat(0x0404_0404));
            let bytes = v128_or(entry, i32x4_splat(0x0302_0100));
            let beyond = i8x16_sub(bytes, i8x16_splat(16));
            Floats(v128_or(i8x16_swizzle(table.0.0, bytes), i8x16_swizzle(table.1.0, beyond)))
        };
        fn gather_quads<const N: usize>(self, block: &Block<'_, N, 4>, base: Ints) -> [[Floats; 4]; N] =
            gather_quads(block, base);
        fn gather_quads_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: Ints) -> [[Floats; 4]; N] =
            gather_quads(block, base);
    }
}

#[inline(always)]
fn gather_quads<T: Stored, const N: usize>(block: &Block<'_, N, 4, T>, base: Ints) -> [[Floats; 4]; N] {
    let mut corners = [[Floats(f32x4_splat(0.0)); 4]; N];
    let mut corner = 0;
    while corner < N {
        let [a, b, c, d] = memory::load_rows(block, base.0, corner);
        corners[corner] = transpose([Floats(a), Floats(b), Floats(c), Floats(d)]);
        corner += 1;
    }
    corners
}

/// Transposes rows to columns.
#[inline(always)]
fn transpose([Floats(a), Floats(b), Floats(c), Floats(d)]: [Floats; 4]) -> [Floats; 4] {
    let (ab_low, ab_high) = (i32x4_shuffle::<0, 4, 1, 5>(a, b), i32x4_shuffle::<2, 6, 3, 7>(a, b));
    let (cd_low, cd_high) = (i32x4_shuffle::<0, 4, 1, 5>(c, d), i32x4_shuffle::<2, 6, 3, 7>(c, d));
    [
        Floats(i64x2_shuffle::<0, 2>(ab_low, cd_low)),
        Floats(i64x2_shuffle::<1, 3>(ab_low, cd_low)),
        Floats(i64x2_shuffle::<0, 2>(ab_high, cd_high)),
        Floats(i64x2_shuffle::<1, 3>(ab_high, cd_high)),
    ]
}
