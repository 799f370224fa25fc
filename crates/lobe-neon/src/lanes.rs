//! The token.

use core::arch::aarch64::*;

use lobe_lane::{Block, Kernel, Lanes};

use crate::memory::Stored;
use crate::{Floats, Ints, Mask, Neon, Oct, memory};

impl Lanes for Neon {
    type F = Floats;
    type I = Ints;
    type M = Mask;
    type Narrow = Self;

    const LANES: usize = 4;
    const NAME: &'static str = "neon";
    const FUSED: bool = true;
    // One instruction, after two that turn indices into bytes, which lookups at the same index share.
    const PERMUTES: bool = true;

    #[inline(always)]
    fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
        kernel.run(self)
    }

    methods! {
        fn narrow(self) -> Self = self;
        fn splat(self, x: f32) -> Floats = Floats(op!(vdupq_n_f32(x)));
        fn first_four(self, x: [f32; 4]) -> Floats = Floats(memory::load(&x));
        fn splat_int(self, x: i32) -> Ints = Ints(op!(vdupq_n_s32(x)));
        fn iota(self) -> Ints = Ints(memory::load_int(&[0, 1, 2, 3]));
        fn mul_add(self, a: Floats, b: Floats, c: Floats) -> Floats = Floats(op!(vfmaq_f32(c.0, a.0, b.0)));
        fn select(self, mask: Mask, a: Floats, b: Floats) -> Floats = Floats(op!(vbslq_f32(mask.0, a.0, b.0)));
        fn select_int(self, mask: Mask, a: Ints, b: Ints) -> Ints = Ints(op!(vbslq_s32(mask.0, a.0, b.0)));
        fn select_negative(self, sign: Ints, a: Floats, b: Floats) -> Floats =
            Floats(op!(vbslq_f32(vcltzq_s32(sign.0), a.0, b.0)));
        fn load(self, src: &[f32]) -> Floats = Floats(memory::load(src));
        fn store(self, dst: &mut [f32], x: Floats) = memory::store(dst, x.0);
        fn load_int(self, src: &[i32]) -> Ints = Ints(memory::load_int(src));
        fn store_int(self, dst: &mut [i32], x: Ints) = memory::store_int(dst, x.0);
        fn load_xyz(self, src: &[[f32; 3]]) -> [Floats; 3] = {
            let float32x4x3_t(x, y, z) = memory::load_xyz(src);
            [Floats(x), Floats(y), Floats(z)]
        };
        fn gather(self, table: &[f32], index: Ints) -> Floats = {
            let last = table.len().checked_sub(1).expect("a gather from an empty table");
            let [a, b, c, d] = memory::indices(index.0);
            self.first_four([table[a.min(last)], table[b.min(last)], table[c.min(last)], table[d.min(last)]])
        };
        fn gather_pair(self, table: &[[f32; 2]], index: Ints) -> [Floats; 2] = {
            let [a, b, c, d] = memory::indices(index.0);
            let (a, b) = (memory::load_pair(table, a), memory::load_pair(table, b));
            let (c, d) = (memory::load_pair(table, c), memory::load_pair(table, d));
            op!({
                let (ab, cd) = (vcombine_f32(a, b), vcombine_f32(c, d));
                [Floats(vuzp1q_f32(ab, cd)), Floats(vuzp2q_f32(ab, cd))]
            })
        };
        fn oct_lookup(self, table: Oct, index: Ints) -> Floats = op!({
            let table = uint8x16x2_t(vreinterpretq_u8_f32(table.0.0), vreinterpretq_u8_f32(table.1.0));
            let entry = vandq_u32(vreinterpretq_u32_s32(index.0), vdupq_n_u32(7));
            let bytes = vmlaq_u32(vdupq_n_u32(0x0302_0100), entry, vdupq_n_u32(0x0404_0404));
            Floats(vreinterpretq_f32_u8(vqtbl2q_u8(table, vreinterpretq_u8_u32(bytes))))
        });
        fn gather_quads<const N: usize>(self, block: &Block<'_, N, 4>, base: Ints) -> [[Floats; 4]; N] =
            gather_quads(block, base);
        fn gather_quads_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: Ints) -> [[Floats; 4]; N] =
            gather_quads(block, base);
        fn prefetch<const LINES: usize, T>(self, memory: &[T], at: usize) = memory::prefetch::<LINES, T>(memory, at);
    }
}

#[inline(always)]
fn gather_quads<T: Stored, const N: usize>(block: &Block<'_, N, 4, T>, base: Ints) -> [[Floats; 4]; N] {
    let bases = memory::indices(base.0);
    let mut corners = [[Floats(op!(vdupq_n_f32(0.0))); 4]; N];
    let mut corner = 0;
    while corner < N {
        let mut row = 0;
        while row < 4 {
            corners[corner][row] = memory::load_corner(block, bases[row], corner, 0);
            row += 1;
        }
        corners[corner] = transpose(corners[corner]);
        corner += 1;
    }
    corners
}

/// Transposes rows to columns.
#[inline(always)]
fn transpose([Floats(a), Floats(b), Floats(c), Floats(d)]: [Floats; 4]) -> [Floats; 4] {
    op!({
        let (ac_low, ac_high) = (vzip1q_f32(a, c), vzip2q_f32(a, c));
        let (bd_low, bd_high) = (vzip1q_f32(b, d), vzip2q_f32(b, d));
        [
            Floats(vzip1q_f32(ac_low, bd_low)),
            Floats(vzip2q_f32(ac_low, bd_low)),
            Floats(vzip1q_f32(ac_high, bd_high)),
            Floats(vzip2q_f32(ac_high, bd_high)),
        ]
    })
}
