//! Every load and store of this crate. Each is bounds-safe by itself.

use core::arch::aarch64::*;

use lobe_lane::Block;

use crate::Floats;

macro_rules! accesses {
    ($($load:ident $store:ident $element:ty, $register:ty, $from:ident, $to:ident;)*) => {$(
        #[inline(always)]
        pub(crate) fn $load(src: &[$element]) -> $register {
            let src = &src[..4];
            // SAFETY: `src` has four elements; the target has NEON; the load needs no more alignment than they have.
            unsafe { $from(src.as_ptr()) }
        }

        #[inline(always)]
        pub(crate) fn $store(dst: &mut [$element], x: $register) {
            let dst = &mut dst[..4];
            // SAFETY: `dst` has four elements; the target has NEON; the store needs no more alignment than they have.
            unsafe { $to(dst.as_mut_ptr(), x) }
        }
    )*};
}

accesses! {
    load store f32, float32x4_t, vld1q_f32, vst1q_f32;
    load_int store_int i32, int32x4_t, vld1q_s32, vst1q_s32;
}

/// The columns of four vectors.
#[inline(always)]
pub(crate) fn load_xyz(src: &[[f32; 3]]) -> float32x4x3_t {
    let src = &src[..4];
    // SAFETY: `src` has twelve floats; the target has NEON; the load needs no more alignment than floats have.
    unsafe { vld3q_f32(src.as_ptr().cast()) }
}

#[inline(always)]
pub(crate) fn prefetch<const LINES: usize, T>(memory: &[T], at: usize) {
    let first = memory.as_ptr().wrapping_add(at).cast::<u8>();
    let mut line = 0;
    while line < LINES {
        let address = first.wrapping_add(64 * line);
        // SAFETY: a prefetch reads nothing that a program could see and never faults, wherever it points.
        unsafe {
            core::arch::asm!("prfm pldl1keep, [{}]", in(reg) address, options(nostack, readonly, preserves_flags))
        }
        line += 1;
    }
}

/// The four integers, each as an index with negative values far outside.
#[inline(always)]
pub(crate) fn indices(x: int32x4_t) -> [usize; 4] {
    let mut lanes = [0; 4];
    store_int(&mut lanes, x);
    let [a, b, c, d] = lanes;
    [a as u32 as usize, b as u32 as usize, c as u32 as usize, d as u32 as usize]
}

/// The two floats of `table[index]`; an index outside reads the last entry.
#[inline(always)]
pub(crate) fn load_pair(table: &[[f32; 2]], index: usize) -> float32x2_t {
    let last = table.len().checked_sub(1).expect("a gather from an empty table");
    let pair = &table[index.min(last)];
    // SAFETY: `pair` has two floats; the target has NEON; the load needs no more alignment than floats have.
    unsafe { vld1_f32(pair.as_ptr()) }
}

/// A storage format of floats.
pub(crate) trait Stored: Sized {
    /// Four of them, as floats.
    fn load(four: &[Self; 4]) -> Floats;
}

impl Stored for f32 {
    #[inline(always)]
    fn load(four: &[f32; 4]) -> Floats {
        Floats(load(four))
    }
}

/// Half-precision floats.
impl Stored for u16 {
    #[inline(always)]
    fn load(four: &[u16; 4]) -> Floats {
        // SAFETY: `four` has four halves; the target has NEON; the load needs no more alignment than halves have.
        unsafe { Floats(vcvt_f32_f16(vreinterpret_f16_u16(vld1_u16(four.as_ptr())))) }
    }
}

/// Four floats at `base + offsets[corner]`, or following those; `base` is clamped to the block's last base.
#[inline(always)]
pub(crate) fn load_corner<T: Stored, const N: usize, const WIDTH: usize>(
    block: &Block<'_, N, WIDTH, T>,
    base: usize,
    corner: usize,
    half: usize,
) -> Floats {
    assert!(4 * half + 4 <= WIDTH);
    let at = base.min(block.last_base()) + block.offsets()[corner] + 4 * half;
    // SAFETY: the block promises `last_base + offset + WIDTH <= data.len()` for each of its offsets, and
    // `4 * half + 4 <= WIDTH`; an array is aligned as its elements.
    T::load(unsafe { &*block.data().as_ptr().add(at).cast() })
}
