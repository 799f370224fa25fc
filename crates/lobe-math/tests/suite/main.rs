//! The stated bounds hold on every backend, fused and strict.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use lobe_lane::{Kernel, Lanes, MAX_LANES};
use lobe_math::bounds::{self, Bound};
use lobe_scalar::Scalar;
use lobe_testing::backends::each;

#[derive(Clone, Copy)]
enum Function {
    Acos,
    Asin,
    PaperAcos,
    DoubleAtan,
    Atan2,
    Azimuth,
    Sin,
    Cos,
    FifthRoot,
}

/// Applies a function of two arguments to slices whose length is a multiple of the number of lanes.
struct Apply<'a>(Function, &'a [f32], &'a [f32], &'a mut [f32]);

impl Kernel for Apply<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Apply(function, x, y, out) = self;
        let mut at = 0;
        while at < x.len() {
            let (a, b) = (lanes.load(&x[at..]), lanes.load(&y[at..]));
            let value = match function {
                Function::Acos => lobe_math::acos(lanes, a),
                Function::Asin => lobe_math::asin(lanes, a),
                Function::PaperAcos => lobe_math::paper::acos(lanes, a),
                Function::DoubleAtan => lobe_math::double_atan(lanes, a),
                Function::Atan2 => lobe_math::atan2(lanes, b, a),
                Function::Azimuth => lobe_math::azimuth(lanes, b, a),
                Function::Sin => lobe_math::sin_cos(lanes, a).0,
                Function::Cos => lobe_math::sin_cos(lanes, a).1,
                Function::FifthRoot => lobe_math::fifth_root(lanes, a),
            };
            lanes.store(&mut out[at..], value);
            at += L::LANES;
        }
    }
}

/// `[-1, 1]` evenly, and densely near -1, 0 and 1.
fn unit_interval() -> Vec<f32> {
    let mut xs: Vec<f32> = (0..=1 << 16).map(|i| (i as f64 / (1 << 15) as f64 - 1.0) as f32).collect();
    for i in 0..1 << 14 {
        let small = f32::from_bits(0x3400_0000 - i * 4096);
        let near_one = f32::from_bits(1f32.to_bits() - i);
        xs.extend([small, -small, near_one, -near_one]);
    }
    xs.truncate(xs.len() / 16 * 16);
    xs
}

/// Vectors in all directions, of very different lengths.
fn directions() -> (Vec<f32>, Vec<f32>) {
    (0..1 << 16)
        .map(|i| {
            let (angle, length) = (i as f64 * 0.618, 10f64.powi(i % 13 - 6));
            ((length * angle.cos()) as f32, (length * angle.sin()) as f32)
        })
        .unzip()
}

fn check(backend: &str, name: &str, bound: Bound, pairs: impl Iterator<Item = (f32, f64)>) {
    let (mut abs, mut ulp) = (0f64, 0f64);
    for (found, truth) in pairs {
        let error = (found as f64 - truth).abs();
        assert!(!error.is_nan(), "{backend} {name}: {found} for {truth}");
        abs = abs.max(error);
        if truth.abs() > bounds::ULP_FROM {
            let step = (truth.abs() as f32).to_bits();
            ulp = ulp.max(error / (f32::from_bits(step + 1) as f64 - f32::from_bits(step) as f64));
        }
    }
    println!("{backend:>10} {name:<10} abs {abs:.3e} ulp {ulp:.2}");
    assert!(abs <= bound.abs, "{backend} {name}: absolute error {abs:e} over {:e}", bound.abs);
    assert!(ulp <= bound.ulp, "{backend} {name}: {ulp} ULP over {}", bound.ulp);
    // A bound far above the actual error would hide a regression.
    assert!(abs >= bound.abs / 8.0, "{backend} {name}: absolute error {abs:e} is far below the stated {:e}", bound.abs);
}

/// The lanes that run a function: a backend in one of its forms, or emulated lanes.
struct On<'a> {
    name: &'a str,
    run: &'a dyn Fn(Apply<'_>),
}

impl On<'_> {
    fn apply(&self, function: Function, x: &[f32], y: &[f32]) -> Vec<f32> {
        let mut out = vec![0.0; x.len()];
        (self.run)(Apply(function, x, y, &mut out));
        out
    }

    /// Checks a function of one argument at `xs`.
    fn unary(&self, name: &str, function: Function, bound: Bound, truth: fn(f64) -> f64, xs: &[f32]) {
        let found = self.apply(function, xs, xs);
        check(self.name, name, bound, found.into_iter().zip(xs.iter().map(|&x| truth(x as f64))));
    }
}

