//! The stated bounds hold on every backend, fused and strict.

use lobe_lane::{Kernel, Lanes};
use lobe_math::bounds::{self, Bound};

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

/// Applies a function of two arguments to slices whose length is a multiple of the lanes.
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

/// Directions all around, of very different lengths.
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
    // A bound far above what happens would hide a regression.
    assert!(abs >= bound.abs / 8.0, "{backend} {name}: absolute error {abs:e} is far under the stated {:e}", bound.abs);
}

fn check_all<L: Lanes>(lanes: L) {
    let name = if L::FUSED { format!("{}+fma", L::NAME) } else { L::NAME.to_string() };
    let apply = |function, x: &[f32], y: &[f32]| {
        let mut out = vec![0.0; x.len()];
        lanes.vectorize(Apply(function, x, y, &mut out));
        out
    };
    let xs = unit_interval();
    let unary = |function, truth: fn(f64) -> f64, xs: &[f32]| -> Vec<(f32, f64)> {
        apply(function, xs, xs).into_iter().zip(xs.iter().map(|&x| truth(x as f64))).collect()
    };
    check(&name, "acos", bounds::ACOS, unary(Function::Acos, f64::acos, &xs).into_iter());
    check(&name, "asin", bounds::ASIN, unary(Function::Asin, f64::asin, &xs).into_iter());
    check(&name, "paper", bounds::PAPER_ACOS, unary(Function::PaperAcos, f64::acos, &xs).into_iter());
    let truth = |t: f64| 2.0 * t.atan();
    check(&name, "double_atan", bounds::DOUBLE_ATAN, unary(Function::DoubleAtan, truth, &xs).into_iter());

    let (x, y) = directions();
    let truth = |x: f32, y: f32| (y as f64).atan2(x as f64);
    let all = || x.iter().zip(&y);
    let found = apply(Function::Atan2, &x, &y);
    check(&name, "atan2", bounds::ATAN2, found.into_iter().zip(all().map(|(&x, &y)| truth(x, y))));
    let found = apply(Function::Azimuth, &x, &y);
    let turn = |angle: f64| if angle < 0.0 { angle + std::f64::consts::TAU } else { angle };
    check(&name, "azimuth", bounds::AZIMUTH, found.into_iter().zip(all().map(|(&x, &y)| turn(truth(x, y)))));

    let small: Vec<f32> = (0..1 << 16).map(|i| i as f32 / (1 << 16) as f32 * std::f32::consts::FRAC_PI_4).collect();
    check(&name, "sin", bounds::SIN_COS, unary(Function::Sin, f64::sin, &small).into_iter());
    check(&name, "cos", bounds::SIN_COS, unary(Function::Cos, f64::cos, &small).into_iter());
    let wide: Vec<f32> = (0..1 << 16).map(|i| (i as f32 / (1 << 15) as f32 - 1.0) * 8192.0).collect();
    let only_abs = Bound { ulp: f64::INFINITY, ..bounds::SIN_COS };
    check(&name, "sin wide", only_abs, unary(Function::Sin, f64::sin, &wide).into_iter());
    check(&name, "cos wide", only_abs, unary(Function::Cos, f64::cos, &wide).into_iter());

    let fifth = |x: f64| x.powf(0.2);
    let parts: Vec<f32> = (0..1 << 16).map(|i| 10f64.powf(-30.0 * f64::from(i) / 65536.0) as f32).collect();
    check(&name, "fifth root", bounds::FIFTH_ROOT, unary(Function::FifthRoot, fifth, &parts).into_iter());
    let large: Vec<f32> = parts.iter().map(|x| 1.0 / x).collect();
    let only_ulp = Bound { abs: 1e6 * bounds::FIFTH_ROOT.abs, ..bounds::FIFTH_ROOT };
    check(&name, "fifth root", only_ulp, unary(Function::FifthRoot, fifth, &large).into_iter());
}

#[test]
fn scalar() {
    check_all(lobe_scalar::Scalar::<1>);
}

#[test]
fn emulated8() {
    check_all(lobe_scalar::Scalar::<8>);
}

#[cfg(target_arch = "x86_64")]
#[test]
fn sse2() {
    check_all(lobe_sse::Sse2::new());
}

#[cfg(target_arch = "x86_64")]
#[test]
fn avx2_fused_and_strict() {
    let Some(avx2) = lobe_avx::Avx2::detect() else {
        println!("SKIP: this CPU has no AVX2");
        return;
    };
    check_all(avx2);
    check_all(avx2.strict());
}

#[test]
fn special_values() {
    let x = [0.0, -0.0, 1.0, -1.0, 1.5, -1.5, f32::NAN, 0.5];
    let mut out = [0.0; 8];
    lobe_scalar::Scalar::<8>.vectorize(Apply(Function::Acos, &x, &x, &mut out));
    approx::assert_abs_diff_eq!(out[0], std::f32::consts::FRAC_PI_2, epsilon = 1e-7);
    assert_eq!((out[2], out[4]), (0.0, 0.0));
    assert_eq!((out[3], out[5]), (std::f32::consts::PI, std::f32::consts::PI));
    assert!(out[6].is_nan());

    let (x, y) = ([0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0]);
    lobe_scalar::Scalar::<8>.vectorize(Apply(Function::Azimuth, &x, &y, &mut out));
    use std::f32::consts::{FRAC_PI_2, PI, TAU};
    assert_eq!(&out[..5], &[0.0, 0.0, FRAC_PI_2, PI, TAU - FRAC_PI_2]);
}
