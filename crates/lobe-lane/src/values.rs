//! The operations of lane values: arithmetic and comparison, lane by lane, with the same bits on every backend.

use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// A vector of `f32`. Every operation is exact or correctly rounded, so all backends agree to the bit
/// (NaN payloads excepted).
pub trait Floats:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Integers of the same number of lanes.
    type I: Ints<F = Self, M = Self::M>;
    /// Truth values of the same number of lanes.
    type M: Mask;

    /// `if self < other { self } else { other }`, so `other` if either is NaN.
    fn min(self, other: Self) -> Self;
    /// `if self > other { self } else { other }`, so `other` if either is NaN.
    fn max(self, other: Self) -> Self;
    /// The sign bit cleared.
    fn abs(self) -> Self;
    /// Correctly rounded square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// `self < other`, false if either is NaN.
    fn lt(self, other: Self) -> Self::M;
    /// `self <= other`, false if either is NaN.
    fn le(self, other: Self) -> Self::M;
    /// `self > other`, false if either is NaN.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::M {
        other.lt(self)
    }
    /// `self >= other`, false if either is NaN.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::M {
        other.le(self)
    }
    /// `self == other`, false if either is NaN.
    fn eq(self, other: Self) -> Self::M;
    /// `self` where the mask is set, `+0.0` elsewhere.
    fn masked(self, mask: Self::M) -> Self;
    /// `self` with its sign bit flipped where the sign bit of `sign` is set.
    fn mul_sign(self, sign: Self) -> Self;
    /// Rounded toward zero; `i32::MIN` if NaN or out of range.
    fn to_int(self) -> Self::I;
    /// The same 32 bits as an integer.
    fn bits(self) -> Self::I;
}

/// A vector of `i32`, wrapping on overflow.
pub trait Ints:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
{
    /// Floats of the same number of lanes.
    type F: Floats<I = Self, M = Self::M>;
    /// Truth values of the same number of lanes.
    type M: Mask;

    /// The smaller of the two, signed.
    fn min(self, other: Self) -> Self;
    /// The larger of the two, signed.
    fn max(self, other: Self) -> Self;
    /// `self < other`, signed.
    fn lt(self, other: Self) -> Self::M;
    /// `self == other`.
    fn eq(self, other: Self) -> Self::M;
    /// Shifted left by `BITS` (less than 32).
    fn shl<const BITS: i32>(self) -> Self;
    /// Shifted right by `BITS` (less than 32), with zeros shifted in.
    fn shr<const BITS: i32>(self) -> Self;
    /// Adds one where the mask is set, for kernels that count: on most hardware a set mask *is* -1, so `a.count(m)` is
    /// a single subtraction.
    fn count(self, mask: Self::M) -> Self;
    /// Rounded to the nearest float, ties to even.
    fn to_float(self) -> Self::F;
    /// The same 32 bits as a float.
    fn as_float(self) -> Self::F;
}

/// A vector of truth values.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
    /// One bit per lane, lane 0 lowest.
    fn bits(self) -> u32;
    /// `true` if any lane is set.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
    /// `true` if every lane is set.
    fn all(self) -> bool;
}
