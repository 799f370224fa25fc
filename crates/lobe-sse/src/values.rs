//! Lane values in one `xmm` register.

use core::arch::x86_64::*;
use core::marker::PhantomData;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

use crate::{Level, Sse};

/// Four floats.
#[derive(Clone, Copy, Debug)]
pub struct Floats<V>(pub(crate) __m128, PhantomData<V>);

/// Four integers.
#[derive(Clone, Copy, Debug)]
pub struct Ints<V>(pub(crate) __m128i, PhantomData<V>);

/// Four truth values, all bits of a lane set or clear.
#[derive(Clone, Copy, Debug)]
pub struct Mask<V>(pub(crate) __m128, PhantomData<V>);

/// Eight floats in two registers, low half first.
#[derive(Clone, Copy, Debug)]
pub struct Oct<V>(pub(crate) Floats<V>, pub(crate) Floats<V>);

// Private constructors: only code that holds a token or a value can create another value.
#[inline(always)]
pub(crate) fn floats<V>(x: __m128) -> Floats<V> {
    Floats(x, PhantomData)
}
#[inline(always)]
pub(crate) fn ints<V>(x: __m128i) -> Ints<V> {
    Ints(x, PhantomData)
}
#[inline(always)]
pub(crate) fn mask<V>(x: __m128) -> Mask<V> {
    Mask(x, PhantomData)
}

/// The token again; callers hold a value, which came from one.
#[inline(always)]
fn proof<V: Level>() -> Sse<V> {
    Sse(PhantomData)
}

macro_rules! operators {
    ($type:ident $make:ident: $($trait:ident $method:ident |$x:ident, $y:ident| $f:expr;)*) => {
        $(impl<V: Level> $trait for $type<V> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ($x, $y) = (self.0, other.0);
                $make(op!($f))
            }
        })*
    };
}

operators! { Floats floats:
    Add add |x, y| _mm_add_ps(x, y);
    Sub sub |x, y| _mm_sub_ps(x, y);
    Mul mul |x, y| _mm_mul_ps(x, y);
    Div div |x, y| _mm_div_ps(x, y);
}
operators! { Ints ints:
    Add add |x, y| _mm_add_epi32(x, y);
    Sub sub |x, y| _mm_sub_epi32(x, y);
    BitAnd bitand |x, y| _mm_and_si128(x, y);
    BitOr bitor |x, y| _mm_or_si128(x, y);
    BitXor bitxor |x, y| _mm_xor_si128(x, y);
}
operators! { Mask mask:
    BitAnd bitand |x, y| _mm_and_ps(x, y);
    BitOr bitor |x, y| _mm_or_ps(x, y);
    BitXor bitxor |x, y| _mm_xor_ps(x, y);
}

impl<V: Level> Mul for Ints<V> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        ints(V::mul(proof(), self.0, other.0))
    }
}

impl<V: Level> Neg for Floats<V> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        floats(op!(_mm_xor_ps(self.0, _mm_set1_ps(-0.0))))
    }
}

impl<V: Level> Not for Mask<V> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        mask(op!(_mm_xor_ps(self.0, _mm_castsi128_ps(_mm_set1_epi32(-1)))))
    }
}

impl<V: Level> Add for Oct<V> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Oct(self.0 + other.0, self.1 + other.1)
    }
}

impl<V: Level> Mul for Oct<V> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Oct(self.0 * other.0, self.1 * other.1)
    }
}

impl<V: Level> lobe_lane::Floats for Floats<V> {
    type I = Ints<V>;
    type M = Mask<V>;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        floats(op!(_mm_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        floats(op!(_mm_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        floats(op!(_mm_andnot_ps(_mm_set1_ps(-0.0), self.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        floats(op!(_mm_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask<V> {
        mask(op!(_mm_cmplt_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask<V> {
        mask(op!(_mm_cmple_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask<V> {
        mask(op!(_mm_cmpeq_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn masked(self, mask: Mask<V>) -> Self {
        floats(op!(_mm_and_ps(self.0, mask.0)))
    }
    #[inline(always)]
    fn mul_sign(self, sign: Self) -> Self {
        floats(op!(_mm_xor_ps(self.0, _mm_and_ps(sign.0, _mm_set1_ps(-0.0)))))
    }
    #[inline(always)]
    fn to_int(self) -> Ints<V> {
        ints(op!(_mm_cvttps_epi32(self.0)))
    }
    #[inline(always)]
    fn bits(self) -> Ints<V> {
        ints(op!(_mm_castps_si128(self.0)))
    }
}

impl<V: Level> lobe_lane::Ints for Ints<V> {
    type F = Floats<V>;
    type M = Mask<V>;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        ints(V::min(proof(), self.0, other.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        ints(V::max(proof(), self.0, other.0))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask<V> {
        mask(op!(_mm_castsi128_ps(_mm_cmplt_epi32(self.0, other.0))))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask<V> {
        mask(op!(_mm_castsi128_ps(_mm_cmpeq_epi32(self.0, other.0))))
    }
    #[inline(always)]
    fn shl<const BITS: i32>(self) -> Self {
        ints(op!(_mm_slli_epi32::<BITS>(self.0)))
    }
    #[inline(always)]
    fn shr<const BITS: i32>(self) -> Self {
        ints(op!(_mm_srli_epi32::<BITS>(self.0)))
    }
    #[inline(always)]
    fn count(self, mask: Mask<V>) -> Self {
        ints(op!(_mm_sub_epi32(self.0, _mm_castps_si128(mask.0))))
    }
    #[inline(always)]
    fn to_float(self) -> Floats<V> {
        floats(op!(_mm_cvtepi32_ps(self.0)))
    }
    #[inline(always)]
    fn as_float(self) -> Floats<V> {
        floats(op!(_mm_castsi128_ps(self.0)))
    }
}

impl<V: Level> lobe_lane::Mask for Mask<V> {
    #[inline(always)]
    fn bits(self) -> u32 {
        op!(_mm_movemask_ps(self.0)) as u32
    }
    #[inline(always)]
    fn all(self) -> bool {
        op!(_mm_movemask_ps(self.0)) == 0b1111
    }
}
