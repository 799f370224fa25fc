//! The parameters of every model are recovered, without noise and with it.

use lobe_colour::Channels;
use lobe_fit::{Fit, Fitted, Measurement, Model, Request, Weights, fit};
use lobe_ops::direction_pairs;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Parameters of the shape, then those of three channels. The place in the list is the seed of the noise.
fn cases() -> Vec<(Model, Vec<f64>, [Vec<f64>; 3])> {
    let of = |list: [f64; 3]| list.map(|value| vec![value]);
    let both = |first: [f64; 3], second: [f64; 3]| [0, 1, 2].map(|channel| vec![first[channel], second[channel]]);
    let (warm, gold) = ([0.5, 0.3, 0.1], [0.9, 0.7, 0.3]);
    vec![
        (Model::Lambert, vec![], of(warm)),
        (Model::OrenNayar, vec![25.0], of(warm)),
        (Model::Phong, vec![45.0], both(warm, [0.3, 0.4, 0.2])),
        (Model::Blinn, vec![80.0], both(warm, [0.3, 0.4, 0.2])),
        (Model::Ward, vec![0.15], both(warm, [0.3, 0.4, 0.2])),
        (Model::WardAnisotropic, vec![0.4, 0.15, 20.0], both(warm, [0.3, 0.4, 0.2])),
        (Model::Ggx, vec![0.2], both(warm, gold)),
        (Model::GgxAnisotropic, vec![0.15, 0.4, -25.0], both(warm, gold)),
        (Model::OpenPbr, vec![0.4, 0.4, 1.6, 0.4], of(warm)),
        (Model::OpenPbrAnisotropic, vec![0.5, 0.45, 1.7, 0.4, 0.6, 30.0], of(gold)),
        (Model::Gltf, vec![0.6, 0.35], of(warm)),
        (Model::GltfClearcoat, vec![0.4, 0.6, 0.8, 0.2], of(warm)),
        (Model::GltfSheen, vec![0.3, 0.5, 0.6, 0.4], of(warm)),
        (Model::Abg, vec![1e-4, 2.3], of([0.01, 0.02, 0.005])),
        (Model::HarveyShack, vec![0.01, -1.6], of([5.0, 2.0, 8.0])),
        (Model::KCorrelation, vec![20.0, 2.6], of([1.2, 1.5, 0.8])),
        (Model::GgxFresnel, vec![0.2, 0.8, 1.2], both(warm, gold)),
    ]
}

const PAIRS: usize = 1400;

fn truth(model: Model, shape: &[f64], channels: &[Vec<f64>; 3]) -> Fitted {
    let meaning = match model {
        Model::KCorrelation => Channels::Spectral(vec![450.0, 550.0, 650.0]),
        _ => Channels::Rgb,
    };
    let parameters = channels.iter().map(|own| [shape, own].concat()).collect();
    Fitted::new(model, meaning, None, parameters)
}

