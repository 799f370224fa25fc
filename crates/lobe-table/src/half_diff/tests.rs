use std::f64::consts::PI;

use super::*;
use crate::direction::spherical;

/// Directions with these coordinates: the half vector at azimuth 0, `wi` turned away from it.
fn pair(theta_h: f64, theta_d: f64, phi_d: f64) -> ([f64; 3], [f64; 3]) {
    let tilt = |[x, y, z]: [f64; 3]| {
        let (sin, cos) = theta_h.sin_cos();
        [cos * x + sin * z, y, cos * z - sin * x]
    };
    (tilt(spherical(theta_d, phi_d)), tilt(spherical(theta_d, phi_d + PI)))
}

fn table(bins: [usize; 3], value: impl Fn(usize) -> f32) -> Data {
    Data::new(bins, (0..3 * bins.iter().product::<usize>()).map(value).collect()).expect("a valid table")
}

#[test]
fn the_middle_of_a_bin_has_its_value_in_both_modes() {
    for bins in [[4, 5, 6], [4, 5, 20]] {
        let table = table(bins, |i| i as f32);
        for (h, d, p) in [(0, 0, 0), (1, 2, 3), (2, 1, 5), (1, 0, bins[2] - 1)] {
            let middle = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
            let (wi, wo) = pair(
                middle(h, bins[0]).powi(2) * PI / 2.0,
                middle(d, bins[1]) * PI / 2.0,
                middle(p, bins[2]) * table.period(),
            );
            if wi[2] <= 0.0 || wo[2] <= 0.0 {
                continue;
            }
            assert_eq!(table.bin(wi, wo), [h, d, p]);
            let stored = table.texel([h, d, p]).map(f64::from);
            assert_eq!(table.eval_nearest(wi, wo), stored);
            let linear = table.eval_linear(wi, wo);
            assert!((0..3).all(|c| (linear[c] - stored[c]).abs() < 1e-9), "{linear:?} {stored:?}");
        }
    }
}

#[test]
fn half_a_turn_of_phi_d_only_swaps_the_directions() {
    let reciprocal = table([4, 5, 6], |i| i as f32);
    let (wi, wo) = pair(0.3, 0.5, 1.2);
    assert_eq!(reciprocal.bin(wi, wo), reciprocal.bin(wo, wi));
    let (a, b) = (reciprocal.eval_linear(wi, wo), reciprocal.eval_linear(wo, wi));
    assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-9));
    let directed = table([4, 5, 20], |i| i as f32);
    assert_ne!(directed.bin(wi, wo), directed.bin(wo, wi));
}

#[test]
fn unmeasured_bins_are_left_out() {
    let gaps = table([4, 5, 6], |i| if i % 2 == 0 { -1.0 } else { 3.0 });
    let (wi, wo) = pair(0.3, 0.5, 1.2);
    assert!(gaps.eval_linear(wi, wo).iter().all(|value| (value - 3.0).abs() < 1e-12));
    let dark = table([4, 5, 6], |_| -1.0);
    assert_eq!((dark.eval_linear(wi, wo), dark.eval_nearest(wi, wo)), ([0.0; 3], [0.0; 3]));
    assert_eq!(gaps.eval_nearest(wi, [0.0, 0.6, -0.8]), [0.0; 3]);
}

#[test]
fn the_last_bins_include_their_upper_ends() {
    let table = table([4, 5, 6], |i| i as f32);
    assert_eq!(table.bin([1.0, 0.0, 1e-17], [-1.0, 0.0, 1e-17])[1], 4);
    assert_eq!(table.bin([1.0, 0.0, 0.0], [1.0, 0.0, 0.0])[0], 3);
    // A `phi_d` just below zero is just below the period.
    let (wi, wo) = pair(0.3, 0.5, -1e-17);
    assert!(table.bin(wi, wo)[2] < 6);
}

#[test]
fn errors_name_the_wrong_part() {
    assert_eq!(Data::new([0, 5, 6], vec![]).expect_err("no bins").part, "dims");
    assert_eq!(Data::new([1, 1, 1], vec![0.0; 2]).expect_err("two values").part, "values");
    assert_eq!(Data::new([1, 1, 1], vec![f32::NAN; 3]).expect_err("NaN").part, "values");
}
