//! Hardware gathers. Each is bounds-safe by itself: it clamps its indices in the register that it gathers with.
//!
//! All functions take the token, which proves the CPU's features. The hardware takes signed indices, so tables of more
//! than 2^31 entries are read lane by lane.

use core::arch::x86_64::*;

use lobe_lane::Block;

use crate::memory::{load, load_int, store_int};
use crate::{Avx512, Floats};

/// The indices, none beyond `last`; `None` if hardware indices cannot reach that far.
#[inline(always)]
fn reachable(_proof: Avx512, index: __m512i, last: usize) -> Option<__m512i> {
    let last = i32::try_from(last).ok()?;
    Some(op!(_mm512_min_epu32(index, _mm512_set1_epi32(last))))
}

/// Entry `offset` from each index, or from `last`.
#[cold]
#[inline(never)]
fn far<T: Copy>(table: &[T], index: [i32; 16], last: usize, offset: usize) -> [T; 16] {
    index.map(|index| table[(index as u32 as usize).min(last) + offset])
}

#[inline(always)]
fn lanes(proof: Avx512, x: __m512i) -> [i32; 16] {
    let mut lanes = [0; 16];
    store_int(proof, &mut lanes, x);
    lanes
}

/// `table[index]`; an index outside reads the last entry.
#[inline(always)]
pub(crate) fn single(proof: Avx512, table: &[f32], index: __m512i) -> Floats {
    let last = table.len().checked_sub(1).expect("a gather from an empty table");
    Floats(match reachable(proof, index, last) {
        // SAFETY: no index is negative or beyond the last, so each float lies in `table`; the token proves AVX-512.
        Some(index) => unsafe { _mm512_i32gather_ps::<4>(index, table.as_ptr()) },
        None => load(proof, &far(table, lanes(proof, index), last, 0)),
    })
}

/// The floats of `table[index]`; an index outside reads the last entry.
#[inline(always)]
pub(crate) fn pair(proof: Avx512, table: &[[f32; 2]], index: __m512i) -> [Floats; 2] {
    let last = table.len().checked_sub(1).expect("a gather from an empty table");
    match reachable(proof, index, last) {
        Some(index) => {
            let (at, [low, high]) = (table.as_ptr().cast(), halves(proof, index));
            // SAFETY: no index is negative or beyond the last, so each eight bytes lie in `table`; the token proves
            // AVX-512; gathers need no alignment.
            let (low, high) = unsafe { (_mm512_i32gather_pd::<8>(low, at), _mm512_i32gather_pd::<8>(high, at)) };
            unzip(proof, low, high)
        }
        None => {
            let (mut floats, pairs) = ([[0.0; 16]; 2], far(table, lanes(proof, index), last, 0));
            let mut lane = 0;
            while lane < 16 {
                [floats[0][lane], floats[1][lane]] = pairs[lane];
                lane += 1;
            }
            [Floats(load(proof, &floats[0])), Floats(load(proof, &floats[1]))]
        }
    }
}

/// The four floats at `base + offset` for each offset of the block; a base that is too large is clamped to the last
/// base.
#[inline(always)]
pub(crate) fn quads<const N: usize>(proof: Avx512, block: &Block<'_, N, 4>, base: __m512i) -> [[Floats; 4]; N] {
    let mut corners = [[Floats(op!(_mm512_setzero_ps())); 4]; N];
    let bases = reachable(proof, base, block.last_base());
    let mut corner = 0;
    while corner < N {
        let offset = block.offsets()[corner];
        corners[corner] = match bases {
            Some(bases) => {
                let [low, high] = halves(proof, bases);
                // SAFETY: the block promises `last_base + offset + 4 <= data.len()`, and no base is negative or beyond its
                // last, so each eight bytes lie in its data; the token proves AVX-512; gathers need no alignment.
                let [front, back] = unsafe {
                    let at = block.data().as_ptr().add(offset);
                    let (front, back) = (at.cast(), at.add(2).cast());
                    [
                        [_mm512_i32gather_pd::<4>(low, front), _mm512_i32gather_pd::<4>(high, front)],
                        [_mm512_i32gather_pd::<4>(low, back), _mm512_i32gather_pd::<4>(high, back)],
                    ]
                };
                let ([x, y], [z, w]) = (unzip(proof, front[0], front[1]), unzip(proof, back[0], back[1]));
                [x, y, z, w]
            }
            None => {
                let (mut floats, base) = (corners[corner], lanes(proof, base));
                let mut k = 0;
                while k < 4 {
                    floats[k] = Floats(load(proof, &far(block.data(), base, block.last_base(), offset + k)));
                    k += 1;
                }
                floats
            }
        };
        corner += 1;
    }
    corners
}

/// Like [`quads`], from bases in memory. If each has several quads, these are loaded whole and transposed.
#[inline(always)]
pub(crate) fn quads_at<const N: usize>(proof: Avx512, block: &Block<'_, N, 4>, bases: &[i32]) -> [[Floats; 4]; N] {
    if N < 3 {
        return quads(proof, block, load_int(proof, bases));
    }
    let bases = &bases[..16];
    let mut rows = [[op!(_mm512_setzero_ps()); 4]; N];
    let mut row = 0;
    while row < 4 {
        let at = [base(bases, row), base(bases, row + 4), base(bases, row + 8), base(bases, row + 12)];
        let mut corner = 0;
        while corner < N {
            let a = load_quad(proof, block, at[0], corner);
            let b = load_quad(proof, block, at[1], corner);
            let c = load_quad(proof, block, at[2], corner);
            let d = load_quad(proof, block, at[3], corner);
            rows[corner][row] = op!({
                let row = _mm512_castps128_ps512(a);
                let row = _mm512_mask_broadcast_f32x4(row, 0x00f0, b);
                let row = _mm512_mask_broadcast_f32x4(row, 0x0f00, c);
                _mm512_mask_broadcast_f32x4(row, 0xf000, d)
            });
            corner += 1;
        }
        row += 1;
    }
    let mut corners = [[Floats(op!(_mm512_setzero_ps())); 4]; N];
    let mut corner = 0;
    while corner < N {
        corners[corner] = transpose(proof, rows[corner]);
        corner += 1;
    }
    corners
}

