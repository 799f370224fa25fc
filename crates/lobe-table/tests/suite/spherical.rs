//! Grids and scattered measurements in spherical coordinates.

use std::f64::consts::{FRAC_PI_2, TAU};

use lobe_table::scattered::{self, ScatteredError};
use lobe_table::{Channels, GridError, Scatter, spherical};

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// A function of the four angles that is linear in both polar angles.
fn f([theta_i, phi_i, theta_o, phi_o]: [f64; 4]) -> f32 {
    (1.0 + theta_i + 0.5 * theta_o * (phi_o - phi_i).cos() + 0.2 * theta_i * (2.0 * phi_i).cos()) as f32
}

fn steps(count: usize, limit: f64) -> Vec<f64> {
    (0..count).map(|index| limit * index as f64 / (count - 1) as f64).collect()
}

fn samples(azimuths: &[f64]) -> Vec<[f64; 4]> {
    let mut angles = Vec::new();
    for &theta_i in &steps(7, 1.5) {
        for &phi_i in azimuths {
            for &theta_o in &steps(10, FRAC_PI_2) {
                angles.extend(steps(25, TAU).into_iter().map(|phi_o| [theta_i, phi_i, theta_o, phi_o]));
            }
        }
    }
    angles
}

#[test]
fn a_grid_is_exact_at_its_knots_and_periodic() {
    let knots = [steps(4, 1.2), steps(9, TAU)[..8].to_vec(), steps(5, FRAC_PI_2), steps(13, TAU)[..12].to_vec()];
    let mut values = Vec::new();
    for &theta_i in &knots[0] {
        for &phi_i in &knots[1] {
            for &theta_o in &knots[2] {
                values.extend(knots[3].iter().map(|&phi_o| f([theta_i, phi_i, theta_o, phi_o])));
            }
        }
    }
    let grid = spherical::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a grid");
    let at = |a: [f64; 4]| grid.eval(direction(a[0], a[1]), direction(a[2], a[3]))[0] as f32;
    for angles in [[0.4, TAU / 8.0, FRAC_PI_2 / 4.0, TAU / 12.0], [1.2, -TAU / 8.0, FRAC_PI_2 / 2.0, -TAU / 12.0]] {
        assert!((at(angles) - f(angles)).abs() < 1e-6, "{angles:?}");
    }
    // Halfway across the seam, in both azimuths.
    let (a, b) = ([0.4, -TAU / 16.0, FRAC_PI_2 / 2.0, 0.0], [0.4, 0.0, FRAC_PI_2 / 2.0, -TAU / 24.0]);
    let mean = |low: [f64; 4], high: [f64; 4]| 0.5 * (f(low) + f(high));
    assert!((at(a) - mean([0.4, 7.0 * TAU / 8.0, a[2], 0.0], [0.4, 0.0, a[2], 0.0])).abs() < 1e-6);
    assert!((at(b) - mean([0.4, 0.0, b[2], 11.0 * TAU / 12.0], [0.4, 0.0, b[2], 0.0])).abs() < 1e-6);
    assert!((at([1.5, 0.0, 0.3, 0.0]) - at([1.2, 0.0, 0.3, 0.0])).abs() < 1e-6, "held beyond the last knot");
    assert_eq!(grid.eval(direction(0.4, 0.0), [0.0, 0.0, -1.0]), [0.0]);
}

#[test]
fn a_grid_with_one_azimuth_of_incidence_is_isotropic() {
    let knots = [vec![0.0, 1.0], vec![TAU / 4.0], vec![0.0, 1.0], steps(5, TAU)];
    let values = (0..20).map(|at| at as f32).collect();
    let grid = spherical::Data::new(Scatter::Transmission, knots, Channels::Mono, values).expect("a grid");
    let below =
        |theta: f64, phi: f64| direction(theta, phi).map(|x| x * [1.0, 1.0, -1.0][usize::from(x == theta.cos()) * 2]);
    let wanted = grid.eval(direction(0.5, TAU / 4.0), below(0.7, 2.0));
    let turned = grid.eval(direction(0.5, TAU / 4.0 + 1.0), below(0.7, 3.0));
    assert!((wanted[0] - turned[0]).abs() < 1e-5 && wanted[0] > 0.0, "{wanted:?} {turned:?}");
    assert_eq!(grid.eval(direction(0.5, 0.0), direction(0.5, 0.0)), [0.0]);
}

