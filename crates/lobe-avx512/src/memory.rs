//! Every load, store and gather of this crate. Each is bounds-safe by itself.
//!
//! All functions take the token, which proves the CPU's features.

use core::arch::x86_64::*;

use crate::Avx512;

#[inline(always)]
pub(crate) fn load(_proof: Avx512, src: &[f32]) -> __m512 {
    let src = &src[..16];
    // SAFETY: `src` has sixteen floats; the token proves AVX-512; the load needs no alignment.
    unsafe { _mm512_loadu_ps(src.as_ptr()) }
}

#[inline(always)]
pub(crate) fn store(_proof: Avx512, dst: &mut [f32], x: __m512) {
    let dst = &mut dst[..16];
    // SAFETY: `dst` holds sixteen floats; the token proves AVX-512; the store needs no alignment.
    unsafe { _mm512_storeu_ps(dst.as_mut_ptr(), x) }
}

#[inline(always)]
pub(crate) fn load_int(_proof: Avx512, src: &[i32]) -> __m512i {
    let src = &src[..16];
    // SAFETY: `src` has sixteen integers; the token proves AVX-512; the load needs no alignment.
    unsafe { _mm512_loadu_si512(src.as_ptr().cast()) }
}

#[inline(always)]
pub(crate) fn store_int(_proof: Avx512, dst: &mut [i32], x: __m512i) {
    let dst = &mut dst[..16];
    // SAFETY: `dst` holds sixteen integers; the token proves AVX-512; the store needs no alignment.
    unsafe { _mm512_storeu_si512(dst.as_mut_ptr().cast(), x) }
}

/// The mask of the first `n` lanes.
#[inline(always)]
pub(crate) fn first(n: usize) -> __mmask16 {
    if n < 16 { (1 << n) - 1 } else { u16::MAX }
}

/// As many floats as `src` has, followed by zeros.
#[inline(always)]
pub(crate) fn load_partial(_proof: Avx512, src: &[f32]) -> __m512 {
    // SAFETY: the mask leaves out the lanes beyond `src`, which are not read; the token proves AVX-512.
    unsafe { _mm512_maskz_loadu_ps(first(src.len()), src.as_ptr()) }
}

/// Writes as many floats as fit.
#[inline(always)]
pub(crate) fn store_partial(_proof: Avx512, dst: &mut [f32], x: __m512) {
    // SAFETY: the mask leaves out the lanes beyond `dst`, which are not written; the token proves AVX-512.
    unsafe { _mm512_mask_storeu_ps(dst.as_mut_ptr(), first(dst.len()), x) }
}

/// Writes as many integers as fit.
#[inline(always)]
pub(crate) fn store_int_partial(_proof: Avx512, dst: &mut [i32], x: __m512i) {
    // SAFETY: the mask leaves out the lanes beyond `dst`, which are not written; the token proves AVX-512.
    unsafe { _mm512_mask_storeu_epi32(dst.as_mut_ptr(), first(dst.len()), x) }
}
