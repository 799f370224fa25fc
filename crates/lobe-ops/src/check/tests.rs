//! Every check finds its kind of fault, and nothing in sound data.

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

/// A table over the full circle whose values are a function of sigma, theta and phi in degrees.
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
fn unmeasured_values_are_found() {
    let holed = table(&CIRCLE, |_, theta, _| if theta == 60.0 || theta == 120.0 { 0.0 } else { 0.1 + 1e-4 * theta });
    assert_found(&found(holed.clone(), Vec::new(), "coverage"), Status::Warn, "are exactly 0");
    assert_found(&found(holed, Vec::new(), "repeated values"), Status::Note, "not measured; the interpolation");
    let short = table(&CIRCLE, |_, _, _| 0.1);
    assert_found(&found(short, Vec::new(), "coverage"), Status::Note, "only from 0 to 85 degrees");
}

#[test]
fn missing_reciprocity_is_found() {
    let uneven = table(&CIRCLE, |sigma, _, _| 0.1 + 0.2 * sigma / 85.0);
    assert_found(&found(uneven, Vec::new(), "reciprocity"), Status::Warn, "up to 80 degrees");
}

fn scattered(angles: &[[f64; 4]], value: impl Fn([f64; 4]) -> f64) -> Document {
    let radians: Vec<[f64; 4]> = angles.iter().map(|angles| angles.map(f64::to_radians)).collect();
    let values: Vec<f32> = angles.iter().map(|&angles| value(angles) as f32).collect();
    let data = lobe_table::scattered::Data::new(Scatter::Reflection, Channels::Mono, &radians, &values);
    Document::new(data.expect("samples"))
}

fn all_of(document: Document) -> Vec<Finding> {
    let material = Material::from_document(&document, &Options::default()).expect("a material");
    let subject = Subject::new(Format::Goniometer, document, material, &Options::default());
    super::check(&subject, &Thoroughness::default(), |_| {})
}

/// Outgoing directions around the hemisphere for light at these polar angles.
fn around(lights: &[f64]) -> Vec<[f64; 4]> {
    let mut angles = Vec::new();
    for &light in lights {
        for theta in [0.0, 20.0, 40.0, 60.0, 80.0] {
            angles.extend((0..12).map(|step| [light, 0.0, theta, 30.0 * f64::from(step)]));
        }
    }
    angles
}

#[test]
fn sparse_samples_are_not_a_failure() {
    // One outgoing direction for each of many incident ones: the albedo is unknown.
    let single: Vec<[f64; 4]> = (0..40)
        .map(|i| [1.0 + 2.0 * f64::from(i), 37.0 * f64::from(i), 60.0 - f64::from(i), 91.0 * f64::from(i)])
        .collect();
    let document = scattered(&single, |_| 0.36);
    assert!(guesses(&document)[0].contains("for 40 of 40 incident ones"), "{:?}", guesses(&document));
    let all = all_of(document);
    assert!(all.iter().all(|finding| finding.status < Status::Fail), "{all:#?}");
    assert_found(&all, Status::Note, "too few outgoing directions for an albedo, for 40 of 40");

    let in_plane: Vec<[f64; 4]> = (0..60).map(|i| [10.0 + f64::from(i % 4), 0.0, f64::from(i), 180.0]).collect();
    let document = scattered(&in_plane, |_| 0.36);
    assert!(guesses(&document)[0].contains("in the plane of incidence"), "{:?}", guesses(&document));
    let one = scattered(&around(&[30.0]), |_| 0.3);
    assert!(guesses(&one)[0].contains("only one direction"), "{:?}", guesses(&one));
    assert_found(&all_of(one), Status::Warn, "light from one direction, at 30 degrees, which is used for all others");

    let viewer: Vec<[f64; 4]> = (0..60).map(|i| [f64::from(i), 0.0, 45.0, 180.0]).collect();
    let viewer = scattered(&viewer, |_| 0.36);
    assert!(guesses(&viewer)[1].contains("only one outgoing direction"), "{:?}", guesses(&viewer));
    assert_found(&all_of(viewer), Status::Warn, "only one outgoing direction");
    let turned: Vec<[f64; 4]> = (0..6)
        .flat_map(|i| around(&[30.0]).into_iter().map(move |[a, _, c, d]| [a, 30.0 * f64::from(i), c, d]))
        .collect();
    let turned = guesses(&scattered(&turned, |_| 0.3));
    assert!(turned.len() == 1 && turned[0].contains("only one polar angle, 30 degrees"), "{turned:?}");
    let whole = scattered(&around(&[0.0, 30.0, 60.0, 75.0]), |_| 0.36);
    assert_eq!(guesses(&whole), Vec::<String>::new());
    let all = all_of(whole);
    assert_found(&all, Status::Note, "linear between them, and beyond them the nearest");
    assert_found(&all, Status::Fail, "4 of 4 above 1");
    assert_eq!(guesses(&Document::new(table(&[0.0, 180.0], |_, _, _| 0.1))).len(), 1);
    assert_eq!(guesses(&Document::new(table(&CIRCLE, |_, _, _| 0.1))).len(), 0);
    let knots = [radians(&[30.0]), vec![0.0], radians(&THETAS), radians(&CIRCLE)];
    let values = vec![0.1; THETAS.len() * CIRCLE.len()];
    let one = specular::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a table");
    assert_eq!(guesses(&Document::new(one.clone())).len(), 1);
    assert_found(&all_of(Document::new(one)), Status::Warn, "light at only one polar angle, 30 degrees");
    // One value for all directions is not a guess.
    let knots = std::array::from_fn(|_| vec![0.0]);
    let lambert = specular::Data::new(Scatter::Reflection, knots, Channels::Mono, vec![0.1]).expect("a table");
    assert_eq!(guesses(&Document::new(lambert)).len(), 0);
}

