//! Every load and store of this crate. Each is bounds-safe by itself.

use core::arch::wasm32::*;

use lobe_lane::Block;

/// The first four elements: floats or integers.
#[inline(always)]
pub(crate) fn load<T: Stored>(src: &[T]) -> v128 {
    let (four, _) = src[..4].as_chunks::<4>();
    T::load(&four[0])
}

#[inline(always)]
pub(crate) fn store(dst: &mut [f32], x: v128) {
    let dst = &mut dst[..4];
    // SAFETY: `dst` holds four floats; the store needs no alignment.
    unsafe { v128_store(dst.as_mut_ptr().cast(), x) }
}

#[inline(always)]
pub(crate) fn store_int(dst: &mut [i32], x: v128) {
    let dst = &mut dst[..4];
    // SAFETY: `dst` holds four integers; the store needs no alignment.
    unsafe { v128_store(dst.as_mut_ptr().cast(), x) }
}

/// The four integers, each as an index with negative values far outside.
#[inline(always)]
pub(crate) fn indices(x: v128) -> [usize; 4] {
    let (a, b) = (u32x4_extract_lane::<0>(x), u32x4_extract_lane::<1>(x));
    let (c, d) = (u32x4_extract_lane::<2>(x), u32x4_extract_lane::<3>(x));
    [a as usize, b as usize, c as usize, d as usize]
}

/// The two floats of `table[index]`, in the low half of the register; an index outside reads the last entry.
#[inline(always)]
pub(crate) fn load_pair(table: &[[f32; 2]], index: usize) -> v128 {
    let last = table.len().checked_sub(1).expect("a gather from an empty table");
    let pair = &table[index.min(last)];
    // SAFETY: `pair` has eight bytes; the load needs no alignment.
    unsafe { v128_load64_zero(pair.as_ptr().cast()) }
}

/// A storage format that loads read.
pub(crate) trait Stored: Sized {
    /// Loads four of them; half-precision floats become floats.
    fn load(four: &[Self; 4]) -> v128;
}

impl Stored for f32 {
    #[inline(always)]
    fn load(four: &[f32; 4]) -> v128 {
        // SAFETY: `four` has sixteen bytes; the load needs no alignment.
        unsafe { v128_load(four.as_ptr().cast()) }
    }
}

impl Stored for i32 {
    #[inline(always)]
    fn load(four: &[i32; 4]) -> v128 {
        // SAFETY: `four` has sixteen bytes; the load needs no alignment.
        unsafe { v128_load(four.as_ptr().cast()) }
    }
}

/// Half-precision floats.
impl Stored for u16 {
    #[inline(always)]
    fn load(four: &[u16; 4]) -> v128 {
        // SAFETY: `four` has eight bytes; the load needs no alignment.
        let bits = unsafe { u32x4_load_extend_u16x4(four.as_ptr()) };
        // Exponent and mantissa are moved to their places in a float, and the difference of the exponent biases is
        // multiplied in.
        let magnitude = i32x4_shl(v128_and(bits, i32x4_splat(0x7fff)), 13);
        let sign = i32x4_shl(v128_and(bits, i32x4_splat(0x8000)), 16);
        v128_or(f32x4_mul(magnitude, i32x4_splat((127 + 127 - 15) << 23)), sign)
    }
}

/// Four floats at `base + offsets[corner]`, or following those; `base` is clamped to the block's last base.
#[inline(always)]
pub(crate) fn load_corner<T: Stored, const N: usize, const WIDTH: usize>(
    block: &Block<'_, N, WIDTH, T>,
    base: usize,
    corner: usize,
    half: usize,
) -> v128 {
    assert!(4 * half + 4 <= WIDTH);
    let at = base.min(block.last_base()) + block.offsets()[corner] + 4 * half;
    // SAFETY: the block promises `last_base + offset + WIDTH <= data.len()` for each of its offsets, and
    // `4 * half + 4 <= WIDTH`; an array is aligned as its elements.
    T::load(unsafe { &*block.data().as_ptr().add(at).cast() })
}
