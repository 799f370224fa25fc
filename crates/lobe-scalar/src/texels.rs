//! Quads and octs: arrays of four and eight, for any number of lanes.

use std::ops::{Add, Mul, Sub};

use lobe_lane::{Block, Texels};

use crate::Scalar;

/// Four or eight floats.
#[derive(Clone, Copy, Debug)]
pub struct Texel<const K: usize>(pub(crate) [f32; K]);

/// Applies a function of two floats to each pair. A macro and a loop: closures would have to be inlined one by one.
macro_rules! zip {
    ($a:expr, $b:expr, |$x:ident, $y:ident| $f:expr) => {{
        let (mut a, b) = ($a.0, $b.0);
        let mut i = 0;
        while i < a.len() {
            let ($x, $y) = (a[i], b[i]);
            a[i] = $f;
            i += 1;
        }
        Texel(a)
    }};
}

macro_rules! operators {
    ($($trait:ident $method:ident |$x:ident, $y:ident| $f:expr;)*) => {
        $(impl<const K: usize> $trait for Texel<K> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                zip!(self, other, |$x, $y| $f)
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
        let mut corners = [self.quad_splat(0.0); K];
        let mut corner = 0;
        while corner < K {
            corners[corner] = self.quad_load(&block.data()[base + block.offsets()[corner]..]);
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn quad_corners_half<const K: usize>(self, block: &Block<'_, K, 4, u16>, base: usize) -> [Texel<4>; K] {
        let base = base.min(block.last_base());
        let mut corners = [self.quad_splat(0.0); K];
        let mut corner = 0;
        while corner < K {
            corners[corner] = halves(&block.data()[base + block.offsets()[corner]..]);
            corner += 1;
        }
        corners
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
        zip!(a, b, |x, y| if x > y { x } else { y })
    }

    #[inline(always)]
    fn oct_load(self, src: &[f32]) -> Texel<8> {
        let mut texel = Texel([0.0; 8]);
        texel.0.copy_from_slice(&src[..8]);
        texel
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
        let mut corners = [self.oct_splat(0.0); K];
        let mut corner = 0;
        while corner < K {
            corners[corner] = self.oct_load(&block.data()[base + block.offsets()[corner]..]);
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn oct_corners_half<const K: usize>(self, block: &Block<'_, K, 8, u16>, base: usize) -> [Texel<8>; K] {
        let base = base.min(block.last_base());
        let mut corners = [self.oct_splat(0.0); K];
        let mut corner = 0;
        while corner < K {
            corners[corner] = halves(&block.data()[base + block.offsets()[corner]..]);
            corner += 1;
        }
        corners
    }
    #[inline(always)]
    fn oct_mul_add(self, a: Texel<8>, b: Texel<8>, c: Texel<8>) -> Texel<8> {
        a * b + c
    }
    #[inline(always)]
    fn oct_max(self, a: Texel<8>, b: Texel<8>) -> Texel<8> {
        zip!(a, b, |x, y| if x > y { x } else { y })
    }
    #[inline(always)]
    fn oct_halves(self, x: Texel<8>) -> [Texel<4>; 2] {
        let [a, b, c, d, e, f, g, h] = x.0;
        [Texel([a, b, c, d]), Texel([e, f, g, h])]
    }
    #[inline(always)]
    fn oct_count_le(self, knots: Texel<8>, x: f32) -> u32 {
        let mut count = 0;
        while count < 8 && knots.0[count] <= x {
            count += 1;
        }
        count as u32
    }
}

/// The first `K` half-precision floats.
#[inline(always)]
fn halves<const K: usize>(src: &[u16]) -> Texel<K> {
    let src = &src[..K];
    let mut texel = [0.0; K];
    let mut i = 0;
    while i < K {
        texel[i] = from_half(src[i]);
        i += 1;
    }
    Texel(texel)
}

/// Converts a finite half-precision float exactly: its exponent and mantissa are moved to their places in `f32`, and
/// the difference of the exponent biases is multiplied in, which is also right for subnormal halves.
#[inline(always)]
pub(crate) fn from_half(half: u16) -> f32 {
    let magnitude = f32::from_bits(u32::from(half & 0x7fff) << 13) * f32::from_bits((127 + 127 - 15) << 23);
    f32::from_bits(magnitude.to_bits() | u32::from(half & 0x8000) << 16)
}