/// `100 theta_i + 10 theta_o + phi` in steps of the knots.
#[test]
fn half_a_grid_is_mirrored() {
    let quarter = FRAC_PI_2 / 2.0;
    let knots = [vec![0.0, quarter], vec![0.0], vec![0.0, quarter], vec![0.0, TAU / 4.0, TAU / 2.0]];
    let values = (0..12).map(|i| (100 * (i / 6) + 10 * (i / 3 % 2) + i % 3) as f32).collect();
    let grid = spherical::Data::new(Scatter::Reflection, knots.clone(), Channels::Mono, values).expect("a grid");
    let grid = grid.mirrored().expect("half a grid");
    let at = |turn: f64| grid.eval(direction(quarter, 1.0), direction(quarter / 2.0, 1.0 + turn))[0];
    for turn in [0.0, 0.3, TAU / 4.0, 3.0, TAU / 2.0] {
        let wanted = 105.0 + 4.0 * turn / TAU;
        assert!((at(turn) - wanted).abs() < 1e-4, "{} for {wanted}", at(turn));
        assert!((at(-turn) - wanted).abs() < 1e-4 && (at(turn + TAU) - wanted).abs() < 1e-4);
    }
    let beyond = |axis: usize, angles: &[f64]| {
        let mut knots = knots.clone();
        knots[axis] = angles.to_vec();
        let values = vec![0.0; knots.iter().map(Vec::len).product()];
        let grid = spherical::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a grid");
        grid.mirrored().expect_err("no half")
    };
    assert!(matches!(beyond(3, &[0.0, 3.3]), GridError::KnotOutOfRange { axis: "phi_o", index: 1, .. }));
    assert!(matches!(beyond(1, &[0.0, 1.0]), GridError::KnotOutOfRange { axis: "phi_i", index: 1, .. }));
}

#[test]
fn bad_grids_are_refused() {
    let new = |theta_i: Vec<f64>, count: usize| {
        let knots = [theta_i, vec![0.0], vec![0.0], vec![0.0]];
        spherical::Data::new(Scatter::Reflection, knots, Channels::Mono, vec![1.0; count])
    };
    assert!(new(vec![0.0, 1.0], 2).is_ok());
    assert!(matches!(new(vec![], 0), Err(GridError::NoKnots { axis: "theta_i" })));
    assert!(matches!(new(vec![0.0, 1.0], 3), Err(GridError::ValueCount { .. })));
    assert!(matches!(new(vec![1.0, 1.0], 2), Err(GridError::KnotsNotAscending { .. })));
    assert!(matches!(new(vec![0.0, 2.0], 2), Err(GridError::KnotOutOfRange { .. })));
    assert!(matches!(new(vec![f64::NAN], 1), Err(GridError::KnotNotFinite { .. })));
}

#[test]
fn scattered_samples_are_reproduced_and_interpolated() {
    for azimuths in [vec![0.3], steps(13, TAU)] {
        let angles = samples(&azimuths);
        let values: Vec<f32> = angles.iter().map(|&a| f(a)).collect();
        let data = scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &values).expect("samples");
        assert_eq!(data.is_isotropic(), azimuths.len() == 1);
        let (mut at_samples, mut between) = (0.0_f32, 0.0_f32);
        for &[theta_i, phi_i, theta_o, phi_o] in angles.iter().step_by(3) {
            // At the pole of incidence, no direction has an azimuth.
            if theta_o > 1.5 || theta_i == 0.0 {
                continue;
            }
            let eval = |a: [f64; 4]| data.eval(direction(a[0], a[1]), direction(a[2], a[3]))[0];
            let here = [theta_i, phi_i, theta_o, phi_o];
            at_samples = at_samples.max((eval(here) - f(here)).abs());
            let off = [theta_i, phi_i, theta_o + 0.03, phi_o + 0.05];
            between = between.max((eval(off) - f(off)).abs());
        }
        println!("{} azimuths: {at_samples:.1e} at samples, {between:.1e} between", azimuths.len());
        assert!(at_samples < 1e-5, "{at_samples}");
        assert!(between < 0.01, "{between}");
    }
}

