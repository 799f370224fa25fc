//! Files of Mueller matrices, generated, converted and drawn.

use crate::common::{Files, json, printed, run, text};

#[test]
fn matrices_survive_as_a_table() {
    let folder = Files::new();
    let path = |name: &str| folder.path(name);
    let [tensor, table, back, plain] = ["a.mueller", "a.csv", "b.mueller", "plain.csv"].map(path);
    let knots = ["--sigma", "0,20,50,80", "--theta", "0,2,10,40,180", "--phi", "0,90,180,270,360"];
    let mut args = vec!["generate", "mueller", text(&tensor), "--metal", "gold", "--wavelengths", "450,632.8"];
    args.extend(knots);
    printed(&args);
    printed(&["convert", text(&tensor), text(&table), "--to", "mueller-csv"]);
    printed(&["convert", text(&table), text(&back)]);
    assert!(std::fs::read(&tensor).expect("matrices") == std::fs::read(&back).expect("matrices"));
    let info = json(&["info", text(&table)]);
    assert_eq!(info["format"], "table of Mueller matrices");
    let written = std::fs::read_to_string(&table).expect("a table");
    assert!(written.contains("sigma_deg,psi_deg,theta_deg,phi_deg,wavelength_nm,m00,m01,"), "{written}");
    assert_eq!(written.lines().count(), 2 + 4 * 5 * 5 * 2);
    // Generated as a table, it is the same table.
    args[2] = text(&plain);
    args.extend(["--to", "mueller-csv"]);
    printed(&args);
    assert_eq!(std::fs::read_to_string(&plain).expect("a table"), written);
    // A missing row is an error that says so.
    let last = written.trim_end().rfind('\n').expect("rows");
    std::fs::write(&table, &written[..last]).expect("a file");
    let (code, _, error) = run(&["info", text(&table)]);
    assert!(code == 1 && error.contains("199 rows for 4 sigma x 1 psi x 5 theta x 5 phi x 2 wavelengths"), "{error}");
}

#[test]
fn matrices_are_drawn_and_other_materials_have_none() {
    let folder = Files::new();
    let (file, out) = (folder.path("a.mueller"), folder.path("a.svg"));
    printed(&["generate", "mueller", text(&file), "--glass", "BK7", "--sigma", "0,30,60", "--wavelengths", "500,600"]);
    for (kind, words) in [("mueller", "Mueller matrix"), ("polarisation", "Linear polarisation")] {
        let said = printed(&["plot", text(&file), "-o", text(&out), "--kind", kind, "--channel", "500nm"]);
        assert!(said.contains(&format!(": {kind}, 960 pixels wide")) && said.contains("light at 0° 30° 60°"), "{said}");
        let drawn = std::fs::read_to_string(&out).expect("a figure");
        assert!(drawn.contains(words) && drawn.contains("channel 500nm"), "{drawn}");
    }
    let plain = folder.write("plain.ddr", &crate::common::diffuse([0.5; 3]));
    let (code, _, error) = run(&["plot", text(&plain), "-o", text(&out), "--kind", "mueller"]);
    assert!(code == 2 && error.contains("expected Mueller matrices for the figure mueller"), "{error}");
}

#[test]
fn materials_without_matrices_become_depolarisers() {
    let folder = Files::new();
    let paint = folder.write("paint.ddr", &crate::common::diffuse([0.3, 0.4, 0.5]));
    let (tensor, back) = (folder.path("a.pbsdf"), folder.path("b.csv"));
    let (code, _, said) = run(&["convert", text(&paint), text(&tensor)]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("37 phi_d x 46 theta_d x 46 theta_h"), "{said}");
    assert!(said.contains("the polarisation is not known: the matrices are those of an ideal depolariser"), "{said}");
    let info = json(&["info", text(&tensor)]);
    assert_eq!(info["format"], "KAIST pBSDF");
    // Matrices stay matrices.
    let (code, _, said) = run(&[
        "convert",
        text(&tensor),
        text(&back),
        "--to",
        "mueller-csv",
        "--theta",
        "0,60,180",
        "--phi",
        "0,180,360",
    ]);
    assert!(code == 0 && !said.contains("depolariser"), "{said}");
    let table = std::fs::read_to_string(&back).expect("a table");
    let row = table.lines().find(|line| line.starts_with("40,0,0,0,")).expect("a row");
    let elements: Vec<f64> = row.split(',').skip(5).map(|cell| cell.parse().expect("a number")).collect();
    assert!((elements[0] - 0.4 / std::f64::consts::PI).abs() < 1e-3, "{row}");
    assert!(elements.len() == 16 && elements[1..].iter().all(|element| *element == 0.0), "{row}");
}

#[test]
fn matrices_are_resampled_with_a_stated_error() {
    let folder = Files::new();
    let (gold, tensor) = (folder.path("gold.mueller"), folder.path("gold.pbsdf"));
    printed(&["generate", "mueller", text(&gold), "--metal", "gold", "--alpha", "0.4", "--wavelengths", "450,650"]);
    let stated = json(&["convert", text(&gold), text(&tensor)]);
    let found = json(&["compare", text(&gold), text(&tensor), "--pixels", "8"]);
    let error = |answer: &serde_json::Value| answer[0]["difference"]["relative_rms"].as_f64().expect("a number");
    let before = error(&stated["error"]);
    assert_eq!(before, error(&found));
    assert!(before > 0.0 && before < 0.1, "{stated}");
    // All elements are resampled, not only those of unpolarised light.
    let matrix = |file| {
        let table = folder.path("matrix.csv");
        printed(&["convert", text(file), text(&table), "--to", "mueller-csv"]);
        let table = std::fs::read_to_string(&table).expect("a table");
        let row = table.lines().find(|line| line.starts_with("60,0,10,90,650,")).expect("a row");
        row.split(',').skip(5).map(|cell| cell.parse().expect("a number")).collect::<Vec<f64>>()
    };
    let (exact, resampled) = (matrix(&gold), matrix(&tensor));
    assert!(exact[1].abs() > 0.02 * exact[0] && exact[11].abs() > 0.1 * exact[0], "{exact:?}");
    for (exact_element, element) in exact.iter().zip(&resampled) {
        assert!((element - exact_element).abs() < 0.05 * exact[0], "{resampled:?}, not {exact:?}");
    }
    let (code, _, said) = run(&["convert", text(&gold), text(&tensor), "--channel", "650nm"]);
    assert!(code == 2 && said.contains("found --channel; expected no such option"), "{said}");
    // A bound that the default nodes do not meet.
    let bound = format!("{:.5}", 0.8 * before);
    let finer = json(&["convert", text(&gold), text(&tensor), "--error", &bound]);
    assert!(error(&finer["error"]) <= 0.8 * before, "{finer}");
}
