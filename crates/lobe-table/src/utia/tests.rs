use super::*;

/// The value is `theta_i + 10 theta_v` in degrees, plus 1000 for each step of `phi_v`.
fn material() -> Data {
    let value = |i: usize| {
        let (ti, tv, pv) = (i / (PHIS * THETAS * PHIS) % THETAS, i / PHIS % THETAS, i % PHIS);
        15.0 * ti as f64 + 150.0 * tv as f64 + 1000.0 * pv as f64
    };
    Data::new((0..3 * PLANE).map(value).collect()).expect("a valid table")
}

#[test]
fn zenith_angles_continue_beyond_the_last_up_to_the_horizon() {
    let value =
        |ti: f64, tv: f64| material().eval_angles([ti.to_radians(), 1.0], [tv.to_radians(), 0.0], Decode::Raw)[0];
    assert!((value(20.0, 31.0) - 330.0).abs() < 1e-9);
    assert!((value(85.0, 89.0) - 975.0).abs() < 1e-9);
    assert_eq!(value(20.0, 90.1), 0.0);
}

#[test]
fn azimuths_wrap() {
    let value = |phi: f64| material().eval_angles([0.0, 0.0], [0.0, phi.to_radians()], Decode::Raw)[1];
    assert!((value(355.0) - value(-5.0)).abs() < 1e-6);
    // Between the last azimuth, 352.5 degrees, and the first.
    assert!((value(356.25) - 0.5 * (47_000.0 + 0.0)).abs() < 1e-6);
    assert!(value(360.0).abs() < 1e-6 && value(-1e-300) == value(0.0));
}

#[test]
fn decoding_undoes_the_curve() {
    let flat =
        |v: f64| Data::new(vec![v; 3 * PLANE]).expect("valid").eval([0.0, 0.6, 0.8], [0.0, 0.0, 1.0], Decode::Srgb)[2];
    assert!((flat(140.0) - 100.0).abs() < 1e-9);
    assert!((flat(1.4) - 100.0 * 0.01 / 12.92).abs() < 1e-9);
    assert_eq!(flat(-5.0), 0.0);
}

#[test]
fn directions_are_angles() {
    let (sin, cos) = 0.5f64.sin_cos();
    let (a, b) = (material().eval([sin, 0.0, cos], [0.0, sin, cos], Decode::Raw), std::f64::consts::FRAC_PI_2);
    let expected = material().eval_angles([0.5, 0.0], [0.5, b], Decode::Raw);
    assert!((a[0] - expected[0]).abs() < 1e-9);
    assert!(Data::new(vec![0.0; 7]).is_err() && Data::new(vec![f64::NAN; 3 * PLANE]).is_err());
}
