//! Lane values in one register.

use core::arch::wasm32::*;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// Four floats.
#[derive(Clone, Copy, Debug)]
pub struct Floats(pub(crate) v128);

/// Four integers.
#[derive(Clone, Copy, Debug)]
pub struct Ints(pub(crate) v128);

/// Four truth values, all bits of a lane set or clear.
#[derive(Clone, Copy, Debug)]
pub struct Mask(pub(crate) v128);

/// Eight floats in two registers, low half first.
#[derive(Clone, Copy, Debug)]
pub struct Oct(pub(crate) Floats, pub(crate) Floats);

macro_rules! operators {
    ($type:ident: $($trait:ident $method:ident |$self:ident $(, $other:ident)?| $value:expr;)*) => {$(
        impl $trait for $type {
            type Output = Self;

            methods! { fn $method($self $(, $other: Self)?) -> Self = $value; }
        }
    )*};
}

operators! { Floats:
    Add add |self, other| Floats(f32x4_add(self.0, other.0));
    Sub sub |self, other| Floats(f32x4_sub(self.0, other.0));
    Mul mul |self, other| Floats(f32x4_mul(self.0, other.0));
    Div div |self, other| Floats(f32x4_div(self.0, other.0));
    Neg neg |self| Floats(f32x4_neg(self.0));
}
operators! { Ints:
    Add add |self, other| Ints(i32x4_add(self.0, other.0));
    Sub sub |self, other| Ints(i32x4_sub(self.0, other.0));
    Mul mul |self, other| Ints(i32x4_mul(self.0, other.0));
    BitAnd bitand |self, other| Ints(v128_and(self.0, other.0));
    BitOr bitor |self, other| Ints(v128_or(self.0, other.0));
    BitXor bitxor |self, other| Ints(v128_xor(self.0, other.0));
}
operators! { Mask:
    BitAnd bitand |self, other| Mask(v128_and(self.0, other.0));
    BitOr bitor |self, other| Mask(v128_or(self.0, other.0));
    BitXor bitxor |self, other| Mask(v128_xor(self.0, other.0));
    Not not |self| Mask(v128_not(self.0));
}
operators! { Oct:
    Add add |self, other| Oct(self.0 + other.0, self.1 + other.1);
    Mul mul |self, other| Oct(self.0 * other.0, self.1 * other.1);
}

impl lobe_lane::Floats for Floats {
    type I = Ints;
    type M = Mask;

    methods! {
        // `pmin(a, b)` is `if b < a { b } else { a }`; `min` and `max` differ for NaN and for zeros of different signs.
        fn min(self, other: Self) -> Self = Floats(f32x4_pmin(other.0, self.0));
        fn max(self, other: Self) -> Self = Floats(f32x4_pmax(other.0, self.0));
        fn abs(self) -> Self = Floats(f32x4_abs(self.0));
        fn sqrt(self) -> Self = Floats(f32x4_sqrt(self.0));
        fn lt(self, other: Self) -> Mask = Mask(f32x4_lt(self.0, other.0));
        fn le(self, other: Self) -> Mask = Mask(f32x4_le(self.0, other.0));
        fn eq(self, other: Self) -> Mask = Mask(f32x4_eq(self.0, other.0));
        fn masked(self, mask: Mask) -> Self = Floats(v128_and(self.0, mask.0));
        fn mul_sign(self, sign: Self) -> Self = Floats(v128_xor(self.0, v128_and(sign.0, i32x4_splat(i32::MIN))));
        // The conversion saturates, and turns NaN into 0.
        fn to_int(self) -> Ints = {
            let fits = f32x4_lt(self.0, f32x4_splat(2_147_483_648.0));
            Ints(v128_bitselect(i32x4_trunc_sat_f32x4(self.0), i32x4_splat(i32::MIN), fits))
        };
        fn bits(self) -> Ints = Ints(self.0);
    }
}

impl lobe_lane::Ints for Ints {
    type F = Floats;
    type M = Mask;

    methods! {
        fn min(self, other: Self) -> Self = Ints(i32x4_min(self.0, other.0));
        fn max(self, other: Self) -> Self = Ints(i32x4_max(self.0, other.0));
        fn lt(self, other: Self) -> Mask = Mask(i32x4_lt(self.0, other.0));
        fn eq(self, other: Self) -> Mask = Mask(i32x4_eq(self.0, other.0));
        fn shl<const BITS: i32>(self) -> Self = Ints(i32x4_shl(self.0, BITS as u32));
        fn shr<const BITS: i32>(self) -> Self = Ints(u32x4_shr(self.0, BITS as u32));
        fn count(self, mask: Mask) -> Self = Ints(i32x4_sub(self.0, mask.0));
        fn to_float(self) -> Floats = Floats(f32x4_convert_i32x4(self.0));
        fn as_float(self) -> Floats = Floats(self.0);
    }
}

impl lobe_lane::Mask for Mask {
    methods! {
        fn bits(self) -> u32 = u32::from(i32x4_bitmask(self.0));
        fn any(self) -> bool = v128_any_true(self.0);
        fn all(self) -> bool = i32x4_all_true(self.0);
    }
}
