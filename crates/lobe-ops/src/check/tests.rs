//! Every check finds what it is for, and nothing if there is nothing to find.

use lobe::{Material, Options};
use lobe_formats::{Document, Format};
use lobe_table::{Channels, Scatter, specular};
use std::f64::consts::PI;

use super::*;
use crate::testing::degrees as radians;

const THETAS: [f64; 6] = [0.0, 5.0, 20.0, 60.0, 120.0, 180.0];

fn subject(samples: specular::Data, tis: Vec<f32>) -> Subject {
    let document = Document { tis, ..Document::new(samples) };
    let material = Material::from_document(&document, &Options::default());
    Subject::new(Format::Zemax, document, material.expect("a material"), &Options::default())
}

/// A table over the whole circle of which the values are given by sigma, theta and phi in degrees.
fn table(phis: &[f64], f: impl Fn(f64, f64, f64) -> f64) -> specular::Data {
    let sigmas = [0.0, 30.0, 60.0, 85.0];
    let mut values = Vec::new();
    for sigma in sigmas {
        for theta in THETAS {
            values.extend(phis.iter().map(|&phi| f(sigma, theta, phi) as f32));
        }
    }
    let knots = [radians(&sigmas), vec![0.0], radians(&THETAS), radians(phis)];
    specular::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a table")
}

const CIRCLE: [f64; 5] = [0.0, 90.0, 180.0, 270.0, 360.0];

fn found(samples: specular::Data, tis: Vec<f32>, check: &str) -> Vec<Finding> {
    let all = super::check(&subject(samples, tis), &Thoroughness::default(), |_| {});
    all.into_iter().filter(|finding| finding.check == check).collect()
}

fn assert_found(findings: &[Finding], status: Status, words: &str) {
    let is_there = findings.iter().any(|finding| finding.status == status && finding.text.contains(words));
    assert!(is_there, "{status} with {words:?} is not in {findings:#?}");
}

#[test]
fn a_sound_table_passes() {
    let samples = table(&CIRCLE, |_, theta, _| (1.0 + 0.001 * theta) * 0.5 / PI);
    let all = super::check(&subject(samples, Vec::new()), &Thoroughness::default(), |_| {});
    let bad: Vec<_> = all.iter().filter(|finding| finding.status > Status::Note).collect();
    assert!(bad.is_empty(), "{bad:#?}");
    for check in ["negative values", "knots", "pole", "azimuth seam", "symmetry", "energy", "reciprocity"] {
        assert!(all.iter().any(|finding| finding.check == check), "no {check} in {all:#?}");
    }
}

#[test]
fn negative_values_are_counted() {
    let samples =
        table(&CIRCLE, |sigma, theta, _| if sigma == 30.0 && theta == 20.0 { -0.01 } else { 0.1 + 1e-4 * theta });
    assert_found(
        &found(samples, Vec::new(), "negative values"),
        Status::Warn,
        "5 of 120 values (4.2 %), down to -1.000e-2",
    );
    let samples = table(&CIRCLE, |_, theta, _| if theta > 5.0 { -0.01 } else { 0.1 });
    assert_found(&found(samples, Vec::new(), "negative values"), Status::Fail, "more than half");
}

#[test]
fn poles_and_seams_are_compared() {
    let pole = table(&CIRCLE, |_, theta, phi| if theta == 0.0 && phi == 90.0 { 0.08 } else { 0.1 });
    assert_found(&found(pole, Vec::new(), "pole"), Status::Warn, "differ by 20 % of the largest");
    let seam = table(&CIRCLE, |_, theta, phi| if theta == 20.0 && phi == 360.0 { 0.09 } else { 0.1 });
    assert_found(&found(seam, Vec::new(), "azimuth seam"), Status::Warn, "differ by 10.0 %");
    let half = table(&[0.0, 90.0, 180.0], |_, _, _| 0.1);
    assert_found(&found(half, Vec::new(), "azimuth seam"), Status::Warn, "the gap of 180 degrees");
    let plane = table(&[0.0, 180.0], |_, _, _| 0.1);
    assert_found(&found(plane, Vec::new(), "azimuth seam"), Status::Warn, "measured in the plane of incidence");
    let open = table(&[0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0], |_, _, _| 0.1);
    assert_found(&found(open, Vec::new(), "azimuth seam"), Status::Pass, "one step, 45 degrees, short");
    let skew = table(&CIRCLE, |_, theta, phi| if theta > 0.0 && phi == 90.0 { 0.2 } else { 0.1 });
    assert_found(&found(skew, Vec::new(), "symmetry"), Status::Warn, "differ, by up to 50 %");
}

#[test]
fn energy_and_units_are_judged() {
    let bright = table(&CIRCLE, |sigma, _, _| if sigma == 60.0 { 1.2 / PI } else { 0.5 / PI });
    assert_found(&found(bright.clone(), Vec::new(), "energy"), Status::Fail, "0.5000 to 1.2000 over 4");
    assert_found(&found(bright.clone(), Vec::new(), "energy"), Status::Fail, "light at 60 degrees; 1 of 4 above 1");
    assert!(found(bright, Vec::new(), "unit").is_empty());
    let factors = table(&CIRCLE, |_, _, _| 0.8);
    assert_found(&found(factors, Vec::new(), "unit"), Status::Warn, "pi f");
    let counts = table(&CIRCLE, |_, _, _| 800.0);
    assert_found(&found(counts, Vec::new(), "unit"), Status::Warn, "not in 1/sr");
    let tiny = table(&CIRCLE, |_, _, _| 1e-5);
    assert_found(&found(tiny, Vec::new(), "unit"), Status::Warn, "blackest");
}

#[test]
fn stated_totals_are_compared_with_the_integral() {
    let samples = table(&CIRCLE, |_, _, _| 0.5 / PI);
    assert_found(&found(samples.clone(), vec![0.5; 4], "TIS"), Status::Pass, "1.000 times");
    assert_found(
        &found(samples.clone(), vec![0.5, 0.5, 0.25, 0.5], "TIS"),
        Status::Warn,
        "0.2500 stated, 0.5000 integrated",
    );
    assert_found(&found(samples, vec![0.5 / PI as f32; 4], "TIS"), Status::Warn, "a factor of pi");
}

#[test]
fn what_was_not_measured_is_found() {
    let holed = table(&CIRCLE, |_, theta, _| if theta == 60.0 || theta == 120.0 { 0.0 } else { 0.1 + 1e-4 * theta });
    assert_found(&found(holed.clone(), Vec::new(), "coverage"), Status::Warn, "are exactly 0");
    assert_found(&found(holed, Vec::new(), "repeated values"), Status::Note, "not measured; the interpolation");
    let short = table(&CIRCLE, |_, _, _| 0.1);
    assert_found(&found(short, Vec::new(), "coverage"), Status::Note, "from 0 to 85 degrees only");
}

#[test]
fn one_way_is_not_the_other() {
    let uneven = table(&CIRCLE, |sigma, _, _| 0.1 + 0.2 * sigma / 85.0);
    assert_found(&found(uneven, Vec::new(), "reciprocity"), Status::Warn, "up to 80 degrees");
}
