//! Arithmetic and comparison, lane by lane, over all pairs of patterns.

use lobe_lane::{Floats, Ints, Kernel, Lanes};

use super::{assert_same, floats, ints, truths};
use crate::patterns;

/// Compares expressions of lanes with the same expressions of numbers. The arguments are a name, how to read the
/// result, the lanes and the numbers.
macro_rules! check {
    ($lanes:ident, $xs:ident, $ys:ident, $load:ident; $($what:literal $read:ident |$a:pat_param, $b:pat_param| $value:expr, |$x:pat_param, $y:pat_param| $expected:expr;)*) => {$({
        let mut at = 0;
        while at < $xs.len() {
            let ($a, $b) = ($lanes.$load(&$xs[at..]), $lanes.$load(&$ys[at..]));
            let found = $read($lanes, $value);
            let mut lane = 0;
            while lane < L::LANES {
                let (x, y) = ($xs[at + lane], $ys[at + lane]);
                let ($x, $y) = (x, y);
                assert_same($what, &[&x, &y], found[lane], $expected);
                lane += 1;
            }
            at += L::LANES;
        }
    })*};
}

/// Floats: every method of `Floats`, and those of `Lanes` on floats.
#[derive(Clone, Copy)]
pub struct FloatArithmetic;

impl Kernel for FloatArithmetic {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let (xs, ys) = patterns::pairs(&patterns::floats());
        check! { lanes, xs, ys, load;
            "a + b" floats |a, b| a + b, |x, y| x + y;
            "a - b" floats |a, b| a - b, |x, y| x - y;
            "a * b" floats |a, b| a * b, |x, y| x * y;
            "a / b" floats |a, b| a / b, |x, y| x / y;
            "-a" floats |a, _| -a, |x, _| -x;
            "min" floats |a, b| a.min(b), |x, y| if x < y { x } else { y };
            "max" floats |a, b| a.max(b), |x, y| if x > y { x } else { y };
            "abs" floats |a, _| a.abs(), |x, _| f32::abs(x);
            "sqrt" floats |a, _| a.sqrt(), |x, _| f32::sqrt(x);
            "a < b" truths |a, b| a.lt(b), |x, y| x < y;
            "a <= b" truths |a, b| a.le(b), |x, y| x <= y;
            "a > b" truths |a, b| a.gt(b), |x, y| x > y;
            "a >= b" truths |a, b| a.ge(b), |x, y| x >= y;
            "a == b" truths |a, b| a.eq(b), |x, y| x == y;
            "masked" floats |a, b| a.masked(b.lt(a)), |x, y| if y < x { x } else { 0.0 };
            "mul_sign" floats |a, b| a.mul_sign(b), |x, y| f32::from_bits(x.to_bits() ^ (y.to_bits() & 1 << 31));
            "to_int" ints |a, _| a.to_int(), |x, _| truncated(x);
            "bits" ints |a, _| a.bits(), |x, _| x.to_bits() as i32;
            "sign of -a" ints |a, _| (-a).bits(), |x, _| x.to_bits() as i32 ^ i32::MIN;
            "sign of abs" ints |a, _| a.abs().bits(), |x, _| x.to_bits() as i32 & i32::MAX;
            "select" floats |a, b| lanes.select(a.lt(b), a, b), |x, y| if x < y { x } else { y };
            "select, the other way" floats |a, b| lanes.select(a.lt(b), b, a), |x, y| if x < y { y } else { x };
        }
        let all = patterns::floats();
        let mut index = 0;
        while index < all.len() {
            let z = all[index];
            let c = lanes.splat(z);
            check! { lanes, xs, ys, load;
                "mul_add" floats |a, b| lanes.mul_add(a, b, c), |x, y| if L::FUSED { x.mul_add(y, z) } else { x * y + z };
            }
            index += 1;
        }
    }
}

/// Rounds toward zero; `i32::MIN` for NaN and numbers out of range.
fn truncated(x: f32) -> i32 {
    // Both ends are powers of two, so they are exact.
    if (-2_147_483_648.0..2_147_483_648.0).contains(&x) { x as i32 } else { i32::MIN }
}

/// Integers: every method of `Ints`, and those of `Lanes` on integers.
#[derive(Clone, Copy)]
pub struct IntArithmetic;

impl Kernel for IntArithmetic {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let (xs, ys) = patterns::pairs(&patterns::INTS);
        check! { lanes, xs, ys, load_int;
            "int a + b" ints |a, b| a + b, |x, y| x.wrapping_add(y);
            "int a - b" ints |a, b| a - b, |x, y| x.wrapping_sub(y);
            "int a * b" ints |a, b| a * b, |x, y| x.wrapping_mul(y);
            "int a & b" ints |a, b| a & b, |x, y| x & y;
            "int a | b" ints |a, b| a | b, |x, y| x | y;
            "int a ^ b" ints |a, b| a ^ b, |x, y| x ^ y;
            "int min" ints |a, b| a.min(b), |x, y| Ord::min(x, y);
            "int max" ints |a, b| a.max(b), |x, y| Ord::max(x, y);
            "int a < b" truths |a, b| a.lt(b), |x, y| x < y;
            "int a == b" truths |a, b| a.eq(b), |x, y| x == y;
            "shl 0" ints |a, _| a.shl::<0>(), |x, _| x;
            "shl 1" ints |a, _| a.shl::<1>(), |x, _| x << 1;
            "shl 28" ints |a, _| a.shl::<28>(), |x, _| x << 28;
            "shl 31" ints |a, _| a.shl::<31>(), |x, _| x << 31;
            "shr 0" ints |a, _| a.shr::<0>(), |x, _| x;
            "shr 1" ints |a, _| a.shr::<1>(), |x, _| (x as u32 >> 1) as i32;
            "shr 23" ints |a, _| a.shr::<23>(), |x, _| (x as u32 >> 23) as i32;
            "shr 31" ints |a, _| a.shr::<31>(), |x, _| (x as u32 >> 31) as i32;
            "count" ints |a, b| a.count(b.lt(a)), |x, y| x.wrapping_add(i32::from(y < x));
            "to_float" floats |a, _| a.to_float(), |x, _| x as f32;
            "as_float" ints |a, _| a.as_float().bits(), |x, _| x;
            "select_int" ints |a, b| lanes.select_int(a.lt(b), a, b), |x, y| if x < y { x } else { y };
            "select_negative" ints |a, b| lanes.select_negative(a, b.as_float(), (a ^ b).as_float()).bits(),
                |x, y| if x < 0 { y } else { x ^ y };
        }
    }
}
