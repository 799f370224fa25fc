//! Values near the limits of `f32`, which a file may contain.

use lobe::{Channels, Data, Given, Material, Options, Sampled, Scatter};
use lobe_table::{scattered, spherical};

use super::materials::sampler;
use super::{cosine, incidents, numbers};

fn materials(value: f32) -> Vec<Data> {
    let angle = |k: usize, of: f64| (k as f64 * 0.754_877_67).fract() * of;
    let angles: Vec<[f64; 4]> =
        (0..60).map(|k| [angle(k % 3, 1.2), 0.0, angle(k, 1.5), angle(7 * k + 1, std::f64::consts::TAU)]).collect();
    let scattered = scattered::Data::new(Scatter::Reflection, Channels::Mono, &angles, &[value; 60]).unwrap();
    let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 0.7, 1.5], vec![0.0, 2.0, 4.0, std::f64::consts::TAU]];
    let grid = spherical::Data::new(Scatter::Reflection, knots, Channels::Rgb, vec![value; 72]).unwrap();
    vec![scattered.into(), grid.into()]
}

#[test]
fn densities_are_finite_for_extreme_values() {
    let known = incidents();
    let count = known.len();
    for value in [f32::MAX, 1e38, 1e30, 1e-30, f32::MIN_POSITIVE, 1e-45, 0.0, -1.0, f32::MIN] {
        for data in materials(value) {
            let sampler = sampler(Material::from_samples(data, &Options::default()).unwrap());
            let channels = sampler.material().channel_count();
            let (mut directions, mut weights, mut pdfs) =
                (vec![[0.0; 3]; count], vec![0.0; count * channels], vec![0.0; count]);
            let out = Sampled { directions: &mut directions, weights: &mut weights, pdfs: &mut pdfs };
            sampler.sample_batch(Given::Light, &known, &numbers(3, count), out);
            for ((wi, wo), pdf) in known.iter().zip(&directions).zip(&pdfs) {
                assert!(pdf.is_finite() && *pdf >= 0.0, "{value}: {pdf} of {wo:?} for {wi:?}");
                assert!(wo.iter().all(|c| c.is_finite()), "{value}: {wo:?}");
            }
            assert!(!weights.iter().any(|weight| weight.is_nan()), "{value}: {weights:?}");
            for (wi, u) in known.iter().zip(numbers(4, count)) {
                let pdf = sampler.pdf(Given::Light, *wi, cosine(u, 1.0));
                assert!(pdf.is_finite() && pdf > 0.0, "{value}: {pdf}");
            }
        }
    }
}