/// Every backend in every form, and eight emulated lanes.
fn everywhere(test: impl Fn(On<'_>)) {
    each(|backend| {
        let form = if backend.is_strict() { "" } else { "+fma" };
        test(On { name: &format!("{backend}{form}"), run: &|apply| backend.run(apply) });
    });
    test(On { name: "emulated8", run: &|apply| Scalar::<8>.vectorize(apply) });
}

#[test]
fn arc_cosines_and_sines() {
    let xs = unit_interval();
    everywhere(|on| {
        on.unary("acos", Function::Acos, bounds::ACOS, f64::acos, &xs);
        on.unary("asin", Function::Asin, bounds::ASIN, f64::asin, &xs);
        on.unary("paper", Function::PaperAcos, bounds::PAPER_ACOS, f64::acos, &xs);
    });
}

#[test]
fn arc_tangents() {
    let (xs, (x, y)) = (unit_interval(), directions());
    let truth = |(&x, &y): (&f32, &f32)| (y as f64).atan2(x as f64);
    let turn = |angle: f64| if angle < 0.0 { angle + std::f64::consts::TAU } else { angle };
    everywhere(|on| {
        on.unary("double_atan", Function::DoubleAtan, bounds::DOUBLE_ATAN, |t| 2.0 * t.atan(), &xs);
        let found = on.apply(Function::Atan2, &x, &y).into_iter();
        check(on.name, "atan2", bounds::ATAN2, found.zip(x.iter().zip(&y).map(truth)));
        let found = on.apply(Function::Azimuth, &x, &y).into_iter();
        check(on.name, "azimuth", bounds::AZIMUTH, found.zip(x.iter().zip(&y).map(truth).map(turn)));
    });
}

#[test]
fn sines_and_cosines() {
    let small: Vec<f32> = (0..1 << 16).map(|i| i as f32 / (1 << 16) as f32 * FRAC_PI_4).collect();
    let wide: Vec<f32> = (0..1 << 16).map(|i| (i as f32 / (1 << 15) as f32 - 1.0) * 8192.0).collect();
    let only_abs = Bound { ulp: f64::INFINITY, ..bounds::SIN_COS };
    everywhere(|on| {
        on.unary("sin", Function::Sin, bounds::SIN_COS, f64::sin, &small);
        on.unary("cos", Function::Cos, bounds::SIN_COS, f64::cos, &small);
        on.unary("sin wide", Function::Sin, only_abs, f64::sin, &wide);
        on.unary("cos wide", Function::Cos, only_abs, f64::cos, &wide);
    });
}

#[test]
fn fifth_roots() {
    let small: Vec<f32> = (0..1 << 16).map(|i| 10f64.powf(-30.0 * f64::from(i) / 65536.0) as f32).collect();
    let large: Vec<f32> = small.iter().map(|x| 1.0 / x).collect();
    let only_ulp = Bound { abs: 1e6 * bounds::FIFTH_ROOT.abs, ..bounds::FIFTH_ROOT };
    everywhere(|on| {
        on.unary("fifth root", Function::FifthRoot, bounds::FIFTH_ROOT, |x| x.powf(0.2), &small);
        on.unary("fifth root", Function::FifthRoot, only_ulp, |x| x.powf(0.2), &large);
    });
}

#[test]
fn special_values() {
    // As many as the widest backend has lanes.
    let mut arguments = [0.5; MAX_LANES];
    arguments[..7].copy_from_slice(&[0.0, -0.0, 1.0, -1.0, 1.5, -1.5, f32::NAN]);
    let (mut x, mut y) = ([0.0; MAX_LANES], [0.0; MAX_LANES]);
    x[..4].copy_from_slice(&[0.0, 1.0, 0.0, -1.0]);
    y[..5].copy_from_slice(&[0.0, 0.0, 1.0, 0.0, -1.0]);
    everywhere(|on| {
        let out = on.apply(Function::Acos, &arguments, &arguments);
        approx::assert_abs_diff_eq!(out[0], FRAC_PI_2, epsilon = 1e-7);
        assert_eq!((out[2], out[4]), (0.0, 0.0));
        assert_eq!((out[3], out[5]), (PI, PI));
        assert!(out[6].is_nan());
        assert_eq!(on.apply(Function::Azimuth, &x, &y)[..5], [0.0, 0.0, FRAC_PI_2, PI, TAU - FRAC_PI_2]);
    });
}
