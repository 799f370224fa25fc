//! Runs tests on every backend of this CPU in each of its forms, and on emulated widths.

use std::fmt;
use std::io::Write as _;

use lobe_lane::{Kernel, Lanes};
use lobe_scalar::Scalar;

pub use lobe_backend::Backend;

/// Defines tests whose body runs on every backend of this CPU, in strict and in fused form; a failure names both the
/// backend and the form.
///
/// ```
/// # use lobe_lane::Lanes;
/// lobe_testing::on_every_backend! {
///     fn it_has_a_name(backend) {
///         assert!(!backend.name().is_empty());
///     }
/// }
/// ```
#[macro_export]
macro_rules! on_every_backend {
    ($($(#[$attribute:meta])* fn $name:ident($backend:ident) $body:block)*) => {$(
        $(#[$attribute])*
        #[test]
        fn $name() {
            $crate::backends::each(|$backend: $crate::backends::Backend| $body);
        }
    )*};
}

/// Defines tests whose body is a kernel, generic over the lanes, that runs on every backend of this CPU, in strict and
/// in fused form, and on emulated widths of 2 to 16 lanes.
///
/// ```
/// # use lobe_lane::{Floats, Lanes};
/// lobe_testing::on_all_lanes! {
///     fn halves_are_exact<L>(lanes) {
///         let half = lanes.splat(1.0) / lanes.splat(2.0);
///         assert_eq!(lanes.extract(half, 0), 0.5);
///     }
/// }
/// ```
#[macro_export]
macro_rules! on_all_lanes {
    ($($(#[$attribute:meta])* fn $name:ident<$lane_type:ident>($lanes:ident) $body:block)*) => {$(
        $(#[$attribute])*
        #[test]
        fn $name() {
            #[derive(Clone, Copy)]
            struct Body;

            impl lobe_lane::Kernel for Body {
                type Out = ();

                #[inline(always)]
                fn run<$lane_type: lobe_lane::Lanes>(self, $lanes: $lane_type) $body
            }

            $crate::backends::each_lanes(Body);
        }
    )*};
}

/// Runs `body` on every backend of this CPU, in strict form and, if it differs, in fused form. Reports the backends
/// that this CPU lacks, and the one on which a failure happened.
pub fn each(mut body: impl FnMut(Backend)) {
    report_missing();
    for backend in Backend::forms() {
        let form = if backend.is_strict() { "strict" } else { "fused" };
        let _culprit = Culprit(format_args!("{backend}, {form}").to_string());
        body(backend);
    }
}

/// Runs a kernel like [`each`], and also on emulated widths of 2, 4, 8 and 16 lanes.
pub fn each_lanes<K: Kernel<Out = ()> + Copy>(kernel: K) {
    each(|backend| backend.run(kernel));
    on(Scalar::<2>, kernel);
    on(Scalar::<4>, kernel);
    on(Scalar::<8>, kernel);
    on(Scalar::<16>, kernel);
}

fn on<L: Lanes>(lanes: L, kernel: impl Kernel<Out = ()>) {
    let _culprit = Culprit(L::NAME.into());
    lanes.vectorize(kernel);
}

/// Bypasses the test harness, which hides the output of passing tests.
fn report_missing() {
    let available = Backend::available();
    for name in Backend::ALL.iter().filter(|name| available.iter().all(|backend| backend.name() != **name)) {
        let _ = writeln!(std::io::stderr(), "SKIPPED: this CPU cannot run {name}");
    }
}

/// Names the backend of a test if the test fails.
pub(crate) struct Culprit(pub(crate) String);

impl Drop for Culprit {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("failed on {}", self.0);
        }
    }
}

impl fmt::Debug for Culprit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn every_form_of_every_backend_is_run_once() {
        let mut seen = Vec::new();
        each(|backend| seen.push((backend.name(), backend.is_strict())));
        assert_eq!(seen.len(), Backend::forms().len());
        assert!(Backend::available().iter().all(|backend| seen.contains(&(backend.name(), true))));
    }

    #[test]
    fn kernels_run_on_every_width() {
        static WIDTHS: Mutex<Vec<usize>> = Mutex::new(Vec::new());

        #[derive(Clone, Copy)]
        struct Width;
        impl Kernel for Width {
            type Out = ();

            #[inline(always)]
            fn run<L: Lanes>(self, _lanes: L) {
                WIDTHS.lock().unwrap().push(L::LANES);
            }
        }

        each_lanes(Width);
        let widths = WIDTHS.lock().unwrap();
        assert!([1, 2, 4, 8, 16].iter().all(|width| widths.contains(width)), "{widths:?}");
    }
}
