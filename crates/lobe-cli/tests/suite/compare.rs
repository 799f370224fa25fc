//! `lobe compare` as a user runs it.

use crate::common::{Files, diffuse, json, printed, run, text};

#[test]
fn differences_are_given_in_numbers_and_in_colours() {
    let files = Files::new();
    let first = files.write("first.ddr", &diffuse([0.5; 3]));
    let second = files.write("second.ddr", &diffuse([0.55; 3]));
    let found = json(&["compare", text(&first), text(&second), "--pairs", "2000"]);
    let number = |key: &str| found[0]["difference"][key].as_f64().expect("a number");
    let expected = 0.05 / std::f64::consts::PI;
    assert!((number("max") - expected).abs() < 1e-6 && (number("bias") - expected).abs() < 1e-6, "{found}");
    assert!((number("relative_rms") - 0.1).abs() < 1e-4, "{found}");
    let delta_e = found[0]["delta_e"]["mean"].as_f64().expect("a number");
    assert!(delta_e > 1.0 && delta_e < 6.0, "{found}");

    let shown = printed(&["compare", text(&first), text(&first)]);
    assert!(shown.contains("max       0.000000") && shown.contains("at most 0.000"), "{shown}");
}

#[test]
fn scripts_can_check_a_limit() {
    let files = Files::new();
    let first = files.write("first.ddr", &diffuse([0.5; 3]));
    let second = files.write("second.ddr", &diffuse([0.55; 3]));
    let within = |share| run(&["compare", text(&first), text(&second), "--within", share]);
    assert_eq!(within("0.11").0, 0);
    let (code, _, message) = within("0.05");
    assert!(code == 3 && message.contains("more than 0.05"), "{message}");
    let glass = files.write("glass.ddt", &diffuse([0.5; 3]));
    let (code, _, message) = run(&["compare", text(&first), text(&glass)]);
    assert!(code == 2 && message.contains("found transmission front"), "{message}");
    assert!(printed(&["compare", "--help"]).contains("Examples:"));
}
