//! `lobe resample` as a user runs it.

use crate::common::{Files, diffuse, json, printed, run, text};

const CSV: &str = "theta_i,theta_o,phi_o,550nm\n";

/// A lobe about the mirror direction, on a grid of spherical angles.
fn glossy() -> String {
    let mut csv = String::from(CSV);
    let radians = |degrees: i32| f64::from(degrees).to_radians();
    for theta_i in [0, 20, 40, 60, 80] {
        for theta_o in (0..90).step_by(10) {
            for phi_o in (0..360).step_by(30) {
                let ((sin_i, cos_i), (sin_o, cos_o)) = (radians(theta_i).sin_cos(), radians(theta_o).sin_cos());
                let cos = cos_i * cos_o - sin_i * sin_o * radians(phi_o).cos();
                csv.push_str(&format!("{theta_i},{theta_o},{phi_o},{}\n", 0.1 + 0.2 * cos.max(0.0).powi(8)));
            }
        }
    }
    csv
}

#[test]
fn the_bound_is_met_and_the_error_reported() {
    let files = Files::new();
    let (input, output) = (files.write("glossy.csv", &glossy()), files.path("glossy.ddr"));
    let found = json(&["resample", text(&input), text(&output), "--error", "0.1"]);
    let error = found["resampling"]["relative_to_peak"].as_f64().expect("a number");
    assert!(error > 0.0 && error < 0.11, "{found}");
    let info = json(&["info", text(&output)]);
    assert_eq!(info["parts"][0]["axes"][0]["count"], found["knots"][0]);
    let compared = json(&["compare", text(&input), text(&output), "--limit", "75"]);
    let max = compared[0]["difference"]["max"].as_f64().expect("a number");
    assert!(max < 0.12 * 0.3, "{compared}");

    let (code, _, message) = run(&["resample", text(&input), text(&files.path("no.ddr")), "--error", "1e-9"]);
    assert!(code == 3 && message.contains("expected 0.000000001 or less"), "{message}");
    assert!(!files.path("no.ddr").exists());
    // The message names an achievable error.
    let least = message.split("--error ").nth(1).and_then(|rest| rest.split(' ').next()).expect("an error");
    printed(&["resample", text(&input), text(&files.path("yes.ddr")), "--error", least]);
}

/// A discontinuity cannot be interpolated to any bound.
#[test]
fn without_a_bound_the_best_possible_error_is_accepted() {
    let files = Files::new();
    let mut csv = String::from(CSV);
    for theta_i in [0, 40, 80] {
        for theta_o in (0..90).step_by(5) {
            for phi_o in (0..360).step_by(30) {
                csv.push_str(&format!("{theta_i},{theta_o},{phi_o},{}\n", if theta_o % 2 == 0 { 1.0 } else { 0.1 }));
            }
        }
    }
    let (input, output) = (files.write("jagged.csv", &csv), files.path("jagged.ddr"));
    let (code, shown, message) = run(&["resample", text(&input), text(&output)]);
    assert!(code == 0 && output.exists(), "{message}");
    assert!(message.contains("more than the intended 1 %"), "{message}");
    assert!(shown.contains("of the largest value"), "{shown}");
    // If the knots of all axes are given, they are used even if a bound is not met.
    let knots = ["--sigma", "0,80", "--psi", "0", "--theta", "0,90", "--phi", "0,180"];
    let given = files.path("given.ddr");
    printed(&[&["resample", text(&input), text(&given), "--error", "0.01"], knots.as_slice()].concat());
    assert!(given.exists());
}

#[test]
fn given_knots_are_used() {
    let files = Files::new();
    let (input, output) = (files.write("glossy.csv", &glossy()), files.path("glossy.ssdd"));
    let args = ["--sigma", "0:80:20", "--psi", "0", "--theta", "0,10,30:180:30", "--phi", "0:360:30"];
    let found = json(&[&["resample", text(&input), text(&output)], args.as_slice()].concat());
    assert_eq!(found["knots"], serde_json::json!([5, 1, 8, 13]));
    assert_eq!(json(&["info", text(&output)])["parts"][0]["axes"][2]["knots"][1], 10.0);
}

#[test]
fn a_table_keeps_its_knots_and_is_repaired() {
    let files = Files::new();
    let input = files.write("holed.ddr", &diffuse([0.5, 1.6, 0.5]).replacen("0.5 0.5 0.5", "0.5 0.5 0", 1));
    let (output, mask) = (files.path("whole.ddr"), files.path("mask.csv"));
    let repairs = ["--fill", "zeros", "--mask", text(&mask), "--mirror", "--reciprocal", "--conserve"];
    let shown = printed(&[&["resample", text(&input), text(&output)], repairs.as_slice()].concat());
    assert!(shown.contains("knots     those of the file"), "{shown}");
    assert!(shown.contains("repair    1 of 27 nodes filled"), "{shown}");
    assert_eq!(std::fs::read_to_string(&mask).expect("a file"), "sigma,psi,theta,phi\n0,0,180,0\n");
    let found = json(&["albedo", text(&output)]);
    for albedo in found[0]["albedos"].as_array().expect("a list") {
        assert!(albedo["values"][0].as_f64().expect("a number") < 1.0002, "{found}");
    }
}

#[test]
fn spectra_become_colours() {
    let files = Files::new();
    let (input, output) = (files.write("glossy.csv", &glossy()), files.path("glossy.ddr"));
    let args = ["--sigma", "0,60", "--psi", "0", "--theta", "0,90", "--phi", "0,180", "--colour", "rgb"];
    let found = json(&[&["resample", text(&input), text(&output)], args.as_slice()].concat());
    assert_eq!(found["channels"], serde_json::json!(["R", "G", "B"]));
    // One wavelength counts for all others: grey.
    let values = json(&["eval", text(&output), "--angles", "0,0,0,0"]);
    let value = |index: usize| values["values"][index].as_f64().expect("a number");
    assert!((value(0) - value(2)).abs() < 1e-3 * value(0), "{values}");
}

#[test]
fn invalid_requests_are_refused() {
    let files = Files::new();
    let input = files.write("paint.ddr", &diffuse([0.5; 3]));
    for (output, args, expected) in [
        ("a.ddt", vec![], "expected ddr or ssdd for reflection"),
        ("a.csv", vec![], "found the extension `csv`"),
        ("a.ddr", vec!["--error", "0"], "found an error of 0"),
        ("a.ddr", vec!["--error", "0.1", "--limit", "0"], "found a limit of 0"),
        ("a.ddr", vec!["--sigma", "40,30"], "expected strictly ascending knots"),
        ("a.ddr", vec!["--mask", "m.csv"], "--fill"),
    ] {
        let (code, _, message) =
            run(&[&["resample", text(&input), text(&files.path(output))], args.as_slice()].concat());
        assert!(code == 2 && message.contains(expected), "{args:?}: {code} {message}");
    }
    assert!(printed(&["resample", "--help"]).contains("Examples:"));
}
