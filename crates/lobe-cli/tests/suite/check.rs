//! `lobe check` as a user runs it, and on the real files if they are available.

use std::path::Path;

use crate::common::{Files, diffuse, json, printed, run, text};
use lobe_testing::files::shared;
use serde_json::Value;

#[test]
fn a_sound_file_passes_and_a_wrong_one_fails() {
    let files = Files::new();
    let good = files.write("good.ddr", &diffuse([0.5; 3]));
    let shown = printed(&["check", text(&good)]);
    assert!(shown.contains("albedo 0.5000 to 0.5000 over 3 incident directions"), "{shown}");

    let bad = files.write("bad.ddr", &diffuse([0.5, 1.5, 0.5]));
    let (code, shown, message) = run(&["check", text(&good), text(&bad)]);
    assert_eq!((code, message.as_str()), (3, "error: 1 of 2 files did not pass\n"));
    assert!(shown.contains("FAIL  energy") && shown.contains("1 of 3 above 1"), "{shown}");

    let warned = files.write("warned.ddr", &diffuse([-0.01, 0.5, 0.6]));
    assert_eq!((run(&["check", text(&warned)]).0, run(&["check", "--strict", text(&warned)]).0), (0, 3));
    let seam = diffuse([0.5; 3]).replacen("0.5 0.5 0.5", "0.5 0.4 0.5", 1);
    let seam = files.write("seam.ddr", &seam);
    assert_eq!((run(&["check", text(&seam)]).0, run(&["check", "--strict", text(&seam)]).0), (0, 3));
}

#[test]
fn json_has_findings_and_read_errors() {
    let files = Files::new();
    let good = files.write("good.ddr", &diffuse([0.5; 3]));
    let found = json(&["check", text(&good)]);
    assert_eq!((&found[0]["kind"], &found[0]["unreadable"]), (&Value::from("specular table"), &Value::Null));
    let findings = found[0]["findings"].as_array().expect("a list");
    let energy = findings.iter().find(|finding| finding["check"] == "energy").expect("energy");
    assert!((energy["numbers"]["largest"].as_f64().expect("a number") - 0.5).abs() < 1e-3);

    let broken = files.write("broken.ddr", &diffuse([0.5; 3]).replacen("0.5", "nan", 1));
    let (code, shown, message) = run(&["check", "--json", text(&broken)]);
    let found: Value = serde_json::from_str(&shown).expect("JSON");
    let why = found[0]["unreadable"].as_str().expect("a reason");
    assert!(code == 1 && why.contains("broken.ddr:8: found `nan`"), "{why} {message}");
    assert!(printed(&["check", "--help"]).contains("Examples:"));
}

/// The findings of a real file.
fn findings(folder: &Path, file: &str) -> Vec<(String, String, String)> {
    let (_, shown, message) = run(&["check", "--json", text(&folder.join("data").join(file))]);
    let found: Value = serde_json::from_str(&shown).unwrap_or_else(|_| panic!("{file}: {message}"));
    let word = |finding: &Value, key: &str| finding[key].as_str().expect("a word").to_string();
    let list = found[0]["findings"].as_array().expect("a list");
    list.iter().map(|finding| (word(finding, "check"), word(finding, "status"), word(finding, "text"))).collect()
}

#[test]
fn sound_and_damaged_real_files_are_distinguished() {
    let Some(folder) = shared() else { return };
    for (file, check, status, words) in [
        ("rgl_bsdf/vch_golden_yellow_rgb.bsdf", "negative values", "warn", "1118 of 24576"),
        ("openmaterial3d_json/asphalt_camera_brdf.xompt", "unit", "warn", "not in 1/sr"),
        ("lumos_csv/starlink_chassis_brdf.csv", "repeated values", "note", "0.0001"),
        ("alta_dat/retro-3M-jaune.dat", "coverage", "warn", "15 30 60 degrees"),
        ("zemax_bsdf/IMX455.bsdf", "coverage", "warn", "are exactly 0"),
        ("mdl_mbsdf/carpaint_blue.mbsdf", "negative values", "warn", "75159 of"),
    ] {
        let all = findings(&folder, file);
        let is_there = all.iter().any(|(c, s, text)| c == check && s == status && text.contains(words));
        assert!(is_there, "{file}: no {check} {status} with {words:?} in {all:#?}");
    }
}