/// One base of sixteen. The read is volatile, because compilers otherwise load all bases into a vector and extract them
/// one by one.
#[inline(always)]
fn base(bases: &[i32], lane: usize) -> usize {
    let base: *const i32 = &bases[lane];
    // SAFETY: it is an element of a slice.
    let base = unsafe { base.read_volatile() };
    base as u32 as usize
}

/// The quad at `base + offsets[corner]`, for a base that may be too large.
#[inline(always)]
fn load_quad<const N: usize>(_proof: Avx512, block: &Block<'_, N, 4>, base: usize, corner: usize) -> __m128 {
    let at = base.min(block.last_base()) + block.offsets()[corner];
    // SAFETY: the block promises `last_base + offset + 4 <= data.len()` for each of its offsets; the token proves AVX-512;
    // the load needs no alignment.
    unsafe { _mm_loadu_ps(block.data().as_ptr().add(at)) }
}

/// Like [`quads`], from half-precision floats.
#[inline(always)]
pub(crate) fn half_quads<const N: usize>(
    proof: Avx512,
    block: &Block<'_, N, 4, u16>,
    base: __m512i,
) -> [[Floats; 4]; N] {
    let mut corners = [[Floats(op!(_mm512_setzero_ps())); 4]; N];
    // Ordered so that a quarter of each row holds four neighbours after the transposition.
    let order = op!(_mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15));
    let bases = reachable(proof, op!(_mm512_permutexvar_epi32(order, base)), block.last_base());
    let mut corner = 0;
    while corner < N {
        let offset = block.offsets()[corner];
        corners[corner] = match bases {
            Some(bases) => {
                let [low, high] = halves(proof, bases);
                // SAFETY: the block promises `last_base + offset + 4 <= data.len()`, and no base is negative or beyond its
                // last, so each eight bytes lie in its data; the token proves AVX-512; gathers need no alignment.
                let [low, high] = unsafe {
                    let at = block.data().as_ptr().add(offset).cast();
                    [_mm512_i32gather_epi64::<2>(low, at), _mm512_i32gather_epi64::<2>(high, at)]
                };
                let ([a, b], [c, d]) = (halves(proof, low), halves(proof, high));
                transpose(proof, op!([_mm512_cvtph_ps(a), _mm512_cvtph_ps(b), _mm512_cvtph_ps(c), _mm512_cvtph_ps(d)]))
            }
            None => {
                let (mut floats, base) = (corners[corner], lanes(proof, base));
                let mut k = 0;
                while k < 4 {
                    let found = far(block.data(), base, block.last_base(), offset + k);
                    // SAFETY: `found` has sixteen halves; the token proves AVX-512; the load needs no alignment.
                    let halves = unsafe { _mm256_loadu_si256(found.as_ptr().cast()) };
                    floats[k] = Floats(op!(_mm512_cvtph_ps(halves)));
                    k += 1;
                }
                floats
            }
        };
        corner += 1;
    }
    corners
}

/// The lower and the upper half of a register.
#[inline(always)]
fn halves(_proof: Avx512, x: __m512i) -> [__m256i; 2] {
    op!([_mm512_castsi512_si256(x), _mm512_extracti64x4_epi64::<1>(x)])
}

/// The first and the second floats of sixteen pairs.
#[inline(always)]
fn unzip(_proof: Avx512, low: __m512d, high: __m512d) -> [Floats; 2] {
    op!({
        let (low, high) = (_mm512_castpd_ps(low), _mm512_castpd_ps(high));
        let even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
        let odd = _mm512_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
        [Floats(_mm512_permutex2var_ps(low, even, high)), Floats(_mm512_permutex2var_ps(low, odd, high))]
    })
}

/// Transposes rows to columns, in each quarter of the registers.
#[inline(always)]
fn transpose(_proof: Avx512, [a, b, c, d]: [__m512; 4]) -> [Floats; 4] {
    op!({
        let (ab_low, ab_high) = (_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b));
        let (cd_low, cd_high) = (_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d));
        [
            Floats(_mm512_shuffle_ps::<0b01_00_01_00>(ab_low, cd_low)),
            Floats(_mm512_shuffle_ps::<0b11_10_11_10>(ab_low, cd_low)),
            Floats(_mm512_shuffle_ps::<0b01_00_01_00>(ab_high, cd_high)),
            Floats(_mm512_shuffle_ps::<0b11_10_11_10>(ab_high, cd_high)),
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::far;

    #[test]
    fn far_entries_are_clamped_like_near_ones() {
        let table: [u16; 9] = core::array::from_fn(|i| i as u16);
        let index = [0, 1, 2, 3, 4, 5, 6, 7, -1, i32::MIN, i32::MAX, 5, 4, 3, 2, 1];
        let found = far(&table, index, 5, 3);
        assert_eq!(found, [3, 4, 5, 6, 7, 8, 8, 8, 8, 8, 8, 8, 7, 6, 5, 4]);
    }
}
