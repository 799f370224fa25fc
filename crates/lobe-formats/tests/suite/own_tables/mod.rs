//! Users' own tables: each spelling of one measurement is read as that measurement, or refused with advice.

mod around;
mod options;
mod text;
mod values;

use std::path::Path;

use lobe_formats::reading::ReadOptions;
use lobe_formats::{Document, Place, from_bytes_with, sidecar};
use lobe_table::{Data, Scatter};

pub const THETA_I: [f64; 3] = [10.0, 30.0, 50.0];
pub const BASE: [f64; 3] = [0.25, 0.3, 0.35];

/// Polar angles of the viewer.
pub fn thetas() -> impl Iterator<Item = f64> {
    (-13..=13).map(|step| 6.0 * f64::from(step))
}

/// The measurement: a lobe about the mirror direction, at positive angles.
pub fn f(theta_i: f64, theta_o: f64, channel: usize) -> f64 {
    let value = BASE[channel] + 0.1 * (-((theta_o - theta_i) / 12.0).powi(2)).exp();
    (value * 1e4).round() / 1e4
}

/// One line per pair of directions, built from its angles and its three values.
pub fn rows(row: impl Fn(f64, f64, [f64; 3]) -> String) -> String {
    let pairs = THETA_I.iter().flat_map(|&theta_i| thetas().map(move |theta_o| (theta_i, theta_o)));
    pairs.map(|(i, o)| row(i, o, [0, 1, 2].map(|channel| f(i, o, channel))) + "\n").collect()
}

pub fn table(head: &str, delimiter: &str) -> String {
    let row = |i: f64, o: f64, [a, b, c]: [f64; 3]| [i, o, 180.0, a, b, c].map(|x| x.to_string()).join(delimiter);
    format!("{}\n{}", head.replace(',', delimiter), rows(row))
}

pub const HEAD: &str = "theta_i,theta_o,phi_o,450nm,550nm,650nm";

pub fn in_plane(head: &str) -> String {
    format!("{head}\n{}", rows(|i, o, [a, b, c]| format!("{i},{o},{a},{b},{c}")))
}

pub fn path() -> &'static Path {
    Path::new("scan.csv")
}

pub fn options(words: &[(&str, &str)]) -> ReadOptions {
    let mut options = ReadOptions::default();
    words.iter().for_each(|(key, word)| sidecar::set(&mut options, key, word).expect("an option"));
    options
}

#[track_caller]
pub fn read(bytes: &[u8], words: &[(&str, &str)]) -> Document {
    from_bytes_with(bytes, path(), &options(words)).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
pub fn refused(text: &str, words: &[(&str, &str)], found: &str, expected: &str) {
    let error = from_bytes_with(text.as_bytes(), path(), &options(words)).expect_err("a refusal");
    assert!(error.found.contains(found) && error.expected.contains(expected), "{error}");
}

pub fn direction(theta: f64, phi: f64) -> [f64; 3] {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

pub fn eval(data: &Data, wi: [f64; 3], wo: [f64; 3]) -> Vec<f32> {
    match data {
        Data::Scattered(data) => data.eval(wi, wo),
        Data::Spherical(data) => data.eval(wi, wo).into_iter().map(|value| value as f32).collect(),
        other => panic!("{other:?}"),
    }
}

/// Compares a document with the measurement at every sample.
#[track_caller]
pub fn is_the_measurement(document: &Document, channels: usize, name: &str) {
    let data = document.only().unwrap_or_else(|| panic!("{name}: one measurement"));
    assert_eq!(data.representation().scatter(), Scatter::Reflection, "{name}");
    for theta_i in THETA_I {
        for theta_o in thetas() {
            let found = eval(data, direction(theta_i, 0.0), direction(theta_o, 180.0));
            assert_eq!(found.len(), channels, "{name}");
            for (channel, found) in found.iter().enumerate() {
                let wanted = f(theta_i, theta_o, channel);
                assert!(
                    (f64::from(*found) - wanted).abs() < 1e-5,
                    "{name}: {found}, not {wanted} at {theta_i}, {theta_o}"
                );
            }
        }
    }
}
