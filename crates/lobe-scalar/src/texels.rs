//! Quads and octs: arrays of four and eight, whatever the number of lanes.

use lobe_lane::{Block, Texels};

use crate::{Floats, Scalar};

impl<const N: usize> Texels for Scalar<N> {
    type Quad = Floats<4>;
    type Oct = Floats<8>;

    #[inline(always)]
    fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        a * b + c
    }
    #[inline(always)]
    fn quad_load(self, src: &[f32]) -> Floats<4> {
        Floats([src[0], src[1], src[2], src[3]])
    }
    #[inline(always)]
    fn quad_store(self, dst: &mut [f32], x: Floats<4>) {
        dst[..4].copy_from_slice(&x.0);
    }
    #[inline(always)]
    fn quad_corners<const K: usize>(self, block: &Block<'_, K, 4>, base: usize) -> [Floats<4>; K] {
        let base = base.min(block.last_base());
        std::array::from_fn(|corner| self.quad_load(&block.data()[base + block.offsets()[corner]..]))
    }
    #[inline(always)]
    fn quad_splat(self, x: f32) -> Floats<4> {
        Floats([x; 4])
    }
    #[inline(always)]
    fn quad_mul_add(self, a: Floats<4>, b: Floats<4>, c: Floats<4>) -> Floats<4> {
        a * b + c
    }
    #[inline(always)]
    fn quad_max(self, a: Floats<4>, b: Floats<4>) -> Floats<4> {
        lobe_lane::Floats::max(a, b)
    }

    #[inline(always)]
    fn oct_load(self, src: &[f32]) -> Floats<8> {
        let src = &src[..8];
        Floats(std::array::from_fn(|i| src[i]))
    }
    #[inline(always)]
    fn oct_store(self, dst: &mut [f32], x: Floats<8>) {
        dst[..8].copy_from_slice(&x.0);
    }
    #[inline(always)]
    fn oct_splat(self, x: f32) -> Floats<8> {
        Floats([x; 8])
    }
    #[inline(always)]
    fn oct_corners<const K: usize>(self, block: &Block<'_, K, 8>, base: usize) -> [Floats<8>; K] {
        let base = base.min(block.last_base());
        std::array::from_fn(|corner| self.oct_load(&block.data()[base + block.offsets()[corner]..]))
    }
    #[inline(always)]
    fn oct_mul_add(self, a: Floats<8>, b: Floats<8>, c: Floats<8>) -> Floats<8> {
        a * b + c
    }
    #[inline(always)]
    fn oct_max(self, a: Floats<8>, b: Floats<8>) -> Floats<8> {
        lobe_lane::Floats::max(a, b)
    }
    #[inline(always)]
    fn oct_halves(self, x: Floats<8>) -> [Floats<4>; 2] {
        let [a, b, c, d, e, f, g, h] = x.0;
        [Floats([a, b, c, d]), Floats([e, f, g, h])]
    }
    #[inline(always)]
    fn oct_count_le(self, knots: Floats<8>, x: f32) -> u32 {
        knots.0.iter().map(|&knot| (knot <= x) as u32).sum()
    }
}
