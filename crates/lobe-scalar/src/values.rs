//! Lane values as arrays.

use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// `N` floats.
#[derive(Clone, Copy, Debug)]
pub struct Floats<const N: usize>(pub(crate) [f32; N]);

/// `N` integers.
#[derive(Clone, Copy, Debug)]
pub struct Ints<const N: usize>(pub(crate) [i32; N]);

/// `N` truth values.
#[derive(Clone, Copy, Debug)]
pub struct Mask<const N: usize>(pub(crate) [bool; N]);

/// `f` of each lane.
///
/// Programs compute with one lane, so it is inlined. More lanes are only for tests of width-generic code; there, each
/// operation is a call, because inlining it once per lane into every kernel would take the compiler minutes.
#[inline(always)]
pub(crate) fn each<T: Copy, const N: usize>(f: impl Fn(usize) -> T) -> [T; N] {
    if N == 1 { [f(0); N] } else { each_of_many(f) }
}

#[inline(never)]
fn each_of_many<T: Copy, const N: usize>(f: impl Fn(usize) -> T) -> [T; N] {
    let mut lanes = [f(0); N];
    let mut lane = 1;
    while lane < N {
        lanes[lane] = f(lane);
        lane += 1;
    }
    lanes
}

/// Applies a function of two elements lane by lane. A macro, because a closure across a call would have to be inlined
/// into code with the backend's features.
macro_rules! zip {
    ($out:ident, $a:expr, $b:expr, |$x:ident, $y:ident| $f:expr) => {{
        let (a, b) = ($a.0, $b.0);
        $out(each(
            #[inline(always)]
            |lane| {
                let ($x, $y) = (a[lane], b[lane]);
                $f
            },
        ))
    }};
}

/// Applies a function of one element lane by lane.
macro_rules! map {
    ($out:ident, $a:expr, |$x:ident| $f:expr) => {{
        let a = $a.0;
        $out(each(
            #[inline(always)]
            |lane| {
                let $x = a[lane];
                $f
            },
        ))
    }};
}

macro_rules! operators {
    ($type:ident: $($trait:ident $method:ident |$x:ident, $y:ident| $f:expr;)*) => {
        $(impl<const N: usize> $trait for $type<N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                zip!($type, self, other, |$x, $y| $f)
            }
        })*
    };
}

operators! { Floats: Add add |x, y| x + y; Sub sub |x, y| x - y; Mul mul |x, y| x * y; Div div |x, y| x / y; }
operators! { Ints:
    Add add |x, y| x.wrapping_add(y); Sub sub |x, y| x.wrapping_sub(y); Mul mul |x, y| x.wrapping_mul(y);
    BitAnd bitand |x, y| x & y; BitOr bitor |x, y| x | y; BitXor bitxor |x, y| x ^ y;
}
operators! { Mask: BitAnd bitand |x, y| x & y; BitOr bitor |x, y| x | y; BitXor bitxor |x, y| x ^ y; }

impl<const N: usize> Neg for Floats<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        map!(Floats, self, |x| -x)
    }
}

impl<const N: usize> Not for Mask<N> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        map!(Mask, self, |x| !x)
    }
}

/// Converts like the hardware: toward zero, `i32::MIN` if the result does not fit.
#[inline(always)]
fn truncate(x: f32) -> i32 {
    if (-2_147_483_648.0..2_147_483_648.0).contains(&x) { x as i32 } else { i32::MIN }
}

impl<const N: usize> lobe_lane::Floats for Floats<N> {
    type I = Ints<N>;
    type M = Mask<N>;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        zip!(Floats, self, other, |x, y| if x < y { x } else { y })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        zip!(Floats, self, other, |x, y| if x > y { x } else { y })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        map!(Floats, self, |x| x.abs())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        map!(Floats, self, |x| x.sqrt())
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask<N> {
        zip!(Mask, self, other, |x, y| x < y)
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask<N> {
        zip!(Mask, self, other, |x, y| x <= y)
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask<N> {
        zip!(Mask, self, other, |x, y| x == y)
    }
    #[inline(always)]
    fn masked(self, mask: Mask<N>) -> Self {
        zip!(Floats, self, mask, |x, set| if set { x } else { 0.0 })
    }
    #[inline(always)]
    fn mul_sign(self, sign: Self) -> Self {
        zip!(Floats, self, sign, |x, s| f32::from_bits(x.to_bits() ^ (s.to_bits() & 0x8000_0000)))
    }
    #[inline(always)]
    fn to_int(self) -> Ints<N> {
        map!(Ints, self, |x| truncate(x))
    }
    #[inline(always)]
    fn bits(self) -> Ints<N> {
        map!(Ints, self, |x| x.to_bits() as i32)
    }
}

impl<const N: usize> lobe_lane::Ints for Ints<N> {
    type F = Floats<N>;
    type M = Mask<N>;

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        zip!(Ints, self, other, |x, y| if x < y { x } else { y })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        zip!(Ints, self, other, |x, y| if x > y { x } else { y })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask<N> {
        zip!(Mask, self, other, |x, y| x < y)
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask<N> {
        zip!(Mask, self, other, |x, y| x == y)
    }
    #[inline(always)]
    fn shl<const BITS: i32>(self) -> Self {
        map!(Ints, self, |x| x << BITS)
    }
    #[inline(always)]
    fn shr<const BITS: i32>(self) -> Self {
        map!(Ints, self, |x| ((x as u32) >> BITS) as i32)
    }
    #[inline(always)]
    fn count(self, mask: Mask<N>) -> Self {
        zip!(Ints, self, mask, |x, set| x.wrapping_add(set as i32))
    }
    #[inline(always)]
    fn to_float(self) -> Floats<N> {
        map!(Floats, self, |x| x as f32)
    }
    #[inline(always)]
    fn as_float(self) -> Floats<N> {
        map!(Floats, self, |x| f32::from_bits(x as u32))
    }
}

impl<const N: usize> lobe_lane::Mask for Mask<N> {
    #[inline(always)]
    fn bits(self) -> u32 {
        let mut bits = 0;
        let mut lane = 0;
        while lane < N {
            bits |= (self.0[lane] as u32) << lane;
            lane += 1;
        }
        bits
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.bits() == (1u32 << N) - 1
    }
}
