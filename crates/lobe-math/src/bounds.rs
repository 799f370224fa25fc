//! The largest error of each function, in fused and in strict form, on every backend.
//!
//! Absolute errors are in radians (dimensionless for the sine and cosine). ULP errors count `f32` steps at the true
//! result; if the true result is below [`ULP_FROM`], only the absolute error is promised.

/// The largest absolute error of a function, and its largest error in units of the last place of the result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// Absolute error.
    pub abs: f64,
    /// Error in `f32` steps at the true result.
    pub ulp: f64,
}

/// Results smaller than this have no ULP bound.
pub const ULP_FROM: f64 = 1e-30;

/// The bound of [`acos`](crate::acos()) over `[-1, 1]`.
pub const ACOS: Bound = Bound { abs: 3.5e-7, ulp: 3.0 };
/// The bound of [`asin`](crate::asin) over `[-1, 1]`.
pub const ASIN: Bound = Bound { abs: 2e-7, ulp: 3.0 };
/// The bound of [`paper::acos`](crate::paper::acos) and [`paper::asin`](crate::paper::asin) over `[-1, 1]`. The paper's
/// formula is not accurate to the ULP anywhere near the ends; the figure is for the arc cosine.
pub const PAPER_ACOS: Bound = Bound { abs: 1.4e-4, ulp: 1.6e3 };
/// The bound of [`atan2`](crate::atan2()).
pub const ATAN2: Bound = Bound { abs: 4.5e-7, ulp: 3.0 };
/// The bound of [`azimuth`](crate::azimuth).
pub const AZIMUTH: Bound = Bound { abs: 6.5e-7, ulp: 3.0 };
/// The bound of [`double_atan`](crate::double_atan) over `[-1, 1]`.
pub const DOUBLE_ATAN: Bound = Bound { abs: 1.6e-7, ulp: 1.5 };
/// The bound of both results of [`sin_cos`](crate::sin_cos) for angles of up to 8192 rad. Near the zeros of either,
/// only the absolute bound applies; the ULP bound is for angles in `[0, pi/4]`.
pub const SIN_COS: Bound = Bound { abs: 1.5e-7, ulp: 2.0 };
/// The bound of [`fifth_root`](crate::fifth_root) of numbers in `[1e-30, 1e30]`; its error is relative, so the absolute
/// bound is for results of up to 1.
pub const FIFTH_ROOT: Bound = Bound { abs: 2e-7, ulp: 2.5 };
