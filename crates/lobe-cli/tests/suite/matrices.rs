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
