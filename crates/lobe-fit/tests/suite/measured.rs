//! Fits of tables measured from other models.

use std::time::Instant;

use lobe::{Lookup, Material, Options};
use lobe_fit::{Fit, Measurement, Model, Request, Residuals, Weights, fit, residuals};
use lobe_formats::{Document, Format};
use lobe_model::goniometer::{half_diff, measure};
use lobe_model::{Conductor, Ggx, Lambert, Mix, Rgb, Ward};
use lobe_ops::{Aspect, Subject};
use lobe_table::{Channels, Data, specular};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn subject(data: impl Into<Data>) -> Subject {
    let options = Options { lookup: Lookup::Linear, ..Options::default() };
    let document = Document::new(data);
    let material = Material::from_document(&document, &options).expect("a material");
    Subject::new(Format::Goniometer, document, material, &options)
}

fn fitted(subject: &Subject, request: &Request) -> (Fit, Residuals) {
    let measurement = Measurement::of_subject(subject, Aspect::REFLECTION, 1.35, 8192);
    let fit = fit(&measurement, request).expect("a fit");
    let residuals = residuals(&fit.fitted, &measurement);
    (fit, residuals)
}

fn find<'a>(fit: &'a Fit, name: &str) -> &'a lobe_fit::Estimate {
    fit.estimates.iter().find(|estimate| estimate.parameter.name == name).expect("a parameter")
}

/// A table of 90 x 90 x 180 bins, as in the MERL database: the right parameters, in less than two seconds if the code
/// is optimised.
#[test]
fn a_table_of_the_size_of_the_merl_database_is_fitted_at_once() {
    let gold = Conductor { ggx: Ggx { alpha: [0.2; 2] }, eta: [0.143, 0.375, 1.442], k: [3.983, 2.386, 1.603] };
    let subject = subject(half_diff::measure(&Rgb(gold), half_diff::MERL, || {}).expect("a table"));
    let start = Instant::now();
    let (fit, residuals) = fitted(&subject, &Request::new(Model::Ggx));
    let seconds = start.elapsed().as_secs_f64();
    eprintln!("{seconds:.2} s, {residuals:?}");
    let alpha = find(&fit, "alpha");
    assert!((alpha.value - 0.2).abs() < 0.004, "{alpha:?}");
    assert!(residuals.relative_rms < 0.05, "{residuals:?}");
    assert!(seconds < 2.0 || cfg!(debug_assertions), "{seconds} s");
}

/// A table in specular coordinates whose nodes have noise: the nodes are fitted, and the uncertainty is right.
#[test]
fn listed_nodes_are_fitted() {
    let degrees = |list: &[f64]| list.iter().map(|angle| angle.to_radians()).collect::<Vec<_>>();
    let knots = [
        degrees(&[0.0, 15.0, 30.0, 45.0, 60.0, 75.0]),
        vec![0.0],
        degrees(&[0.0, 2.0, 4.0, 7.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 80.0, 100.0, 140.0, 180.0]),
        degrees(&[0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 270.0, 300.0, 330.0, 360.0]),
    ];
    let model = Mix {
        a: Ward { specular: [0.4, 0.6, 0.8], alpha: [0.15; 2] },
        b: Lambert { albedo: [0.8, 0.4, 0.2] },
        share: 0.5,
    };
    let exact = measure(&model, knots, || {}).expect("a table");
    let mut random = Pcg64::seed_from_u64(7);
    let noisy = exact.values().iter().map(|value| {
        let normal: f64 = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
        value * (1.0 + 0.05 * normal as f32)
    });
    let noisy: Vec<f32> = noisy.collect();
    let table = specular::Data::new(exact.scatter(), exact.knots().clone(), Channels::Rgb, noisy).expect("a table");
    let (fit, residuals) =
        fitted(&subject(table), &Request { weights: Weights::Relative, ..Request::new(Model::Ward) });
    assert!((0.03..0.07).contains(&residuals.log_rms), "{residuals:?}");
    assert!(fit.pairs < 6 * 14 * 13 && fit.pairs > 500, "{} pairs", fit.pairs);
    for (name, expected) in [("alpha", vec![0.15]), ("specular", vec![0.2, 0.3, 0.4]), ("diffuse", vec![0.4, 0.2, 0.1])]
    {
        let found = fit.estimates.iter().filter(|estimate| estimate.parameter.name == name);
        for (estimate, expected) in found.zip(expected) {
            let uncertainty = estimate.uncertainty.expect("an uncertainty");
            assert!((estimate.value - expected).abs() < 3.5 * uncertainty, "{estimate:?} for {expected}");
            assert!(uncertainty < 0.05 * expected, "{estimate:?} for {expected}");
        }
    }
}