/// The model at pairs of directions, each value with normally distributed relative noise.
fn measured(truth: &Fitted, noise: f64, seed: u64) -> Measurement {
    use lobe_table::Bsdf as _;
    let pairs = direction_pairs(PAIRS, 1.35);
    let mut random = Pcg64::seed_from_u64(seed);
    let mut texel = [0.0; 3];
    let mut values = Vec::new();
    for &(wi, wo) in &pairs {
        truth.f(wi, wo, &mut texel);
        for value in texel {
            // Box and Muller.
            let (u, v): (f64, f64) = (random.random(), random.random());
            let normal = (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos();
            values.push(value * (1.0 + noise * normal));
        }
    }
    Measurement::new(truth.channels().clone(), &pairs, &values).expect("a measurement")
}

fn expected(shape: &[f64], channels: &[Vec<f64>; 3]) -> Vec<f64> {
    [shape, &channels.concat()].concat()
}

#[test]
fn parameters_are_found_to_a_hundredth_without_noise() {
    for (model, shape, channels) in cases() {
        let found = fit(&measured(&truth(model, &shape, &channels), 0.0, 0), &Request::new(model)).expect("a fit");
        for (estimate, expected) in found.estimates.iter().zip(expected(&shape, &channels)) {
            let name = estimate.parameter.name;
            assert!(
                (estimate.value - expected).abs() <= 0.01 * expected.abs(),
                "{} {name}: {} for {expected}",
                model.name(),
                estimate.value
            );
        }
    }
}

/// Deviations in units of the stated uncertainties: their mean square would be 1 if these were exact; because they are
/// the larger of two estimates, it is at most 1.
#[test]
fn uncertainties_are_right_with_noise() {
    let mut squares = Vec::new();
    for (index, (model, shape, channels)) in cases().into_iter().enumerate() {
        let measurement = measured(&truth(model, &shape, &channels), 0.05, 100 + index as u64);
        let found = fit(&measurement, &Request::new(model)).expect("a fit");
        for (estimate, expected) in found.estimates.iter().zip(expected(&shape, &channels)) {
            let name = estimate.parameter.name;
            let Some(uncertainty) = estimate.uncertainty else {
                panic!("{} {name}: {} for {expected}, no uncertainty", model.name(), estimate.value)
            };
            let deviation = (estimate.value - expected) / uncertainty;
            assert!(
                deviation.abs() < 4.0,
                "{} {name}: {} +- {uncertainty} for {expected}",
                model.name(),
                estimate.value
            );
            assert!(uncertainty < 0.3 * expected.abs(), "{} {name}: +- {uncertainty} says nothing", model.name());
            squares.push(deviation * deviation);
        }
    }
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    assert!((0.3..1.5).contains(&mean), "deviations are {:.2} times the stated ones", mean.sqrt());
}

fn alpha(fit: &Fit) -> f64 {
    fit.estimates[0].value
}

#[test]
fn robust_fits_reduce_the_weight_of_outliers() {
    let (shape, channels) = (vec![0.2], [0.5, 0.3, 0.1].map(|diffuse| vec![diffuse, 0.6]));
    let truth = truth(Model::Ggx, &shape, &channels);
    let pairs = direction_pairs(PAIRS, 1.35);
    let mut values = vec![0.0; 3 * pairs.len()];
    for (index, (&(wi, wo), texel)) in pairs.iter().zip(values.chunks_exact_mut(3)).enumerate() {
        truth.f(wi, wo, texel);
        if index % 20 == 3 {
            texel.iter_mut().for_each(|value| *value = 3.0 * *value + 1.0);
        }
    }
    let measurement = Measurement::new(Channels::Rgb, &pairs, &values).expect("a measurement");
    let plain = fit(&measurement, &Request { weights: Weights::Log, ..Request::new(Model::Ggx) }).expect("a fit");
    let robust = Request { weights: Weights::Log, robust: true, ..Request::new(Model::Ggx) };
    let robust = fit(&measurement, &robust).expect("a fit");
    let (plain, robust) = ((alpha(&plain) - 0.2).abs(), (alpha(&robust) - 0.2).abs());
    assert!(robust < 0.3 * plain && robust < 0.004, "{robust} and {plain}");
}

#[test]
fn channels_may_have_their_own_shapes() {
    let parameters = [0.1, 0.2, 0.4].map(|alpha| vec![alpha, 0.2, 0.6]);
    let truth = Fitted::new(Model::Ggx, Channels::Rgb, None, parameters.to_vec());
    let measurement = measured(&truth, 0.0, 0);
    let found = fit(&measurement, &Request { per_channel: true, ..Request::new(Model::Ggx) }).expect("a fit");
    assert_eq!(found.estimates.len(), 9);
    for (channel, expected) in parameters.iter().enumerate() {
        for (estimate, expected) in found.estimates[3 * channel..].iter().zip(expected) {
            assert_eq!(estimate.channel, Some(channel));
            assert!((estimate.value - expected).abs() < 0.01 * expected, "{estimate:?} for {expected}");
        }
    }
}

#[test]
fn parameters_at_a_bound_are_reported() {
    let (shape, channels) = (vec![1.0, 0.3], [0.9, 0.7, 0.3].map(|color| vec![color]));
    let found =
        fit(&measured(&truth(Model::Gltf, &shape, &channels), 0.0, 0), &Request::new(Model::Gltf)).expect("a fit");
    let metallic = &found.estimates[0];
    assert!(metallic.is_at_bound && metallic.uncertainty.is_none() && metallic.value > 0.999, "{metallic:?}");
    assert!(!found.estimates[1].is_at_bound && found.estimates[1].uncertainty.is_some());
}

#[test]
fn impossible_fits_are_refused() {
    let pairs = direction_pairs(100, 1.2);
    let grey = |value: f64| Measurement::new(Channels::Mono, &pairs, &vec![value; pairs.len()]).expect("a measurement");
    let message =
        |measurement: &Measurement, model| fit(measurement, &Request::new(model)).expect_err("an error").to_string();
    assert!(message(&grey(-1.0), Model::Lambert).contains("no value above 0"));
    assert!(message(&grey(0.1), Model::KCorrelation).contains("wavelength"));
    assert!(message(&grey(0.0), Model::Lambert).contains("0 pairs"));
    let many = Channels::Spectral((0..40).map(|index| 400.0 + f64::from(index)).collect());
    let many = Measurement::new(many, &pairs, &vec![0.1; 40 * pairs.len()]).expect("a measurement");
    assert!(message(&many, Model::Ggx).contains("40 channels"));
}
