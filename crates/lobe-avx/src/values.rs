//! Lane values in one `ymm` register.

use core::arch::x86_64::*;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// Eight floats.
#[derive(Clone, Copy, Debug)]
pub struct Floats(pub(crate) __m256);

/// For backends that build on this one.
impl From<Floats> for __m256 {
    #[inline(always)]
    fn from(x: Floats) -> Self {
        x.0
    }
}

/// Eight integers.
#[derive(Clone, Copy, Debug)]
pub struct Ints(pub(crate) __m256i);

/// Four floats.
#[derive(Clone, Copy, Debug)]
pub struct Quad(pub(crate) __m128);

/// Eight truth values, all bits of a lane set or clear.
#[derive(Clone, Copy, Debug)]
pub struct Mask(pub(crate) __m256);

macro_rules! operators {
    ($type:ident: $($trait:ident $method:ident |$x:ident, $y:ident| $f:expr;)*) => {
        $(impl $trait for $type {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ($x, $y) = (self.0, other.0);
                $type(op!($f))
            }
        })*
    };
}

operators! { Floats:
    Add add |x, y| _mm256_add_ps(x, y);
    Sub sub |x, y| _mm256_sub_ps(x, y);
    Mul mul |x, y| _mm256_mul_ps(x, y);
    Div div |x, y| _mm256_div_ps(x, y);
}
operators! { Quad:
    Add add |x, y| _mm_add_ps(x, y);
    Sub sub |x, y| _mm_sub_ps(x, y);
    Mul mul |x, y| _mm_mul_ps(x, y);
}
operators! { Ints:
    Add add |x, y| _mm256_add_epi32(x, y);
    Sub sub |x, y| _mm256_sub_epi32(x, y);
    BitAnd bitand |x, y| _mm256_and_si256(x, y);
    BitOr bitor |x, y| _mm256_or_si256(x, y);
    BitXor bitxor |x, y| _mm256_xor_si256(x, y);
}
operators! { Mask:
    BitAnd bitand |x, y| _mm256_and_ps(x, y);
    BitOr bitor |x, y| _mm256_or_ps(x, y);
    BitXor bitxor |x, y| _mm256_xor_ps(x, y);
}

impl Mul for Ints {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Ints(op!(_mm256_mullo_epi32(self.0, other.0)))
    }
}

impl Neg for Floats {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Floats(op!(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))))
    }
}

impl Not for Mask {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Mask(op!(_mm256_xor_ps(self.0, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))))
    }
}

impl lobe_lane::Floats for Floats {
    type I = Ints;
    type M = Mask;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Floats(op!(_mm256_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Floats(op!(_mm256_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Floats(op!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Floats(op!(_mm256_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        Mask(op!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask {
        Mask(op!(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask {
        Mask(op!(_mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn masked(self, mask: Mask) -> Self {
        Floats(op!(_mm256_and_ps(self.0, mask.0)))
    }
    #[inline(always)]
    fn mul_sign(self, sign: Self) -> Self {
        Floats(op!(_mm256_xor_ps(self.0, _mm256_and_ps(sign.0, _mm256_set1_ps(-0.0)))))
    }
    #[inline(always)]
    fn to_int(self) -> Ints {
        Ints(op!(_mm256_cvttps_epi32(self.0)))
    }
    #[inline(always)]
    fn bits(self) -> Ints {
        Ints(op!(_mm256_castps_si256(self.0)))
    }
}

impl lobe_lane::Ints for Ints {
    type F = Floats;
    type M = Mask;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Ints(op!(_mm256_min_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Ints(op!(_mm256_max_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        Mask(op!(_mm256_castsi256_ps(_mm256_cmpgt_epi32(other.0, self.0))))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask {
        Mask(op!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(self.0, other.0))))
    }
    #[inline(always)]
    fn shl<const BITS: i32>(self) -> Self {
        Ints(op!(_mm256_slli_epi32::<BITS>(self.0)))
    }
    #[inline(always)]
    fn shr<const BITS: i32>(self) -> Self {
        Ints(op!(_mm256_srli_epi32::<BITS>(self.0)))
    }
    #[inline(always)]
    fn count(self, mask: Mask) -> Self {
        Ints(op!(_mm256_sub_epi32(self.0, _mm256_castps_si256(mask.0))))
    }
    #[inline(always)]
    fn to_float(self) -> Floats {
        Floats(op!(_mm256_cvtepi32_ps(self.0)))
    }
    #[inline(always)]
    fn as_float(self) -> Floats {
        Floats(op!(_mm256_castsi256_ps(self.0)))
    }
}

impl lobe_lane::Mask for Mask {
    #[inline(always)]
    fn bits(self) -> u32 {
        op!(_mm256_movemask_ps(self.0)) as u32
    }
    #[inline(always)]
    fn all(self) -> bool {
        op!(_mm256_movemask_ps(self.0)) == 0b1111_1111
    }
}
