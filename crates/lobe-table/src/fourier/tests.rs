//! Properties of series with any coefficients.

use super::data::{Data, Parts, Series};
use crate::{Aspect, Channels, Representation, Scatter, Side};

fn parts(mu: Vec<f32>) -> Parts {
    let knots = mu.len();
    let series = vec![Series { start: 0, count: 1 }; knots * knots];
    Parts { mu, series, coefficients: vec![0.25], channels: Channels::Mono, eta: 1.5 }
}

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// Splines pass through their knots and are exact for straight lines.
#[test]
fn values_at_knots_are_those_of_their_series() {
    let mu = vec![-1.0, -0.6, -0.3, 0.0, 0.0, 0.2, 0.7, 1.0];
    let mut parts = parts(mu.clone());
    let knots = mu.len();
    parts.coefficients = (0..2 * knots * knots).map(|at| ((at * 37) % 101) as f32 / 50.0 + 1.0).collect();
    parts.series = (0..knots * knots).map(|at| Series { start: 2 * at as u32, count: 2 }).collect();
    let data = Data::new(parts).expect("valid parts");
    for viewer in (0..knots).filter(|at| mu[*at] != 0.0) {
        for light in (0..knots).filter(|at| mu[*at] != 0.0) {
            let [theta_i, theta_o] = [-mu[light], mu[viewer]].map(|cos| f64::from(cos).acos());
            for phi in [0.3_f64, 2.0] {
                // Light travels away from its source: an azimuth of 0 between the directions is straight on.
                let found = data.eval(direction(theta_i, 0.5), direction(theta_o, 0.5 + std::f64::consts::PI + phi))[0];
                let series = data.coefficients(data.series(viewer, light), 0);
                let at_pole = mu[light].abs() == 1.0 || mu[viewer].abs() == 1.0;
                let cos = if at_pole { 1.0 } else { phi.cos() };
                let scale = data.aspect(viewer, light).map_or(0.0, |aspect| data.radiance(aspect));
                let wanted =
                    (f64::from(series[0]) + f64::from(series[1]) * cos).max(0.0) * scale / f64::from(mu[light].abs());
                assert!((found - wanted).abs() < 3e-7 * wanted.max(1.0), "{light} {viewer} {phi}: {found}, {wanted}");
            }
        }
    }
}

#[test]
fn sides_with_coefficients_have_values() {
    let mut parts = parts(vec![-1.0, -0.5, 0.5, 1.0]);
    for (at, series) in parts.series.iter_mut().enumerate() {
        // Only light that travels down and is reflected.
        if !(at / 4 >= 2 && at % 4 < 2) {
            *series = Series::default();
        }
    }
    let data = Data::new(parts).expect("valid parts");
    assert_eq!(data.aspects(), [Aspect::REFLECTION]);
    assert_eq!(data.sections().len(), 1);
    assert_eq!(data.incidences(Aspect::REFLECTION).len(), 2);
    assert!((data.eval([0.0, 0.0, 1.0], [0.0, 0.0, 1.0])[0] - 0.25).abs() < 1e-12);
    assert_eq!(data.eval([0.0, 0.0, -1.0], [0.0, 0.0, -1.0]), [0.0]);
}

/// Radiance grows with the square of the refractive index that it enters.
#[test]
fn radiance_changes_with_the_refractive_index() {
    let data = Data::new(parts(vec![-1.0, 1.0])).expect("valid parts");
    let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    for (wi, wo, wanted) in [(up, up, 0.25), (up, down, 0.25 * 2.25), (down, up, 0.25 / 2.25), (down, down, 0.25)] {
        assert!((data.eval(wi, wo)[0] - wanted).abs() < 1e-7, "{wi:?} {wo:?}");
    }
    let through = Aspect { scatter: Scatter::Transmission, light: Side::Back };
    assert_eq!(data.aspects().len(), 4);
    assert_eq!(data.incidences(through), [[0.0, 0.0]]);
    assert_eq!(data.eval(up, [1.0, 0.0, 0.0]), [0.0]);
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let refused = |change: &dyn Fn(&mut Parts), part: &str| {
        let mut parts = parts(vec![-1.0, 0.0, 0.0, 1.0]);
        assert!(Data::new(parts.clone()).is_ok());
        change(&mut parts);
        assert_eq!(Data::new(parts).expect_err(part).part, part);
    };
    refused(&|parts| parts.mu[3] = 1.1, "mu");
    refused(&|parts| parts.mu[1] = -1.0, "mu");
    refused(&|parts| parts.mu[3] = 0.0, "mu");
    refused(&|parts| parts.mu[0] = f32::NAN, "mu");
    refused(&|parts| parts.mu.truncate(1), "mu");
    refused(&|parts| parts.series.truncate(15), "series");
    refused(&|parts| parts.series[7] = Series { start: 1, count: 1 }, "series");
    refused(&|parts| parts.series[7] = Series { start: u32::MAX, count: u32::MAX }, "series");
    refused(&|parts| parts.channels = Channels::Rgb, "series");
    refused(&|parts| parts.channels = Channels::Xyz, "channels");
    refused(&|parts| parts.coefficients[0] = f32::INFINITY, "coefficients");
    refused(&|parts| parts.eta = 0.0, "eta");
}
