//! Compares every method of a backend with plain scalar arithmetic, for values on which implementations differ.
//!
//! A backend crate calls [`conformance!`](crate::conformance!) with its tokens, which defines tests for them and for
//! their strict form.

mod arithmetic;
mod gathers;
mod masks;
mod memory;
mod short;
mod texels;

use lobe_lane::{Lanes, MAX_LANES};

pub use arithmetic::{FloatArithmetic, IntArithmetic};
pub use gathers::Gathers;
pub use masks::Masks;
pub use memory::Memory;
pub use short::refuses_short_slices;
pub use texels::Texels;

/// Defines the tests of a backend, with one module per token. A token is an `Option` as returned by detection; a
/// backend that this CPU lacks is reported as skipped.
///
/// ```
/// lobe_testing::conformance! {
///     scalar: Some(lobe_scalar::Scalar::<1>);
/// }
/// ```
#[macro_export]
macro_rules! conformance {
    ($($name:ident: $token:expr;)*) => {$(
        mod $name {
            use super::*;

            $crate::conformance! { @tests $token;
                float_arithmetic FloatArithmetic;
                int_arithmetic IntArithmetic;
                masks Masks;
                memory Memory;
                gathers Gathers;
                texels Texels;
            }

            #[test]
            fn short_slices_are_refused() {
                $crate::conformance::on($token, stringify!($name), $crate::conformance::Short);
            }
        }
    )*};
    (@tests $token:expr; $($test:ident $kernel:ident;)*) => {$(
        #[test]
        fn $test() {
            $crate::conformance::on($token, stringify!($test), $crate::conformance::Run($crate::conformance::$kernel));
        }
    )*};
}

/// The operations of [`conformance!`](crate::conformance!) on a token.
#[doc(hidden)]
pub trait Check {
    fn check<L: Lanes>(self, lanes: L);
}

/// Runs a kernel.
#[doc(hidden)]
#[derive(Clone, Copy)]
pub struct Run<K>(pub K);

impl<K: lobe_lane::Kernel<Out = ()>> Check for Run<K> {
    fn check<L: Lanes>(self, lanes: L) {
        lanes.vectorize(self.0);
    }
}

/// Passes slices that are too short.
#[doc(hidden)]
#[derive(Clone, Copy)]
pub struct Short;

impl Check for Short {
    fn check<L: Lanes>(self, lanes: L) {
        refuses_short_slices(lanes);
    }
}

#[doc(hidden)]
pub fn on<L: Lanes>(token: Option<L>, test: &str, check: impl Check + Copy) {
    match token {
        Some(lanes) => {
            let _culprit = crate::backends::Culprit(format!("{test} of {}", L::NAME));
            check.check(lanes);
            check.check(lanes.strict());
        }
        None => eprintln!("SKIPPED: this CPU cannot run {}", L::NAME),
    }
}

/// The lanes of `x`, followed by zeros.
#[inline(always)]
fn floats<L: Lanes>(lanes: L, x: L::F) -> [f32; MAX_LANES] {
    let mut buffer = [0.0; MAX_LANES];
    lanes.store(&mut buffer, x);
    buffer
}

/// The lanes of `x`, followed by zeros.
#[inline(always)]
fn ints<L: Lanes>(lanes: L, x: L::I) -> [i32; MAX_LANES] {
    let mut buffer = [0; MAX_LANES];
    lanes.store_int(&mut buffer, x);
    buffer
}

/// The lanes of `mask`, followed by `false`.
#[inline(always)]
fn truths<L: Lanes>(_lanes: L, mask: L::M) -> [bool; MAX_LANES] {
    let bits = lobe_lane::Mask::bits(mask);
    std::array::from_fn(|lane| bits >> lane & 1 == 1)
}

/// `true` if a result is the expected one.
trait Same: Copy + std::fmt::Debug {
    fn same(self, expected: Self) -> bool;
}

/// The same bits, or both NaN.
impl Same for f32 {
    fn same(self, expected: f32) -> bool {
        self.to_bits() == expected.to_bits() || (self.is_nan() && expected.is_nan())
    }
}

impl Same for i32 {
    fn same(self, expected: i32) -> bool {
        self == expected
    }
}

impl Same for bool {
    fn same(self, expected: bool) -> bool {
        self == expected
    }
}

/// # Panics
/// If the two differ.
fn assert_same<T: Same>(what: &str, operands: &[&dyn std::fmt::Debug], found: T, expected: T) {
    assert!(found.same(expected), "{what} of {operands:?}: {found:?}, not {expected:?}");
}
