//! Every conversion states its error, or the reason why it states no error.

use lobe_formats::Format;

use crate::common::{Files, json, printed, run, text};

/// A diffuse lobe with a peak about the mirror direction, whose values grow with the wavelength.
fn spectral(wavelengths: &[f64]) -> String {
    let mut csv = String::from("theta_i,theta_o,phi_o");
    wavelengths.iter().for_each(|nm| csv.push_str(&format!(",{nm}nm")));
    csv.push('\n');
    let radians = |degrees: i32| f64::from(degrees).to_radians();
    for theta_i in [0, 20, 40, 60, 80] {
        for theta_o in (0..=90).step_by(10) {
            for phi_o in (0..=360).step_by(30) {
                let ((sin_i, cos_i), (sin_o, cos_o)) = (radians(theta_i).sin_cos(), radians(theta_o).sin_cos());
                let cos: f64 = cos_i * cos_o - sin_i * sin_o * radians(phi_o).cos();
                csv.push_str(&format!("{theta_i},{theta_o},{phi_o}"));
                for nm in wavelengths {
                    csv.push_str(&format!(",{}", (nm / 1000.0) * (0.1 + 0.2 * cos.max(0.0).powi(8))));
                }
                csv.push('\n');
            }
        }
    }
    csv
}

fn first(answer: &serde_json::Value, name: &str) -> f64 {
    answer[0]["difference"][name].as_f64().unwrap_or_else(|| panic!("no {name} in {answer}"))
}

#[test]
fn one_wavelength_in_a_format_of_colours_has_an_error() {
    let files = Files::new();
    let (source, out) = (files.write("uv.csv", &spectral(&[360.0, 550.0])), files.path("uv.binary"));
    let stated = json(&["convert", text(&source), text(&out), "--channel", "360nm"]);
    assert_eq!(stated["note"], "360nm only, one channel as equal R, G and B");
    assert!(stated["no_error"].is_null(), "{stated}");
    let found = json(&["compare", text(&source), text(&out), "--channel", "360nm", "--pixels", "8"]);
    for name in ["max", "rms", "relative_rms"] {
        assert_eq!(first(&stated["error"], name), first(&found, name), "{name}");
    }
    assert!((1e-4..0.5).contains(&first(&found, "relative_rms")), "{found}");
    // Another wavelength is not what was written: its values are half as large again.
    let other = json(&["compare", text(&source), text(&out), "--channel", "550nm", "--pixels", "8"]);
    assert!((first(&other, "relative_rms") - (1.0 - 360.0 / 550.0)).abs() < 0.05, "{other}");

    let table = files.path("fine.bsdf");
    let bound = ["convert", text(&source), text(&table), "--to", "rgl", "--channel", "360nm", "--error"];
    let (code, _, said) = run(&[&bound[..], &["1e-9"]].concat());
    assert!(code == 3 && said.contains("the smallest error that was reached is"), "{said}");
    assert!(!table.exists());
}

/// To all formats, whether they keep the nodes or not.
#[test]
fn every_format_has_an_error_or_a_reason() {
    let files = Files::new();
    let source = files.write("uv.csv", &spectral(&[360.0, 550.0]));
    let (mut kept, mut resampled, mut unknown) = (0, 0, 0);
    for format in Format::writable() {
        let word = format.spec().word;
        let extension = format.writer().and_then(|writer| writer.extensions.first()).copied().unwrap_or("txt");
        let out = files.path(&format!("{word}.{extension}"));
        let args = ["convert", text(&source), text(&out), "--to", word, "--channel", "360nm", "--json"];
        let (code, answer, said) = run(&args);
        if code == 2 {
            assert!(said.contains("expected"), "{word}: {said}");
            continue;
        }
        assert_eq!(code, 0, "{word}: {said}");
        let answer: serde_json::Value = serde_json::from_str(&answer).expect("JSON");
        let reason = answer["no_error"].as_str();
        assert!(answer["error"].is_null() == reason.is_some(), "{word}: {answer}");
        match reason {
            None => {
                assert!(said.contains("differs from the source by at most"), "{word}: {said}");
                resampled += 1;
            }
            Some("the values and nodes are those of the file") => {
                assert!(said.contains("with the values and nodes of the file"), "{word}: {said}");
                kept += 1;
            }
            Some(reason) => {
                assert!(format.spec().read.is_none(), "{word}: {reason}");
                assert!(said.contains("the error of the file is not stated: lobe does not read"), "{word}: {said}");
                unknown += 1;
            }
        }
    }
    assert!(kept >= 1 && resampled >= 8 && unknown <= 3, "{kept} {resampled} {unknown}");
}

