//! Quads and octs: arrays of four and eight, whatever the number of lanes.

use std::ops::{Add, Mul, Sub};

use lobe_lane::{Block, Texels};

use crate::Scalar;

/// Four or eight floats.
#[derive(Clone, Copy, Debug)]
pub struct Texel<const K: usize>(pub(crate) [f32; K]);

impl<const K: usize> Texel<K> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Texel(std::array::from_fn(
            #[inline(always)]
            |i| f(self.0[i], other.0[i]),
        ))
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident |$x:ident, $y:ident| $f:expr;)*) => {
        $(impl<const K: usize> $trait for Texel<K> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(
                    other,
                    #[inline(always)]
                    |$x, $y| $f,
                )
            }
        })*
    };
}

operators! { Add add |x, y| x + y; Sub sub |x, y| x - y; Mul mul |x, y| x * y; }

impl<const N: usize> Texels for Scalar<N> {
    type Quad = Texel<4>;
    type Oct = Texel<8>;

    #[inline(always)]
    fn scalar_mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        a * b + c
    }
    #[inline(always)]
    fn quad_load(self, src: &[f32]) -> Texel<4> {
        Texel([src[0], src[1], src[2], src[3]])
    }
    #[inline(always)]
    fn quad_store(self, dst: &mut [f32], x: Texel<4>) {
        dst[..4].copy_from_slice(&x.0);
    }
    #[inline(always)]
    fn quad_corners<const K: usize>(self, block: &Block<'_, K, 4>, base: usize) -> [Texel<4>; K] {
        let base = base.min(block.last_base());
        std::array::from_fn(|corner| self.quad_load(&block.data()[base + block.offsets()[corner]..]))
    }
    #[inline(always)]
    fn quad_corners_half<const K: usize>(self, block: &Block<'_, K, 4, u16>, base: usize) -> [Texel<4>; K] {
        let base = base.min(block.last_base());
        std::array::from_fn(|corner| {
            let texel = &block.data()[base + block.offsets()[corner]..][..4];
            Texel(std::array::from_fn(|i| from_half(texel[i])))
        })
    }
    #[inline(always)]
    fn quad_splat(self, x: f32) -> Texel<4> {
        Texel([x; 4])
    }
    #[inline(always)]
    fn quad_mul_add(self, a: Texel<4>, b: Texel<4>, c: Texel<4>) -> Texel<4> {
        a * b + c
    }
    #[inline(always)]
    fn quad_max(self, a: Texel<4>, b: Texel<4>) -> Texel<4> {
        a.zip(
            b,
            #[inline(always)]
            |x, y| if x > y { x } else { y },
        )
    }

    #[inline(always)]
    fn oct_load(self, src: &[f32]) -> Texel<8> {
        let src = &src[..8];
        Texel(std::array::from_fn(|i| src[i]))
    }
    #[inline(always)]
    fn oct_store(self, dst: &mut [f32], x: Texel<8>) {
        dst[..8].copy_from_slice(&x.0);
    }
    #[inline(always)]
    fn oct_splat(self, x: f32) -> Texel<8> {
        Texel([x; 8])
    }
    #[inline(always)]
    fn oct_corners<const K: usize>(self, block: &Block<'_, K, 8>, base: usize) -> [Texel<8>; K] {
        let base = base.min(block.last_base());
        std::array::from_fn(|corner| self.oct_load(&block.data()[base + block.offsets()[corner]..]))
    }
    #[inline(always)]
    fn oct_corners_half<const K: usize>(self, block: &Block<'_, K, 8, u16>, base: usize) -> [Texel<8>; K] {
        let base = base.min(block.last_base());
        std::array::from_fn(|corner| {
            let texels = &block.data()[base + block.offsets()[corner]..][..8];
            Texel(std::array::from_fn(|i| from_half(texels[i])))
        })
    }
    #[inline(always)]
    fn oct_mul_add(self, a: Texel<8>, b: Texel<8>, c: Texel<8>) -> Texel<8> {
        a * b + c
    }
    #[inline(always)]
    fn oct_max(self, a: Texel<8>, b: Texel<8>) -> Texel<8> {
        a.zip(
            b,
            #[inline(always)]
            |x, y| if x > y { x } else { y },
        )
    }
    #[inline(always)]
    fn oct_halves(self, x: Texel<8>) -> [Texel<4>; 2] {
        let [a, b, c, d, e, f, g, h] = x.0;
        [Texel([a, b, c, d]), Texel([e, f, g, h])]
    }
    #[inline(always)]
    fn oct_count_le(self, knots: Texel<8>, x: f32) -> u32 {
        knots.0.iter().take_while(|&&knot| knot <= x).count() as u32
    }
}

/// A finite half-precision float, exactly: its exponent and mantissa moved to where `f32` has them, and the difference of
/// the two exponent biases multiplied in, which makes subnormal halves right as well.
#[inline(always)]
pub(crate) fn from_half(half: u16) -> f32 {
    let magnitude = f32::from_bits(u32::from(half & 0x7fff) << 13) * f32::from_bits((127 + 127 - 15) << 23);
    f32::from_bits(magnitude.to_bits() | u32::from(half & 0x8000) << 16)
}
