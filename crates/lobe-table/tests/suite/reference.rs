//! The reference evaluation: policies at the edges, the horizon, and degenerate input.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe_table::specular::coords::angles_to_directions;
use lobe_table::specular::reference::{eval, eval_angles, zenith};
use lobe_table::{Channels, Edge, Edges, Scatter, specular};

fn table(knots: [&[f64]; 4], f: impl Fn([f64; 4]) -> f64) -> specular::Data {
    let mut values = Vec::new();
    for &sigma in knots[0] {
        for &psi in knots[1] {
            for &theta in knots[2] {
                for &phi in knots[3] {
                    values.push(f([sigma, psi, theta, phi]) as f32);
                }
            }
        }
    }
    specular::Data::new(Scatter::Reflection, knots.map(|k| k.to_vec()), Channels::Mono, values).unwrap()
}

fn at(samples: &specular::Data, edges: &Edges, angles: [f64; 4]) -> f64 {
    let mut out = [f64::NAN];
    eval_angles(samples, edges, angles, &mut out);
    out[0]
}

fn all(edge: Edge) -> Edges {
    Edges { axes: [edge; 4], non_negative: false }
}

/// A function that is linear in each angle is reproduced exactly, up to the rounding of stored values to `f32`.
#[test]
fn multilinear_functions_are_exact_between_the_knots() {
    let knots: [&[f64]; 4] = [&[0.0, 0.1, 0.9, 1.5], &[0.0, 2.0, 5.0], &[0.0, 0.02, 0.1, 3.0], &[0.0, 1.0, TAU]];
    let f = |[s, p, t, h]: [f64; 4]| (1.0 + s) * (2.0 - 0.1 * p) * (1.0 + t) * (1.0 + 0.5 * h);
    let samples = table(knots, f);
    for s in [0.0, 0.05, 0.7, 1.5] {
        for p in [0.3, 4.9] {
            for t in [0.001, 0.05, 2.0, 3.0] {
                for h in [0.0, 0.5, 6.0] {
                    let (got, expected) = (at(&samples, &Edges::default(), [s, p, t, h]), f([s, p, t, h]));
                    assert!((got - expected).abs() < 1e-6 * expected, "{got} is not {expected}");
                }
            }
        }
    }
}

#[test]
fn each_policy_outside_the_knots() {
    let line = table([&[0.2, 0.4], &[0.0], &[0.0], &[0.0]], |[s, ..]| 10.0 * s);
    let sigma = |edge, s| at(&line, &all(edge), [s, 0.0, 0.0, 0.0]);
    assert!((sigma(Edge::Clamp, 0.1) - 2.0).abs() < 1e-6 && (sigma(Edge::Clamp, 1.0) - 4.0).abs() < 1e-6);
    assert!((sigma(Edge::Extrapolate, 0.1) - 1.0).abs() < 1e-6 && (sigma(Edge::Extrapolate, 1.0) - 10.0).abs() < 1e-6);
    assert_eq!((sigma(Edge::Zero, 0.1), sigma(Edge::Zero, 1.0)), (0.0, 0.0));
    // Rounding of the file or of the angle does not count as outside.
    assert!(sigma(Edge::Zero, 0.2 - 9e-7) > 1.9 && sigma(Edge::Zero, 0.4 + 9e-7) > 3.9);
    assert_eq!(sigma(Edge::Zero, 0.2 - 2e-6), 0.0);
}

#[test]
fn an_axis_with_one_knot_is_constant_whatever_its_policy() {
    let flat = table([&[0.5], &[1.0], &[0.3], &[2.0]], |_| 7.0);
    for edge in [Edge::Clamp, Edge::Extrapolate, Edge::Zero, Edge::Periodic] {
        assert_eq!(at(&flat, &all(edge), [1.2, 3.0, 2.0, 0.0]), 7.0);
    }
}