/// Visible and solar averages, as matrices and as trees, which `lobe compare` finds in the colours of the source.
#[test]
fn sheets_hold_the_averages_of_spectra() {
    let files = Files::new();
    let every_50: Vec<f64> = (6..=50).map(|step| 50.0 * f64::from(step)).collect();
    let source = files.write("wide.csv", &spectral(&every_50));
    for basis in ["quarter", "tree3"] {
        let out = files.path(&format!("{basis}.xml"));
        let stated = json(&["convert", text(&source), text(&out), "--basis", basis]);
        let note = stated["note"].as_str().expect("a note");
        assert!(note.contains("as X Y Z under D65") && note.contains("ASTM G173"), "{note}");
        assert!(printed(&["info", text(&out)]).contains("Solar"));
        let found = json(&["compare", text(&source), text(&out), "--pixels", "8"]);
        assert_eq!(first(&stated["error"], "rms"), first(&found, "rms"), "{basis}");
        // Values are proportional to the wavelength: the averages are those at the mean wavelengths, which are 559 nm for
        // luminance and 857 nm for sunlight.
        let at = |channel: &str| {
            let args = ["eval", text(&out), "--wi", "0,0,1", "--wo", "0.6,0,0.8", "--channel", channel];
            let printed = printed(&args);
            printed.split_whitespace().nth(1).and_then(|value| value.parse::<f64>().ok()).expect("a value")
        };
        let ratio = at("Solar") / at("Visible");
        assert!((ratio - 857.0 / 559.0).abs() < 0.02, "{basis}: {ratio}");
    }
    // Bands keep their names and values.
    let (sheet, solar) = (files.path("quarter.xml"), files.path("solar.xml"));
    let kept = json(&["convert", text(&sheet), text(&solar), "--channel", "Solar"]);
    assert_eq!(kept["no_error"], "the values and nodes are those of the file");
    let names = printed(&["info", text(&solar)]);
    assert!(names.contains("Solar") && !names.contains("Visible"), "{names}");
    let (_, _, said) = run(&["convert", text(&source), text(&files.path("x.xml")), "--channel", "550nm"]);
    assert!(said.contains("550nm only, as the band Visible"), "{said}");

    let visible = files.write("visible.csv", &spectral(&[400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0]));
    let (_, _, said) = run(&["convert", text(&visible), text(&files.path("y.xml")), "--basis", "quarter"]);
    assert!(said.contains("no band Solar, because the wavelengths reach over 42 % of sunlight"), "{said}");
    let narrow = files.write("narrow.csv", &spectral(&[450.0, 550.0, 650.0]));
    let (code, _, said) = run(&["convert", text(&narrow), text(&files.path("z.xml"))]);
    assert!(code == 2 && said.contains("or averages of wavelengths from 400 to 700 nm"), "{said}");
}

/// Nodes that are kept, in a format that interpolates them differently: a bound that is not met leaves no file.
#[test]
fn a_bound_of_kept_nodes_leaves_no_file() {
    let files = Files::new();
    let (table, out) = (files.path("table.ddr"), files.path("table.brdf"));
    let knots = ["--sigma", "0,40,80", "--theta", "0,10,30,90,180", "--phi", "0,90,180,270,360"];
    printed(&[&["generate", "ggx", text(&table), "--alpha", "0.3"], &knots[..]].concat());
    let (code, _, said) = run(&["convert", text(&table), text(&out), "--channel", "G", "--error", "1e-9"]);
    assert!(code == 3, "{said}");
    assert!(!out.exists());
}

/// Samples whose values and nodes are kept, but not always the triangles between them: whatever is said of the error
/// must be what `lobe compare` finds.
#[test]
fn kept_samples_state_what_lies_between_them() {
    let files = Files::new();
    let table = spectral(&[550.0]);
    let (names, rows) = table.split_once('\n').expect("rows");
    let (forward, backward) = (rows.lines().collect::<Vec<_>>(), rows.lines().rev().collect::<Vec<_>>());
    let (mut kept, mut stated) = (0, 0);
    let mut convert = |from: &std::path::Path, name: &str, to: &str| {
        let out = files.path(name);
        let answer = json(&["convert", text(from), text(&out), "--to", to]);
        assert!(answer["resampled"].is_null(), "{to}: {answer}");
        let found = json(&["compare", text(from), text(&out), "--pixels", "8"]);
        let (rms, peak) = (first(&found, "relative_rms"), first(&found, "peak"));
        if answer["error"].is_null() {
            assert_eq!(answer["no_error"], "the values and nodes are those of the file", "{to}");
            assert!(rms <= 2e-6 && first(&found, "max") <= 1e-5 * peak, "{name}: {found}");
            kept += 1;
        } else {
            assert_eq!(first(&answer["error"], "relative_rms"), rms, "{name}");
            stated += 1;
        }
        (out, rms)
    };
    for (order, rows) in [("forward", &forward), ("backward", &backward)] {
        let samples = files.write(&format!("{order}.csv"), &format!("# rows: samples\n{names}\n{}\n", rows.join("\n")));
        for (extension, to) in [("astm", "astm"), ("csv", "csv")] {
            assert_eq!(convert(&samples, &format!("{order}-copy.{extension}"), to).1, 0.0, "{order} to {to}");
        }
        let (speos, rms) = convert(&samples, &format!("{order}.brdf"), "speos");
        // A table lists its samples in its own order, so other triangles are taken.
        assert!(order == "forward" || rms > 1e-4, "{rms}");
        for (extension, to) in [("astm", "astm"), ("csv", "csv"), ("brdf", "speos")] {
            convert(&speos, &format!("{order}-again.{extension}"), to);
        }
    }
    assert!(kept >= 6 && stated >= 1, "{kept} {stated}");
}
