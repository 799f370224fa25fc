//! `lobe fit` as a user runs it.

use crate::common::{Files, diffuse, json, printed, run, text};

#[test]
fn parameters_are_found_by_name_and_written() {
    let files = Files::new();
    let paint = files.path("paint.ddr");
    printed(&["generate", "ward", text(&paint), "--alpha", "0.15", "--specular", "0.3", "--diffuse", "0.5,0.2,0.1"]);
    let found = json(&["fit", text(&paint), "--model", "ward"]);
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let alpha = number(&found["parameters"]["alpha"]);
    assert!((alpha - 0.15).abs() < 0.0015, "{found}");
    // The diffuse component covers half of the surface.
    for (channel, expected) in [0.25, 0.1, 0.05].into_iter().enumerate() {
        let diffuse = number(&found["parameters"]["diffuse"][channel]);
        assert!((diffuse - expected).abs() < 0.01 * expected, "{found}");
    }
    assert!(number(&found["uncertainties"]["alpha"]) < 0.01 && number(&found["residuals"]["relative_rms"]) < 0.01);
    // Spheres are also compared between the nodes, where the table interpolates.
    assert!(number(&found["delta_e"]["mean"]) < 0.2, "{found}");

    let out = files.path("paint.toml");
    let shown = printed(&["fit", text(&paint), "--model", "ward", "-o", text(&out)]);
    assert!(
        shown.contains("reflection front: ward, cosine weights") && shown.contains("standard deviation of the slope"),
        "{shown}"
    );
    let toml = std::fs::read_to_string(&out).expect("a file");
    assert!(toml.contains(&format!("alpha = {alpha:?}")), "{toml}");
}

#[test]
fn scripts_can_limit_the_error_of_a_model() {
    let files = Files::new();
    let paint = files.path("paint.ddr");
    printed(&["generate", "ward", text(&paint), "--alpha", "0.15"]);
    let within = |model, limit| run(&["fit", text(&paint), "--model", model, "--limit", limit]);
    assert_eq!(within("ward", "0.01").0, 0);
    let (code, shown, message) = within("lambert", "0.5");
    assert!(code == 3 && message.contains("lambert: the relative error is") && shown.contains("albedo"), "{message}");
    // Nothing could be within it, so the work does not begin.
    let (code, shown, message) = within("ward", "nan");
    assert!(code == 2 && message.contains("found --limit NaN") && shown.is_empty(), "{message}");
}

#[test]
fn impossible_fits_and_outputs_are_refused() {
    let files = Files::new();
    let grey = files.write("grey.ddr", &diffuse([0.5; 3]));
    let refused = |more: &[&str]| {
        let (code, _, message) = run(&[&["fit", text(&grey)], more].concat());
        assert_eq!(code, 2, "{message}");
        message
    };
    assert!(refused(&["--model", "k-correlation"]).contains("(--wavelength gives it)"));
    assert!(refused(&["--model", "ggx", "-o", "x.mtlx"]).contains("found a fit of ggx"));
    assert!(refused(&["--model", "ggx", "-o", "x.png"]).contains("expected .toml"));
    assert!(refused(&["--model", "ggx", "--channel", "R"]).contains("found no channel R"));
    assert!(refused(&["--model", "ggx", "--up-to", "90"]).contains("found --up-to 90"));
    assert!(refused(&["--model", "lommel"]).contains("lommel"));
    let glass = files.write("glass.ddt", &diffuse([0.5; 3]));
    let (code, _, message) = run(&["fit", text(&glass), "--model", "ggx"]);
    assert!(code == 2 && message.contains("found transmission front; expected reflection"), "{message}");
    let (code, shown, message) = run(&["fit", text(&glass), "--model", "lambert"]);
    assert!(code == 0 && shown.contains("albedo  0.5000"), "{message} {shown}");
}