#[test]
fn quotients_by_a_tiny_cosine_are_named() {
    let mut angles = around(&[0.0, 30.0, 60.0]);
    angles.extend((0..12).map(|step| [30.0, 0.0, 89.9, 30.0 * f64::from(step)]));
    let spike = |[.., theta, _]: [f64; 4]| if theta > 89.0 { 40.0 } else { 0.1 };
    assert_found(&all_of(scattered(&angles, spike)), Status::Warn, "up to 4.000e1 against 1.000e-1");
    let smooth = all_of(scattered(&angles, |_| 0.1));
    assert!(smooth.iter().all(|finding| finding.check != "horizon"), "{smooth:#?}");
}

/// A material of the EPFL database with the same value, times the cosine, in all directions.
fn constant_product() -> Document {
    use lobe_table::rgl::{Data, Images, Parts};
    let images = |shape: [usize; 3], value: f32| {
        Images::new("made", shape, vec![value; shape.iter().product()]).expect("images")
    };
    let data = Data::new(Parts {
        description: "made".into(),
        phi_i: vec![0.0],
        theta_i: vec![0.0, 1.4],
        ndf: images([1, 2, 3], 1.0),
        sigma: images([1, 2, 2], 0.25),
        vndf: images([2, 8, 8], 1.0),
        luminance: images([2, 8, 8], 1.0),
        channels: Channels::Spectral(vec![550.0]),
        spectra: images([2, 8, 8], 0.3),
        jacobian: true,
        valid: Some(vec![255]),
    });
    Document::new(data.expect("a material"))
}

#[test]
fn values_times_the_cosine_that_are_not_0_at_the_horizon_are_noted() {
    let all = all_of(constant_product());
    assert_found(&all, Status::Note, "the file has f times the cosine, which does not go to 0 there");
    let found = all.iter().find(|finding| finding.check == "horizon").expect("the horizon");
    let [near, away] = ["near", "away"].map(|name| found.numbers[name]);
    // The smallest heights on either side are 1e-4 and 0.06.
    assert!((100.0..2000.0).contains(&(near / away)), "{near} {away}");
}

#[test]
fn sheet_findings_agree_with_evaluation() {
    use lobe_table::window::klems::{AngleBasis, KlemsMatrix};
    use lobe_table::window::{Band, Block, Blocks, Component, Data};
    let with = |blocks: &[Block]| {
        let basis = AngleBasis::quarter();
        let matrix = KlemsMatrix::new(basis.clone(), basis.clone(), vec![0.05; basis.patches().pow(2)]);
        let component = Component::Klems(matrix.expect("a matrix"));
        let mut window = Blocks::default();
        blocks.iter().for_each(|&block| _ = window.set(block, component.clone()));
        let all = all_of(Document::new(Data { bands: vec![Band { wavelength: "Visible".into(), window }] }));
        let text = all.iter().find(|finding| finding.check == "coverage").expect("coverage");
        (text.status, text.text.clone())
    };
    // WINDOW's back is the front here.
    let (status, text) = with(&[Block::TransmissionBack, Block::ReflectionBack]);
    assert_eq!(status, Status::Warn);
    assert_eq!(text, "no transmission back: that of the other direction is used for it; no reflection back: 0 there");
    let (status, text) = with(&[Block::TransmissionFront, Block::ReflectionBack, Block::ReflectionFront]);
    assert_eq!(
        (status, text.as_str()),
        (Status::Note, "no transmission front: that of the other direction is used for it")
    );
    let (_, text) = with(&[Block::ReflectionBack]);
    assert_eq!(text, "no transmission back, no transmission front, no reflection back: 0 there");
    assert_eq!(with(&Block::ALL).0, Status::Pass);
}
