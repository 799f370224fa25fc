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

/// The four integers as indices, of which those outside, negative ones too, are `last`. They are clamped in one
/// instruction, where four indices would take four comparisons; an index of wasm32 has as many bits as a lane.
#[inline(always)]
fn clamped(x: v128, last: usize) -> [usize; 4] {
    let x = u32x4_min(x, u32x4_splat(last as u32));
    let (a, b) = (u32x4_extract_lane::<0>(x), u32x4_extract_lane::<1>(x));
    let (c, d) = (u32x4_extract_lane::<2>(x), u32x4_extract_lane::<3>(x));
    [a as usize, b as usize, c as usize, d as usize]
}

/// `table[index]` of four indices; one outside reads the last entry.
#[inline(always)]
pub(crate) fn gather(table: &[f32], index: v128) -> v128 {
    let [a, b, c, d] = clamped(index, table.len().checked_sub(1).expect("a gather from an empty table"));
    let start: *const u32 = table.as_ptr().cast();
    // SAFETY: `clamped` returns no index beyond the last entry; each has four bytes, and the loads need no alignment.
    unsafe {
        let first = v128_load32_zero(start.add(a));
        let second = v128_load32_lane::<1>(first, start.add(b));
        let third = v128_load32_lane::<2>(second, start.add(c));
        v128_load32_lane::<3>(third, start.add(d))
    }
}

/// The two floats of `table[index]` of four indices, each in the low half of a register; an index outside reads the
/// last entry.
#[inline(always)]
pub(crate) fn load_pairs(table: &[[f32; 2]], index: v128) -> [v128; 4] {
    let [a, b, c, d] = clamped(index, table.len().checked_sub(1).expect("a gather from an empty table"));
    let start = table.as_ptr();
    // SAFETY: `clamped` returns no index beyond the last entry; each has eight bytes, and the loads need no alignment.
    unsafe {
        [
            v128_load64_zero(start.add(a).cast()),
            v128_load64_zero(start.add(b).cast()),
            v128_load64_zero(start.add(c).cast()),
            v128_load64_zero(start.add(d).cast()),
        ]
    }
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

/// Four floats at `base + offsets[corner]` for each of four bases, which are clamped to the block's last one.
#[inline(always)]
pub(crate) fn load_rows<T: Stored, const N: usize>(block: &Block<'_, N, 4, T>, base: v128, corner: usize) -> [v128; 4] {
    let [a, b, c, d] = clamped(base, block.last_base());
    let start = block.data().as_ptr();
    let offset = block.offsets()[corner];
    // SAFETY: the block promises `last_base + offset + 4 <= data.len()` for each of its offsets, and `clamped` returns no base
    // beyond the last one; an array is aligned as its elements.
    unsafe {
        [
            T::load(&*start.add(a + offset).cast()),
            T::load(&*start.add(b + offset).cast()),
            T::load(&*start.add(c + offset).cast()),
            T::load(&*start.add(d + offset).cast()),
        ]
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
