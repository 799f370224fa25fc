//! `lobe albedo` as a user runs it.

use crate::common::{Files, diffuse, json, printed, run, text};

#[test]
fn albedos_are_correct() {
    let files = Files::new();
    let file = files.write("paint.ddr", &diffuse([0.5, 0.25, 0.75]));
    let shown = printed(&["albedo", text(&file)]);
    let rows: Vec<Vec<&str>> = shown.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(rows[0], ["sigma", "psi", "Y", "error"], "{shown}");
    assert_eq!((rows[2][0], rows[2][2]), ("40.00", "0.25000"), "{shown}");

    let found = json(&["albedo", text(&file), "--sigma", "0:80:20"]);
    let albedos = found[0]["albedos"].as_array().expect("a list");
    let values: Vec<f64> = albedos.iter().map(|albedo| albedo["values"][0].as_f64().expect("a number")).collect();
    for (value, expected) in values.iter().zip([0.5, 0.375, 0.25, 0.5, 0.75]) {
        assert!((value - expected).abs() < 1e-4, "{values:?}");
    }
    assert_eq!(values.len(), 5);
    assert_eq!(found[0]["aspect"], "reflection front");
}

#[test]
fn invalid_requests_are_refused() {
    let files = Files::new();
    let file = files.write("paint.ddr", &diffuse([0.5; 3]));
    for (args, expected) in [
        (vec!["--sigma", "90"], "found light at 90 degrees"),
        (vec!["--sigma", "0:90:0"], "expected an angle, or first:last:step"),
        (vec!["--tolerance", "0"], "found a tolerance of 0"),
        (vec!["--scatter", "transmission"], "found reflection front"),
    ] {
        let (code, _, message) = run(&[&["albedo", text(&file)], args.as_slice()].concat());
        assert!(code == 2 && message.contains(expected), "{args:?}: {code} {message}");
    }
    assert_eq!(run(&["albedo", "no/such.ddr"]).0, 1);
    assert!(printed(&["albedo", "--help"]).contains("Examples:"));
}
