//! Lane values in one register.

use core::arch::aarch64::*;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// Four floats.
#[derive(Clone, Copy, Debug)]
pub struct Floats(pub(crate) float32x4_t);

/// Four integers.
#[derive(Clone, Copy, Debug)]
pub struct Ints(pub(crate) int32x4_t);

/// Four truth values, all bits of a lane set or clear.
#[derive(Clone, Copy, Debug)]
pub struct Mask(pub(crate) uint32x4_t);

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
    Add add |self, other| Floats(op!(vaddq_f32(self.0, other.0)));
    Sub sub |self, other| Floats(op!(vsubq_f32(self.0, other.0)));
    Mul mul |self, other| Floats(op!(vmulq_f32(self.0, other.0)));
    Div div |self, other| Floats(op!(vdivq_f32(self.0, other.0)));
    Neg neg |self| Floats(op!(vnegq_f32(self.0)));
}
operators! { Ints:
    Add add |self, other| Ints(op!(vaddq_s32(self.0, other.0)));
    Sub sub |self, other| Ints(op!(vsubq_s32(self.0, other.0)));
    Mul mul |self, other| Ints(op!(vmulq_s32(self.0, other.0)));
    BitAnd bitand |self, other| Ints(op!(vandq_s32(self.0, other.0)));
    BitOr bitor |self, other| Ints(op!(vorrq_s32(self.0, other.0)));
    BitXor bitxor |self, other| Ints(op!(veorq_s32(self.0, other.0)));
}
operators! { Mask:
    BitAnd bitand |self, other| Mask(op!(vandq_u32(self.0, other.0)));
    BitOr bitor |self, other| Mask(op!(vorrq_u32(self.0, other.0)));
    BitXor bitxor |self, other| Mask(op!(veorq_u32(self.0, other.0)));
    Not not |self| Mask(op!(vmvnq_u32(self.0)));
}
operators! { Oct:
    Add add |self, other| Oct(self.0 + other.0, self.1 + other.1);
    Mul mul |self, other| Oct(self.0 * other.0, self.1 * other.1);
}

impl lobe_lane::Floats for Floats {
    type I = Ints;
    type M = Mask;

    methods! {
        // `fmin` and `fmax` differ for NaN and for zeros of different signs.
        fn min(self, other: Self) -> Self = Floats(op!(vbslq_f32(vcltq_f32(self.0, other.0), self.0, other.0)));
        fn max(self, other: Self) -> Self = Floats(op!(vbslq_f32(vcgtq_f32(self.0, other.0), self.0, other.0)));
        fn abs(self) -> Self = Floats(op!(vabsq_f32(self.0)));
        fn sqrt(self) -> Self = Floats(op!(vsqrtq_f32(self.0)));
        fn lt(self, other: Self) -> Mask = Mask(op!(vcltq_f32(self.0, other.0)));
        fn le(self, other: Self) -> Mask = Mask(op!(vcleq_f32(self.0, other.0)));
        fn eq(self, other: Self) -> Mask = Mask(op!(vceqq_f32(self.0, other.0)));
        fn masked(self, mask: Mask) -> Self =
            Floats(op!(vreinterpretq_f32_u32(vandq_u32(vreinterpretq_u32_f32(self.0), mask.0))));
        fn mul_sign(self, sign: Self) -> Self = op!({
            let sign = vandq_u32(vreinterpretq_u32_f32(sign.0), vdupq_n_u32(1 << 31));
            Floats(vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(self.0), sign)))
        });
        // The conversion saturates, and turns NaN into 0.
        fn to_int(self) -> Ints = op!({
            let fits = vcltq_f32(self.0, vdupq_n_f32(2_147_483_648.0));
            Ints(vbslq_s32(fits, vcvtq_s32_f32(self.0), vdupq_n_s32(i32::MIN)))
        });
        fn bits(self) -> Ints = Ints(op!(vreinterpretq_s32_f32(self.0)));
    }
}

impl lobe_lane::Ints for Ints {
    type F = Floats;
    type M = Mask;

    methods! {
        fn min(self, other: Self) -> Self = Ints(op!(vminq_s32(self.0, other.0)));
        fn max(self, other: Self) -> Self = Ints(op!(vmaxq_s32(self.0, other.0)));
        fn lt(self, other: Self) -> Mask = Mask(op!(vcltq_s32(self.0, other.0)));
        fn eq(self, other: Self) -> Mask = Mask(op!(vceqq_s32(self.0, other.0)));
        fn count(self, mask: Mask) -> Self = Ints(op!(vsubq_s32(self.0, vreinterpretq_s32_u32(mask.0))));
        fn to_float(self) -> Floats = Floats(op!(vcvtq_f32_s32(self.0)));
        fn as_float(self) -> Floats = Floats(op!(vreinterpretq_f32_s32(self.0)));
        // The compiler turns shifts by constants in a register into immediate shifts; the intrinsics for those refuse
        // 0.
        fn shl<const BITS: i32>(self) -> Self = Ints(op!(vshlq_s32(self.0, vdupq_n_s32(BITS))));
        fn shr<const BITS: i32>(self) -> Self =
            Ints(op!(vreinterpretq_s32_u32(vshlq_u32(vreinterpretq_u32_s32(self.0), vdupq_n_s32(-BITS)))));
    }
}

impl lobe_lane::Mask for Mask {
    methods! {
        fn bits(self) -> u32 = op!({
            let bit_of_lane = vshlq_u32(vdupq_n_u32(1), crate::memory::load_int(&[0, 1, 2, 3]));
            vaddvq_u32(vandq_u32(self.0, bit_of_lane))
        });
        fn any(self) -> bool = op!(vmaxvq_u32(self.0)) != 0;
        fn all(self) -> bool = op!(vminvq_u32(self.0)) != 0;
    }
}
