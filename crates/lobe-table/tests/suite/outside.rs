//! Angles far outside, and NaN, do not reach a wrong cell or spoil a value.

use std::f64::consts::{PI, TAU};

use lobe_backend::Backend;
use lobe_lane::Lanes;
use lobe_scalar::Reference;
use lobe_table::{Axis, Channels, Edge, Edges, Scatter, specular};

const LANES: Reference = lobe_scalar::Scalar::<1>;

#[test]
fn queries_far_outside_belong_to_the_outermost_cells() {
    let graded = |n: usize| (0..n).map(|i| TAU * (i as f64 / (n - 1) as f64).powi(2)).collect::<Vec<_>>();
    let uniform: Vec<f64> = (0..10).map(|i| f64::from(i) * 0.5).collect();
    for knots in [uniform, graded(6), graded(80)] {
        let axis = Axis::new(&knots, Edge::Extrapolate).unwrap();
        let cell = |x: f32| LANES.extract_int(axis.cell(LANES, LANES.splat(x)).index, 0);
        for far in [7.0, 1e10, f32::MAX, f32::INFINITY] {
            assert_eq!(cell(far), knots.len() as i32 - 2, "{far} above {} knots", knots.len());
            assert_eq!(cell(-far), 0, "{far} below {} knots", knots.len());
        }
        assert_eq!(cell(f32::NAN), 0);
    }
}

/// A cell so narrow that the inverse of its width overflows `f32`.
#[test]
fn knots_as_close_as_denormals_give_finite_values() {
    let axis = Axis::new(&[0.0, 1e-40, 1.0, 1.5], Edge::Clamp).unwrap();
    for x in [0.0, 1e-40, 0.5] {
        let (_, [low, high]) = axis.weights(LANES, LANES.splat(x));
        assert!(LANES.extract(low, 0).is_finite() && LANES.extract(high, 0).is_finite());
    }
}

/// With every channel layout, and with a computed zenith, which is finite even if wi is not.
#[test]
fn invalid_directions_give_zero() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for channels in [1, 3, 9] {
        for scatter in [Scatter::Reflection, Scatter::Transmission] {
            let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 1.0, PI], vec![0.0, 2.0, 5.0]];
            let kind = if channels == 1 { Channels::Mono } else { Channels::Spectral(vec![500.0; channels]) };
            let mut samples = specular::Data::new(scatter, knots, kind, vec![1.0; 18 * channels]).unwrap();
            if scatter == Scatter::Transmission {
                samples = samples.with_refraction(vec![0.0, -0.3]).unwrap();
            }
            let table = specular::Table::new(&samples, &Edges::extrapolate()).unwrap();
            for bad in bad {
                for axis in 0..3 {
                    let (up, mut broken) = ([0.0, 0.6, 0.8], [0.0, 0.6, 0.8]);
                    broken[axis] = bad;
                    for (wi, wo) in [(broken, up), (up, broken), (broken, broken)] {
                        let mut out = vec![7.0; channels];
                        table.eval(Backend::scalar(), wi, wo, &mut out);
                        assert!(out.iter().all(|&x| x == 0.0), "{wi:?} {wo:?} {scatter:?}: {out:?}");
                    }
                }
            }
        }
    }
}