#[test]
fn a_periodic_axis_closes_its_gap() {
    // Knots 0.5, 2 and 5: the gap from 5 to 0.5 + 2 pi is another cell.
    let open = table([&[0.0], &[0.0], &[0.0], &[0.5, 2.0, 5.0]], |[.., h]| h);
    let phi = |h| at(&open, &all(Edge::Periodic), [0.0, 0.0, 0.0, h]);
    let gap = 0.5 + TAU - 5.0;
    for h in [5.0, 5.7, 6.2, 6.7] {
        let expected = 5.0 + (0.5 - 5.0) * (h - 5.0) / gap;
        assert!((phi(h) - expected).abs() < 1e-6, "phi {h}");
        assert!((phi(h - TAU) - expected).abs() < 1e-6, "phi {h} a turn back");
        assert!((phi(h + TAU) - expected).abs() < 1e-6, "phi {h} a turn on");
    }
    assert!((phi(1.0) - 1.0).abs() < 1e-6);
    // A last knot at the full turn, rounded in its file, leaves no gap.
    let full = table([&[0.0], &[0.0], &[0.0], &[0.0, PI, TAU - 5e-7]], |[.., h]| h);
    assert!((at(&full, &all(Edge::Periodic), [0.0, 0.0, 0.0, TAU - 1e-9]) - TAU).abs() < 1e-5);
    assert!(at(&full, &all(Edge::Periodic), [0.0, 0.0, 0.0, TAU + 1e-9]).abs() < 1e-5);
}

#[test]
fn negative_results_are_kept_or_clamped() {
    let line = table([&[0.0, 1.0], &[0.0], &[0.0], &[0.0]], |[s, ..]| 1.0 - 2.0 * s);
    assert_eq!(at(&line, &Edges::default(), [1.0, 0.0, 0.0, 0.0]), 0.0);
    assert_eq!(at(&line, &Edges::extrapolate(), [1.0, 0.0, 0.0, 0.0]), -1.0);
}

#[test]
fn reflection_is_zero_at_and_below_the_horizon() {
    let flat = table([&[0.0, 1.5], &[0.0], &[0.0], &[0.0]], |_| 1.0);
    let value = |wi, wo| {
        let mut out = [f64::NAN];
        eval(&flat, &Edges::default(), wi, wo, &mut out);
        out[0]
    };
    let (up, down, level) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]);
    assert_eq!(value(up, up), 1.0);
    for (wi, wo) in [(up, down), (down, up), (down, down), (level, up), (up, level)] {
        assert_eq!(value(wi, wo), 0.0, "{wi:?} {wo:?}");
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(value([bad, 0.0, 1.0], up), 0.0);
        assert_eq!(value(up, [0.0, 0.0, bad]), 0.0);
    }
}

#[test]
fn transmission_accepts_either_side() {
    let flat = specular::Data::new(
        Scatter::Transmission,
        [vec![0.0], vec![0.0], vec![0.0], vec![0.0]],
        Channels::Mono,
        vec![3.0],
    );
    let flat = flat.unwrap();
    let value = |wi, wo| {
        let mut out = [f64::NAN];
        eval(&flat, &Edges::default(), wi, wo, &mut out);
        out[0]
    };
    let (up, down) = ([0.6, 0.0, 0.8], [0.6, 0.0, -0.8]);
    for (wi, wo) in [(up, up), (up, down), (down, up), (down, down)] {
        assert_eq!(value(wi, wo), 3.0);
    }
    assert_eq!(value(up, [1.0, 0.0, 0.0]), 0.0);
}

#[test]
fn refraction_offsets_move_the_zenith() {
    let sigmas = vec![0.0, 1.0];
    let samples = specular::Data::new(
        Scatter::Transmission,
        [sigmas, vec![0.0], vec![0.0, PI], vec![0.0]],
        Channels::Mono,
        vec![1.0, 0.0, 1.0, 0.0],
    )
    .unwrap()
    .with_refraction(vec![0.0, -0.4])
    .unwrap();
    let edges = Edges::default();
    assert!((zenith(&samples, &edges, 0.5) - 0.3).abs() < 1e-15);
    assert!((zenith(&samples, &edges, 1.5) - 1.1).abs() < 1e-15, "the offset is clamped with sigma");
    assert!((zenith(&samples, &Edges::extrapolate(), 1.5) - 0.9).abs() < 1e-15);
    assert!(zenith(&samples, &edges, FRAC_PI_2) <= FRAC_PI_2);
    // The peak, at theta 0, is along the refracted ray.
    let (wi, wo) = angles_to_directions([0.5, 0.0, 0.0, 0.0], |_| 0.3);
    let mut out = [0.0];
    eval(&samples, &edges, wi, [wo[0], wo[1], -wo[2]], &mut out);
    assert!((out[0] - 1.0).abs() < 1e-12);
}
