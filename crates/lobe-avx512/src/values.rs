//! Lane values in one `zmm` register, and masks in one mask register.

use core::arch::x86_64::*;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// Sixteen floats.
#[derive(Clone, Copy, Debug)]
pub struct Floats(pub(crate) __m512);

/// Sixteen integers.
#[derive(Clone, Copy, Debug)]
pub struct Ints(pub(crate) __m512i);

/// Sixteen truth values, one bit each.
#[derive(Clone, Copy, Debug)]
pub struct Mask(pub(crate) __mmask16);

macro_rules! operators {
    ($type:ident: $($trait:ident $method:ident |$x:ident, $y:ident| $f:expr;)*) => {
        $(impl $trait for $type {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ($x, $y) = (self.0, other.0);
                $type($f)
            }
        })*
    };
}

operators! { Floats:
    Add add |x, y| op!(_mm512_add_ps(x, y));
    Sub sub |x, y| op!(_mm512_sub_ps(x, y));
    Mul mul |x, y| op!(_mm512_mul_ps(x, y));
    Div div |x, y| op!(_mm512_div_ps(x, y));
}
operators! { Ints:
    Add add |x, y| op!(_mm512_add_epi32(x, y));
    Sub sub |x, y| op!(_mm512_sub_epi32(x, y));
    Mul mul |x, y| op!(_mm512_mullo_epi32(x, y));
    BitAnd bitand |x, y| op!(_mm512_and_si512(x, y));
    BitOr bitor |x, y| op!(_mm512_or_si512(x, y));
    BitXor bitxor |x, y| op!(_mm512_xor_si512(x, y));
}
operators! { Mask:
    BitAnd bitand |x, y| x & y;
    BitOr bitor |x, y| x | y;
    BitXor bitxor |x, y| x ^ y;
}

impl Neg for Floats {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Floats(op!(_mm512_xor_ps(self.0, _mm512_set1_ps(-0.0))))
    }
}

impl Not for Mask {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Mask(!self.0)
    }
}

impl lobe_lane::Floats for Floats {
    type I = Ints;
    type M = Mask;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Floats(op!(_mm512_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Floats(op!(_mm512_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Floats(op!(_mm512_andnot_ps(_mm512_set1_ps(-0.0), self.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Floats(op!(_mm512_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        Mask(op!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask {
        Mask(op!(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask {
        Mask(op!(_mm512_cmp_ps_mask::<_CMP_EQ_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn masked(self, mask: Mask) -> Self {
        Floats(op!(_mm512_maskz_mov_ps(mask.0, self.0)))
    }
    #[inline(always)]
    fn mul_sign(self, sign: Self) -> Self {
        Floats(op!(_mm512_xor_ps(self.0, _mm512_and_ps(sign.0, _mm512_set1_ps(-0.0)))))
    }
    #[inline(always)]
    fn to_int(self) -> Ints {
        Ints(op!(_mm512_cvttps_epi32(self.0)))
    }
    #[inline(always)]
    fn bits(self) -> Ints {
        Ints(op!(_mm512_castps_si512(self.0)))
    }
}

impl lobe_lane::Ints for Ints {
    type F = Floats;
    type M = Mask;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Ints(op!(_mm512_min_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Ints(op!(_mm512_max_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        Mask(op!(_mm512_cmplt_epi32_mask(self.0, other.0)))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask {
        Mask(op!(_mm512_cmpeq_epi32_mask(self.0, other.0)))
    }
    #[inline(always)]
    fn shl<const BITS: i32>(self) -> Self {
        // A literal type: the intrinsic's constant is unsigned, and generic constants cannot be converted.
        Ints(op!(_mm512_sllv_epi32(self.0, _mm512_set1_epi32(BITS))))
    }
    #[inline(always)]
    fn shr<const BITS: i32>(self) -> Self {
        Ints(op!(_mm512_srlv_epi32(self.0, _mm512_set1_epi32(BITS))))
    }
    #[inline(always)]
    fn count(self, mask: Mask) -> Self {
        Ints(op!(_mm512_mask_add_epi32(self.0, mask.0, self.0, _mm512_set1_epi32(1))))
    }
    #[inline(always)]
    fn to_float(self) -> Floats {
        Floats(op!(_mm512_cvtepi32_ps(self.0)))
    }
    #[inline(always)]
    fn as_float(self) -> Floats {
        Floats(op!(_mm512_castsi512_ps(self.0)))
    }
}

impl lobe_lane::Mask for Mask {
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self.0)
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0 == u16::MAX
    }
}
