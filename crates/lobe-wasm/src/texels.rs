//! Quads in one register, octs in two.

use core::arch::wasm32::*;

use lobe_lane::{Block, Floats as _, Lanes as _, Texels};

use crate::memory::{self, Stored};
use crate::{Floats, Oct, Simd128};

impl Texels for Simd128 {
    type Quad = Floats;
    type Oct = Oct;

    methods! {
        fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 = a * b + c;
        fn quad_load(self, src: &[f32]) -> Floats = self.load(src);
        fn quad_store(self, dst: &mut [f32], x: Floats) = self.store(dst, x);
        fn quad_splat(self, x: f32) -> Floats = self.splat(x);
        fn quad_mul_add(self, a: Floats, b: Floats, c: Floats) -> Floats = a * b + c;
        fn quad_max(self, a: Floats, b: Floats) -> Floats = a.max(b);
        fn oct_load(self, src: &[f32]) -> Oct = {
            let src = &src[..8];
            Oct(self.load(src), self.load(&src[4..]))
        };
        fn oct_store(self, dst: &mut [f32], x: Oct) = {
            let dst = &mut dst[..8];
            self.store(dst, x.0);
            self.store(&mut dst[4..], x.1);
        };
        fn oct_splat(self, x: f32) -> Oct = Oct(self.splat(x), self.splat(x));
        fn oct_mul_add(self, a: Oct, b: Oct, c: Oct) -> Oct = a * b + c;
        fn oct_max(self, a: Oct, b: Oct) -> Oct = Oct(a.0.max(b.0), a.1.max(b.1));
        fn oct_halves(self, x: Oct) -> [Floats; 2] = [x.0, x.1];
        fn oct_count_le(self, knots: Oct, x: f32) -> u32 = {
            let x = f32x4_splat(x);
            let (low, high) = (i32x4_bitmask(f32x4_le(knots.0.0, x)), i32x4_bitmask(f32x4_le(knots.1.0, x)));
            (u32::from(low) | u32::from(high) << 4).trailing_ones()
        };
        fn quad_corners<const N: usize>(self, block: &Block<'_, N, 4>, base: usize) -> [Floats; N] =
            quads(self, block, base);
        fn quad_corners_half<const N: usize>(self, block: &Block<'_, N, 4, u16>, base: usize) -> [Floats; N] =
            quads(self, block, base);
        fn oct_corners<const N: usize>(self, block: &Block<'_, N, 8>, base: usize) -> [Oct; N] = octs(self, block, base);
        fn oct_corners_half<const N: usize>(self, block: &Block<'_, N, 8, u16>, base: usize) -> [Oct; N] =
            octs(self, block, base);
    }
}

#[inline(always)]
fn quads<T: Stored, const N: usize>(lanes: Simd128, block: &Block<'_, N, 4, T>, base: usize) -> [Floats; N] {
    let mut corners = [lanes.splat(0.0); N];
    let mut corner = 0;
    while corner < N {
        corners[corner] = Floats(memory::load_corner(block, base, corner, 0));
        corner += 1;
    }
    corners
}

#[inline(always)]
fn octs<T: Stored, const N: usize>(lanes: Simd128, block: &Block<'_, N, 8, T>, base: usize) -> [Oct; N] {
    let mut corners = [lanes.oct_splat(0.0); N];
    let mut corner = 0;
    while corner < N {
        let (low, high) = (memory::load_corner(block, base, corner, 0), memory::load_corner(block, base, corner, 1));
        corners[corner] = Oct(Floats(low), Floats(high));
        corner += 1;
    }
    corners
}
