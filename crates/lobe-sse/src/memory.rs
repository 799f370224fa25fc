//! Every load and store of this crate. Each is bounds-safe by itself.

use core::arch::x86_64::*;

use lobe_lane::Block;

#[inline(always)]
pub(crate) fn prefetch<const LINES: usize, T>(memory: &[T], at: usize) {
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
pub(crate) fn load(src: &[f32]) -> __m128 {
    let src = &src[..4];
    // SAFETY: `src` has four floats; SSE2 is the baseline of x86_64; the load needs no alignment.
    unsafe { _mm_loadu_ps(src.as_ptr()) }
}

#[inline(always)]
pub(crate) fn store(dst: &mut [f32], x: __m128) {
    let dst = &mut dst[..4];
    // SAFETY: `dst` holds four floats; SSE2 is the baseline of x86_64; the store needs no alignment.
    unsafe { _mm_storeu_ps(dst.as_mut_ptr(), x) }
}

#[inline(always)]
pub(crate) fn load_int(src: &[i32]) -> __m128i {
    let src = &src[..4];
    // SAFETY: `src` has four integers; SSE2 is the baseline of x86_64; the load needs no alignment.
    unsafe { _mm_loadu_si128(src.as_ptr().cast()) }
}

#[inline(always)]
pub(crate) fn store_int(dst: &mut [i32], x: __m128i) {
    let dst = &mut dst[..4];
    // SAFETY: `dst` holds four integers; SSE2 is the baseline of x86_64; the store needs no alignment.
    unsafe { _mm_storeu_si128(dst.as_mut_ptr().cast(), x) }
}

/// The four integers, each as an index with negative values far outside.
#[inline(always)]
pub(crate) fn indices(x: __m128i) -> [usize; 4] {
    let mut lanes = [0; 4];
    store_int(&mut lanes, x);
    let [a, b, c, d] = lanes;
    [a as u32 as usize, b as u32 as usize, c as u32 as usize, d as u32 as usize]
}

/// Two floats of `table[index]`, in the low half of the register; an index outside reads the last entry.
#[inline(always)]
pub(crate) fn load_pair(table: &[[f32; 2]], index: usize) -> __m128 {
    let last = table.len().checked_sub(1).expect("a gather from an empty table");
    // SAFETY: `index.min(last)` is inside `table`, so eight bytes can be read there; SSE2 is the baseline; the load of eight
    // bytes needs no alignment.
    unsafe { _mm_castsi128_ps(_mm_loadl_epi64(table.as_ptr().add(index.min(last)).cast())) }
}

/// Four floats at `base + offsets[corner]`; `base` is clamped to the block's last base.
#[inline(always)]
pub(crate) fn load_corner<const N: usize, const WIDTH: usize>(
    block: &Block<'_, N, WIDTH>,
    base: usize,
    corner: usize,
    half: usize,
) -> __m128 {
    assert!(4 * half + 4 <= WIDTH);
    let at = base.min(block.last_base()) + block.offsets()[corner] + 4 * half;
    // SAFETY: the block promises `last_base + offset + WIDTH <= data.len()` for each of its offsets, and
    // `4 * half + 4 <= WIDTH`; SSE2 is the baseline; the load needs no alignment.
    unsafe { _mm_loadu_ps(block.data().as_ptr().add(at)) }
}

/// Four half-precision floats at `base + offsets[corner]`, as floats; `base` is clamped to the block's last base.
#[inline(always)]
pub(crate) fn load_half_corner<const N: usize, const WIDTH: usize>(
    block: &Block<'_, N, WIDTH, u16>,
    base: usize,
    corner: usize,
    half: usize,
) -> __m128 {
    assert!(4 * half + 4 <= WIDTH);
    let at = base.min(block.last_base()) + block.offsets()[corner] + 4 * half;
    // SAFETY: the block promises `last_base + offset + WIDTH <= data.len()` for each of its offsets, and
    // `4 * half + 4 <= WIDTH`; SSE2 is the baseline; the load of eight bytes needs no alignment.
    let halves = unsafe { _mm_loadl_epi64(block.data().as_ptr().add(at).cast()) };
    op!({
        // Exponent and mantissa are moved to their places in a float, and the difference of the exponent biases is
        // multiplied in.
        let bits = _mm_unpacklo_epi16(halves, _mm_setzero_si128());
        let magnitude = _mm_slli_epi32::<13>(_mm_and_si128(bits, _mm_set1_epi32(0x7fff)));
        let bias = _mm_castsi128_ps(_mm_set1_epi32((127 + 127 - 15) << 23));
        let sign = _mm_slli_epi32::<16>(_mm_and_si128(bits, _mm_set1_epi32(0x8000)));
        _mm_or_ps(_mm_mul_ps(_mm_castsi128_ps(magnitude), bias), _mm_castsi128_ps(sign))
    })
}
