//! The token of the 8-lane backend.

use core::arch::x86_64::*;

use lobe_lane::{Block, Kernel, Lanes};

use crate::{Avx2, Floats, Ints, Mask, memory};

impl Lanes for Avx2 {
    type F = Floats;
    type I = Ints;
    type M = Mask;
    type Narrow = Self;

    const LANES: usize = 8;
    const NAME: &'static str = "avx2";
    const FUSED: bool = true;
    const PERMUTES: bool = true;

    #[inline(always)]
    fn vectorize<K: Kernel>(self, kernel: K) -> K::Out {
        #[target_feature(enable = "avx2,fma,f16c,bmi1,bmi2,lzcnt,popcnt")]
        fn inner<K: Kernel>(token: Avx2, kernel: K) -> K::Out {
            kernel.run(token)
        }
        // SAFETY: the token proves these features.
        unsafe { inner(self, kernel) }
    }

    #[inline(always)]
    fn narrow(self) -> Self {
        self
    }

    #[inline(always)]
    fn splat(self, x: f32) -> Floats {
        Floats(op!(_mm256_set1_ps(x)))
    }
    #[inline(always)]
    fn first_four(self, [a, b, c, d]: [f32; 4]) -> Floats {
        Floats(op!(_mm256_zextps128_ps256(_mm_setr_ps(a, b, c, d))))
    }
    #[inline(always)]
    fn splat_int(self, x: i32) -> Ints {
        Ints(op!(_mm256_set1_epi32(x)))
    }
    #[inline(always)]
    fn iota(self) -> Ints {
        Ints(op!(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7)))
    }
    #[inline(always)]
    fn mul_add(self, a: Floats, b: Floats, c: Floats) -> Floats {
        Floats(op!(_mm256_fmadd_ps(a.0, b.0, c.0)))
    }
    #[inline(always)]
    fn select(self, mask: Mask, a: Floats, b: Floats) -> Floats {
        Floats(op!(_mm256_blendv_ps(b.0, a.0, mask.0)))
    }
    #[inline(always)]
    fn select_int(self, mask: Mask, a: Ints, b: Ints) -> Ints {
        Ints(op!(_mm256_blendv_epi8(b.0, a.0, _mm256_castps_si256(mask.0))))
    }

    #[inline(always)]
    fn select_negative(self, sign: Ints, a: Floats, b: Floats) -> Floats {
        Floats(op!(_mm256_blendv_ps(b.0, a.0, _mm256_castsi256_ps(sign.0))))
    }

    #[inline(always)]
    fn load(self, src: &[f32]) -> Floats {
        Floats(memory::load8(self, src))
    }
    #[inline(always)]
    fn store(self, dst: &mut [f32], x: Floats) {
        memory::store8(self, dst, x.0);
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
    fn prefetch<const LINES: usize, T>(self, memory: &[T], at: usize) {
        memory::prefetch::<LINES, T>(self, memory, at);
    }
    #[inline(always)]
    fn load_xyz(self, src: &[[f32; 3]]) -> [Floats; 3] {
        let flat = src[..8].as_flattened();
        // In each half: a = x0 y0 z0 x1, b = y1 z1 x2 y2, c = z2 x3 y3 z3
        let a = memory::load_halves(self, &flat[..4], &flat[12..16]);
        let b = memory::load_halves(self, &flat[4..8], &flat[16..20]);
        let c = memory::load_halves(self, &flat[8..12], &flat[20..]);
        op!({
            let x23 = _mm256_shuffle_ps::<0b01_01_10_10>(b, c);
            let y01 = _mm256_shuffle_ps::<0b00_00_01_01>(a, b);
            let y23 = _mm256_shuffle_ps::<0b10_10_11_11>(b, c);
            let z01 = _mm256_shuffle_ps::<0b01_01_10_10>(a, b);
            [
                Floats(_mm256_shuffle_ps::<0b10_00_11_00>(a, x23)),
                Floats(_mm256_shuffle_ps::<0b10_00_10_00>(y01, y23)),
                Floats(_mm256_shuffle_ps::<0b11_00_10_00>(z01, c)),
            ]
        })
    }

    // Eight scalar loads: `vgatherdps` takes 1.8 times as long on some processors.
    #[inline(always)]
    fn gather(self, table: &[f32], index: Ints) -> Floats {
        let last = table.len().checked_sub(1).expect("a gather from an empty table");
        let indices = memory::indices(self, index.0);
        let mut x = [0.0; 8];
        let mut lane = 0;
        while lane < 8 {
            x[lane] = table[indices[lane].min(last)];
            lane += 1;
        }
        Floats(op!(_mm256_setr_ps(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7])))
    }
    #[inline(always)]
    fn gather_pair(self, table: &[[f32; 2]], index: Ints) -> [Floats; 2] {
        let indices = memory::indices(self, index.0);
        let mut pairs = [op!(_mm_setzero_ps()); 8];
        let mut lane = 0;
        while lane < 8 {
            pairs[lane] = memory::load_pair(self, table, indices[lane]);
            lane += 1;
        }
        let [a, b, c, d, e, f, g, h] = pairs;
        op!({
            let (ab, cd) = (_mm_unpacklo_ps(a, b), _mm_unpacklo_ps(c, d));
            let (ef, gh) = (_mm_unpacklo_ps(e, f), _mm_unpacklo_ps(g, h));
            let abef = _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(ab), ef);
            let cdgh = _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(cd), gh);
            [
                Floats(_mm256_shuffle_ps::<0b01_00_01_00>(abef, cdgh)),
                Floats(_mm256_shuffle_ps::<0b11_10_11_10>(abef, cdgh)),
            ]
        })
    }
    #[inline(always)]
    fn gather_quads<const N: usize>(self, block: &Block<'_, N, 4>, base: Ints) -> [[Floats; 4]; N] {
        quads(self, block, memory::indices(self, base.0))
    }
    #[inline(always)]
    fn gather_quads_at<const N: usize>(self, block: &Block<'_, N, 4>, bases: &[i32]) -> [[Floats; 4]; N] {
        quads(self, block, memory::indices_in(bases))
    }
    #[inline(always)]
    fn gather_quads_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: Ints) -> [[Floats; 4]; N] {
        let bases = memory::indices(self, base.0);
        let mut corners = [[self.splat(0.0); 4]; N];
        let mut corner = 0;
        while corner < N {
            let mut rows = [self.splat(0.0); 4];
            let mut row = 0;
            while row < 4 {
                let low = memory::load_half_quad(self, block, bases[row], corner);
                let high = memory::load_half_quad(self, block, bases[row + 4], corner);
                rows[row] = Floats(op!(_mm256_insertf128_ps::<1>(_mm256_castps128_ps256(low), high)));
                row += 1;
            }
            corners[corner] = transpose(rows);
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn oct_lookup(self, table: Floats, index: Ints) -> Floats {
        Floats(op!(_mm256_permutevar8x32_ps(table.0, index.0)))
    }
}

/// The quads at eight bases, as columns.
#[inline(always)]
fn quads<const N: usize>(token: Avx2, block: &Block<'_, N, 4>, bases: [usize; 8]) -> [[Floats; 4]; N] {
    let mut corners = [[token.splat(0.0); 4]; N];
    let mut corner = 0;
    while corner < N {
        let mut rows = [token.splat(0.0); 4];
        let mut row = 0;
        while row < 4 {
            let low = memory::load_quad(token, block, bases[row], corner);
            let high = memory::load_quad(token, block, bases[row + 4], corner);
            rows[row] = Floats(op!(_mm256_insertf128_ps::<1>(_mm256_castps128_ps256(low), high)));
            row += 1;
        }
        corners[corner] = transpose(rows);
        corner += 1;
    }
    corners
}

/// Transposes rows to columns, in each half of the registers.
#[inline(always)]
fn transpose([Floats(a), Floats(b), Floats(c), Floats(d)]: [Floats; 4]) -> [Floats; 4] {
    op!({
        let (ab_low, ab_high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        let (cd_low, cd_high) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
        [
            Floats(_mm256_shuffle_ps::<0b01_00_01_00>(ab_low, cd_low)),
            Floats(_mm256_shuffle_ps::<0b11_10_11_10>(ab_low, cd_low)),
            Floats(_mm256_shuffle_ps::<0b01_00_01_00>(ab_high, cd_high)),
            Floats(_mm256_shuffle_ps::<0b11_10_11_10>(ab_high, cd_high)),
        ]
    })
}
