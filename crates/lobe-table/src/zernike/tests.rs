//! Properties of expansions with any terms.

use std::f64::consts::PI;

use super::reference::radial;
use super::{Data, Term};
use crate::Channels;

fn term(radial: [u8; 2], azimuthal: u8) -> Term {
    Term { radial, azimuthal, power: 0, coefficient: 1.0 }
}

fn direction(theta: f64, phi: f64) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

#[test]
fn polynomials_match_their_definition() {
    for rho in [0.0, 0.3, 0.8, 1.0_f64] {
        let square = rho * rho;
        assert!((radial(2, 0, rho) - (2.0 * square - 1.0)).abs() < 1e-15);
        assert!((radial(3, 1, rho) - (3.0 * square - 2.0) * rho).abs() < 1e-15);
        assert!((radial(4, 0, rho) - (6.0 * square * square - 6.0 * square + 1.0)).abs() < 1e-14);
        assert!((radial(5, 5, rho) - rho.powi(5)).abs() < 1e-15);
    }
    assert!((radial(15, 3, 1.0) - 1.0).abs() < 1e-10);
}

/// The first term alone is the same for all directions.
#[test]
fn the_first_term_is_lambertian_and_all_are_reciprocal() {
    let first = Data::new(vec![term([0, 0], 0)], Channels::Mono).expect("valid terms");
    let (wi, wo) = (direction(0.4, 0.2), direction(1.1, 2.0));
    assert!((first.eval(wi, wo)[0] - 1.0 / (2.0 * PI)).abs() < 1e-15);
    let terms = vec![term([2, 0], 0), term([3, 1], 1), term([4, 2], 2), term([5, 5], 3)];
    let all = Data::new(terms, Channels::Mono).expect("valid terms");
    assert!((all.eval(wi, wo)[0] - all.eval(wo, wi)[0]).abs() < 1e-15);
    assert_eq!(all.eval(wi, [0.6, 0.0, -0.8]), [0.0]);
}

/// What is listed for people are values of the expansion, also if a file repeats orders.
#[test]
fn values_on_a_grid_are_those_of_single_directions() {
    let powers = |(power, coefficient): (u8, f64)| Term { power, coefficient, ..term([5, 3], 1) };
    let mut terms: Vec<Term> = [(0, 1.0), (2, -0.5), (0, 0.25)].map(powers).into();
    terms.extend([term([0, 0], 0), term([4, 2], 2), term([2, 2], 2), term([3, 3], 3)]);
    let data = Data::new(terms, Channels::Spectral(vec![400.0, 900.0])).expect("valid terms");
    let (polar, azimuths) = ([0.0, 0.3, 1.5], [0.0, 1.1, PI]);
    let mut listed = data.on_grid(&polar, &azimuths).into_iter();
    for i in polar {
        for o in polar {
            for phi in azimuths {
                for wanted in data.eval(direction(i, 0.0), direction(o, phi)) {
                    let found = listed.next().expect("a value per channel and pair of directions");
                    assert!((found - wanted).abs() < 1e-12, "{found} instead of {wanted} at {i}, {o}, {phi}");
                }
            }
        }
    }
    assert_eq!(listed.next(), None);
}

/// Different terms are orthogonal over the disk of both directions, and all have the same norm.
#[test]
fn terms_are_orthonormal() {
    let terms = [term([0, 0], 0), term([2, 0], 0), term([2, 2], 0), term([1, 1], 1), term([3, 1], 1), term([2, 2], 2)];
    let of = |term: Term| Data::new(vec![term], Channels::Mono).expect("a valid term");
    const STEPS: usize = 24;
    let product = |a: &Data, b: &Data| {
        let mut sum = 0.0;
        for at in 0..STEPS * STEPS * STEPS {
            let [i, o, phi] = [at % STEPS, at / STEPS % STEPS, at / STEPS / STEPS];
            // Equal areas of the disk are equal steps of its squared radius, which is 1 - cos theta.
            let polar = |step: usize| (1.0 - (step as f64 + 0.5) / STEPS as f64).acos();
            let (wi, wo) = (direction(polar(i), 0.0), direction(polar(o), 2.0 * PI * phi as f64 / STEPS as f64));
            sum += a.eval(wi, wo)[0] * b.eval(wi, wo)[0];
        }
        sum / (STEPS * STEPS * STEPS) as f64
    };
    let norm = product(&of(terms[0]), &of(terms[0]));
    for (i, a) in terms.iter().enumerate() {
        for (j, b) in terms.iter().enumerate() {
            let wanted = if i == j { norm } else { 0.0 };
            let found = product(&of(*a), &of(*b));
            assert!((found - wanted).abs() < 0.02 * norm, "{a:?} {b:?}: {found} instead of {wanted}");
        }
    }
}

#[test]
fn terms_that_do_not_fit_are_refused() {
    let refused = |terms: Vec<Term>, channels: Channels, part: &str| {
        assert_eq!(Data::new(terms, channels).expect_err(part).part, part);
    };
    refused(Vec::new(), Channels::Mono, "terms");
    for radial in [[0, 2], [16, 0], [3, 2]] {
        refused(vec![term(radial, 0)], Channels::Mono, "terms");
    }
    refused(vec![term([2, 2], 1)], Channels::Mono, "terms");
    refused(vec![term([2, 0], 2)], Channels::Mono, "terms");
    for coefficient in [f64::NAN, 1e30] {
        refused(vec![Term { coefficient, ..term([0, 0], 0) }], Channels::Mono, "terms");
    }
    refused(vec![Term { power: 1, ..term([0, 0], 0) }], Channels::Mono, "channels");
    refused(vec![term([0, 0], 0)], Channels::Rgb, "channels");
    refused(vec![term([0, 0], 0)], Channels::Spectral(vec![-1.0]), "channels");
}
