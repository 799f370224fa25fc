//! Quads in one register, octs in two.

use core::arch::aarch64::*;

use lobe_lane::{Block, Floats as _, Lanes as _, Texels};

use crate::memory::{self, Stored};
use crate::{Floats, Neon, Oct};

impl Texels for Neon {
    type Quad = Floats;
    type Oct = Oct;

    methods! {
        fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 = std::primitive::f32::mul_add(a, b, c);
        fn quad_load(self, src: &[f32]) -> Floats = self.load(src);
        fn quad_store(self, dst: &mut [f32], x: Floats) = self.store(dst, x);
        fn quad_splat(self, x: f32) -> Floats = self.splat(x);
        fn quad_mul_add(self, a: Floats, b: Floats, c: Floats) -> Floats = self.mul_add(a, b, c);
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
        fn oct_mul_add(self, a: Oct, b: Oct, c: Oct) -> Oct =
            Oct(self.mul_add(a.0, b.0, c.0), self.mul_add(a.1, b.1, c.1));
        fn oct_max(self, a: Oct, b: Oct) -> Oct = Oct(a.0.max(b.0), a.1.max(b.1));
        fn oct_halves(self, x: Oct) -> [Floats; 2] = [x.0, x.1];
        // A byte for each truth value.
        fn oct_count_le(self, knots: Oct, x: f32) -> u32 = op!({
            let x = vdupq_n_f32(x);
            let (low, high) = (vcleq_f32(knots.0.0, x), vcleq_f32(knots.1.0, x));
            let bytes = vmovn_u16(vcombine_u16(vmovn_u32(low), vmovn_u32(high)));
            vget_lane_u64::<0>(vreinterpret_u64_u8(bytes)).trailing_ones() / 8
        });
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
fn quads<T: Stored, const N: usize>(lanes: Neon, block: &Block<'_, N, 4, T>, base: usize) -> [Floats; N] {
    let mut corners = [lanes.splat(0.0); N];
    let mut corner = 0;
    while corner < N {
        corners[corner] = memory::load_corner(block, base, corner, 0);
        corner += 1;
    }
    corners
}

#[inline(always)]
fn octs<T: Stored, const N: usize>(lanes: Neon, block: &Block<'_, N, 8, T>, base: usize) -> [Oct; N] {
    let mut corners = [lanes.oct_splat(0.0); N];
    let mut corner = 0;
    while corner < N {
        corners[corner] = Oct(memory::load_corner(block, base, corner, 0), memory::load_corner(block, base, corner, 1));
        corner += 1;
    }
    corners
}