#[test]
fn a_peak_moves_with_the_mirror_direction() {
    let peak = |[theta_i, _, theta_o, phi_o]: [f64; 4]| {
        let (wo, mirror) = (direction(theta_o, phi_o), direction(theta_i, TAU / 2.0));
        let cos: f64 = wo.iter().zip(mirror).map(|(a, b)| a * b).sum();
        (-(1.0 - cos) / 0.01).exp() as f32
    };
    let mut angles = Vec::new();
    for theta_i in [0.2, 0.8] {
        for theta_o in steps(91, FRAC_PI_2) {
            angles.extend(steps(73, TAU).into_iter().map(|phi_o| [theta_i, 0.0, theta_o, phi_o]));
        }
    }
    let values: Vec<f32> = angles.iter().map(|&a| peak(a)).collect();
    let data = scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &values).expect("samples");
    let at_mirror = data.eval(direction(0.5, 1.0), direction(0.5, 1.0 + TAU / 2.0))[0];
    let at_ghost = data.eval(direction(0.5, 1.0), direction(0.2, 1.0 + TAU / 2.0))[0];
    assert!(at_mirror > 0.95 && at_ghost < 0.05, "{at_mirror} at the mirror direction, {at_ghost} next to it");
}

#[test]
fn half_a_measurement_is_mirrored() {
    let angles: Vec<[f64; 4]> = samples(&[0.0]).into_iter().filter(|a| a[3] <= TAU / 2.0 + 1e-9).collect();
    let values: Vec<f32> = angles.iter().map(|&a| f(a)).collect();
    let data = scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &values).expect("samples");
    let (left, right) = (direction(0.8, 1.0), direction(0.8, -1.0));
    let wi = direction(0.5, 0.0);
    assert!((data.eval(wi, left)[0] - data.eval(wi, right)[0]).abs() < 1e-6);
    assert!((data.eval(wi, left)[0] - f([0.5, 0.0, 0.8, 1.0])).abs() < 0.02);
}

#[test]
fn bad_samples_are_refused() {
    let new = |angles: &[[f64; 4]], values: &[f32]| {
        scattered::Data::new(Scatter::Reflection, Channels::Mono, angles, values).map(|_| ()).expect_err("a refusal")
    };
    assert_eq!(new(&[], &[]), ScatteredError::Empty);
    assert_eq!(new(&[[0.0; 4]], &[]), ScatteredError::ValueCount { found: 0, expected: 1 });
    assert!(matches!(new(&[[0.0; 4]], &[f32::NAN]), ScatteredError::ValueNotFinite { sample: 0, .. }));
    let angle = new(&[[0.0; 4], [0.0, 0.0, 1.6, 0.0]], &[1.0, 1.0]);
    assert_eq!(angle, ScatteredError::Angle { name: "theta_o", sample: 1, angle: 1.6 });
}

/// Zero, a turn, and an angle that rounding leaves just below it are the same azimuth; so are all azimuths so near the
/// pole that the directions hardly differ.
#[test]
fn azimuths_have_no_seam() {
    for [a, b] in [[0.0, -1e-18], [0.0, TAU - 1e-9], [1.0, 1.0 + TAU], [0.5, 0.5 - 3.0 * TAU]] {
        let angles = [[0.4, a, 0.2, 1.0], [0.4, b, 0.3, 2.0], [0.4, 2.5, 0.2, 1.0]];
        let data =
            scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &[1.0, 2.0, 3.0]).expect("samples");
        assert_eq!(data.incidences().len(), 2, "{a} and {b}");
        let data =
            scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles[..2], &[1.0, 2.0]).expect("samples");
        assert!(data.is_isotropic(), "{a} and {b}");
    }
    let angles = [[3e-6, 0.0, 0.2, 1.0], [3e-6, 1e-3, 0.3, 2.0], [0.4, 2.5, 0.2, 1.0]];
    let data = scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &[1.0, 2.0, 3.0]).expect("samples");
    assert_eq!(data.incidences().map(|[theta, _]| theta).collect::<Vec<_>>(), [3e-6, 0.4]);
}
