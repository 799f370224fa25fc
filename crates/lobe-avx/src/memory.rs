//! Every load and store of this crate. Each is bounds-safe by itself.
//!
//! All functions take the token, which proves that the CPU has AVX and F16C.

use core::arch::x86_64::*;

use lobe_lane::Block;

use crate::Avx2;

#[inline(always)]
pub(crate) fn load8(_proof: Avx2, src: &[f32]) -> __m256 {
    let src = &src[..8];
    // SAFETY: `src` has eight floats; the token proves AVX; the load needs no alignment.
    unsafe { _mm256_loadu_ps(src.as_ptr()) }
}

#[inline(always)]
pub(crate) fn store8(_proof: Avx2, dst: &mut [f32], x: __m256) {
    let dst = &mut dst[..8];
    // SAFETY: `dst` holds eight floats; the token proves AVX; the store needs no alignment.
    unsafe { _mm256_storeu_ps(dst.as_mut_ptr(), x) }
}

#[inline(always)]
pub(crate) fn prefetch<const LINES: usize, T>(_proof: Avx2, memory: &[T], at: usize) {
    let first = memory.as_ptr().wrapping_add(at).cast::<i8>();
    let mut line = 0;
    while line < LINES {
        // SAFETY: a prefetch reads nothing that a program could see and never faults, wherever it points; every x86_64
        // has it.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(64 * line)) }
        line += 1;
    }
}

#[inline(always)]
pub(crate) fn load4(_proof: Avx2, src: &[f32]) -> __m128 {
    let src = &src[..4];
    // SAFETY: `src` has four floats; the token proves AVX; the load needs no alignment.
    unsafe { _mm_loadu_ps(src.as_ptr()) }
}

#[inline(always)]
pub(crate) fn store4(_proof: Avx2, dst: &mut [f32], x: __m128) {
    let dst = &mut dst[..4];
    // SAFETY: `dst` holds four floats; the token proves AVX; the store needs no alignment.
    unsafe { _mm_storeu_ps(dst.as_mut_ptr(), x) }
}

#[inline(always)]
pub(crate) fn load_int(_proof: Avx2, src: &[i32]) -> __m256i {
    let src = &src[..8];
    // SAFETY: `src` has eight integers; the token proves AVX; the load needs no alignment.
    unsafe { _mm256_loadu_si256(src.as_ptr().cast()) }
}

#[inline(always)]
pub(crate) fn store_int(_proof: Avx2, dst: &mut [i32], x: __m256i) {
    let dst = &mut dst[..8];
    // SAFETY: `dst` holds eight integers; the token proves AVX; the store needs no alignment.
    unsafe { _mm256_storeu_si256(dst.as_mut_ptr().cast(), x) }
}

/// The first four floats of each slice, one in each half of the register.
#[inline(always)]
pub(crate) fn load_halves(proof: Avx2, low: &[f32], high: &[f32]) -> __m256 {
    let (low, high) = (load4(proof, low), load4(proof, high));
    op!(_mm256_insertf128_ps::<1>(_mm256_castps128_ps256(low), high))
}

/// The eight integers, each as an index with negative values far outside.
#[inline(always)]
pub(crate) fn indices(proof: Avx2, x: __m256i) -> [usize; 8] {
    let mut lanes = [0; 8];
    store_int(proof, &mut lanes, x);
    indices_in(&lanes)
}

/// The same for the first eight integers in memory.
#[inline(always)]
pub(crate) fn indices_in(lanes: &[i32]) -> [usize; 8] {
    let lanes = &lanes[..8];
    let mut indices = [0; 8];
    let mut lane = 0;
    while lane < 8 {
        indices[lane] = lanes[lane] as u32 as usize;
        lane += 1;
    }
    indices
}

/// Two floats of `table[index]`, in the low half of the register; an index outside reads the last entry.
#[inline(always)]
pub(crate) fn load_pair(_proof: Avx2, table: &[[f32; 2]], index: usize) -> __m128 {
    let last = table.len().checked_sub(1).expect("a gather from an empty table");
    // SAFETY: `index.min(last)` is inside `table`, so eight bytes can be read there; the token proves AVX; the load of eight
    // bytes needs no alignment.
    unsafe { _mm_castsi128_ps(_mm_loadl_epi64(table.as_ptr().add(index.min(last)).cast())) }
}

/// Four floats at `base + offsets[corner]`; `base` is clamped to the block's last base.
#[inline(always)]
pub(crate) fn load_quad<const N: usize>(_proof: Avx2, block: &Block<'_, N, 4>, base: usize, corner: usize) -> __m128 {
    let at = base.min(block.last_base()) + block.offsets()[corner];
    // SAFETY: the block promises `last_base + offset + 4 <= data.len()` for each of its offsets; the token proves AVX;
    // the load needs no alignment.
    unsafe { _mm_loadu_ps(block.data().as_ptr().add(at)) }
}

/// Eight floats at `base + offsets[corner]`; `base` is clamped to the block's last base.
#[inline(always)]
pub(crate) fn load_oct<const N: usize>(_proof: Avx2, block: &Block<'_, N, 8>, base: usize, corner: usize) -> __m256 {
    let at = base.min(block.last_base()) + block.offsets()[corner];
    // SAFETY: the block promises `last_base + offset + 8 <= data.len()` for each of its offsets; the token proves AVX;
    // the load needs no alignment.
    unsafe { _mm256_loadu_ps(block.data().as_ptr().add(at)) }
}

/// Four half-precision floats at `base + offsets[corner]`, as floats; `base` is clamped to the block's last base.
#[inline(always)]
pub(crate) fn load_half_quad<const N: usize>(
    _proof: Avx2,
    block: &Block<'_, N, 4, u16>,
    base: usize,
    corner: usize,
) -> __m128 {
    let at = base.min(block.last_base()) + block.offsets()[corner];
    // SAFETY: the block promises `last_base + offset + 4 <= data.len()` for each of its offsets; the token proves SSE2 and
    // F16C; the load of eight bytes needs no alignment.
    unsafe { _mm_cvtph_ps(_mm_loadl_epi64(block.data().as_ptr().add(at).cast())) }
}

/// Eight half-precision floats at `base + offsets[corner]`, as floats; `base` is clamped to the block's last base.
#[inline(always)]
pub(crate) fn load_half_oct<const N: usize>(
    _proof: Avx2,
    block: &Block<'_, N, 8, u16>,
    base: usize,
    corner: usize,
) -> __m256 {
    let at = base.min(block.last_base()) + block.offsets()[corner];
    // SAFETY: the block promises `last_base + offset + 8 <= data.len()` for each of its offsets; the token proves AVX and
    // F16C; the load of sixteen bytes needs no alignment.
    unsafe { _mm256_cvtph_ps(_mm_loadu_si128(block.data().as_ptr().add(at).cast())) }
}
