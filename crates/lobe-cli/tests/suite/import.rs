//! `lobe import`, and in every command the options for facts that a file leaves open.

use std::f64::consts::PI;

use crate::common::{Files, json, printed, run, text};

/// Luminance factors of a Lambertian surface with an albedo of 0.9, without column names.
fn lambert(value: f64) -> String {
    let rows = |theta_i: i32| {
        (0..=8).flat_map(move |theta| {
            (0..8).map(move |turn| {
                format!("{theta_i};{};{};{}\n", 10 * theta, 45 * turn, value.to_string().replace('.', ","))
            })
        })
    };
    [0, 30, 60].into_iter().flat_map(rows).collect()
}

const COLUMNS: &str = "theta_i=1,theta_o=2,phi_o=3,f=4";

#[test]
fn tables_that_are_not_understood_are_shown_with_the_options() {
    let files = Files::new();
    let file = files.write("scan.txt", &lambert(0.9));
    let (code, _, message) = run(&["import", text(&file)]);
    assert_eq!(code, 1, "{message}");
    for part in ["without names", "--columns theta_i=1,theta_o=2", "scan.txt.lobe.toml", "     1 | 0;0;0;0,9"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    // Every other command says the same in one line.
    let (code, _, message) = run(&["info", text(&file)]);
    assert!(code == 1 && message.contains("--columns theta_i=1") && message.lines().count() == 1, "{message}");
    assert!(!files.path("scan.txt.lobe.toml").exists());
}

/// Letters of old code pages are shown as they are read.
#[test]
fn lines_are_shown_in_their_code_page() {
    let files = Files::new();
    let path = files.path("scan.txt");
    let text_of = "Lack, grün, 45° – 5 µm\n".chars().map(|c| if c == '–' { 0x96 } else { c as u32 as u8 });
    std::fs::write(&path, text_of.chain(lambert(0.9).bytes()).collect::<Vec<u8>>()).expect("a file");
    let (code, _, message) = run(&["import", text(&path)]);
    assert!(code == 1 && message.contains("     1 | Lack, grün, 45° – 5 µm"), "{message}");
}

/// What a line above the rows says of the values is not read past, and the message says how to settle it.
#[test]
fn factors_above_a_table_are_settled_by_scale() {
    let files = Files::new();
    let file = files.write("scan.csv", &format!("Scale: 1000\nAOI;view angle;azimuth;BRDF\n{}", lambert(0.2)));
    let (code, _, message) = run(&["info", text(&file)]);
    assert!(code == 1 && message.contains("scan.csv:1: found a factor of 1000 in the line"), "{message}");
    assert!(message.contains("scale"), "{message}");
    let value = printed(&["eval", text(&file), "--wi", "0,0,1", "--wo", "0,0,1", "--scale", "0.001"]);
    assert!(value.contains("0.0002"), "{value}");
}

#[test]
fn options_are_kept_for_every_command() {
    let files = Files::new();
    let file = files.write("scan.txt", &lambert(0.9));
    let said = ["import", text(&file), "--columns", COLUMNS, "--values", "luminance-factor"];
    let (code, shown, message) = run(&[&said[..], &["--no-sidecar"]].concat());
    assert!(code == 0 && !files.path("scan.txt.lobe.toml").exists(), "{message}");
    for part in [
        "semicolons between cells, a comma before decimals",
        "luminance factors, pi f, as the options say",
        "column 1 is theta_i",
    ] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    let (code, _, message) = run(&said);
    assert!(code == 0 && message.contains("scan.txt.lobe.toml"), "{message}");
    let albedos = json(&["albedo", text(&file), "--sigma", "0,30"]);
    for albedo in albedos[0]["albedos"].as_array().expect("albedos") {
        let value = albedo["values"][0].as_f64().expect("a number");
        assert!((value - 0.9).abs() < 1e-3, "{albedo}");
    }
    let value = |args: &[&str]| -> f64 {
        let line = printed(&[&["eval", text(&file), "--wi", "0,0,1", "--wo", "0.5,0,0.8"], args].concat());
        line.split_whitespace().next_back().and_then(|number| number.parse().ok()).expect("a number")
    };
    assert!((value(&[]) - 0.9 / PI).abs() < 1e-6);
    assert!((value(&["--values", "f"]) - 0.9).abs() < 1e-6, "the command line comes first");
    assert!((value(&["--scale", "0.5"]) - 0.45 / PI).abs() < 1e-6);
    let info = json(&["info", text(&file)]);
    assert!(info["notes"].to_string().contains("column 3 is phi_o"), "{info}");
    printed(&["check", text(&file)]);
    let converted = files.path("scan.csv");
    let (code, _, message) = run(&["convert", text(&file), text(&converted)]);
    assert_eq!(code, 0, "{message}");
    let (code, _, message) = run(&["compare", text(&file), text(&converted), "--within", "1e-6"]);
    assert_eq!(code, 0, "{message}");
    // A file must not be written where an existing sidecar would apply to it.
    files.write("other.csv.lobe.toml", "scale = 2\n");
    let (code, _, message) = run(&["convert", text(&file), text(&files.path("other.csv"))]);
    assert!(code == 1 && message.contains("other.csv.lobe.toml"), "{message}");
    assert!(!files.path("other.csv").exists());
}

#[test]
fn import_writes_pictures_and_files() {
    let files = Files::new();
    let file = files.write("scan.csv", &format!("AOI;view angle;azimuth;BRDF\n{}", lambert(0.2)));
    let (page, out) = (files.path("scan.html"), files.path("scan.ssdd"));
    let (code, shown, message) = run(&["import", text(&file), "--plot", text(&page), "-o", text(&out)]);
    assert_eq!(code, 0, "{message}");
    assert!(shown.contains("\"AOI\" is theta_i"), "{shown}");
    assert!(std::fs::read_to_string(&page).expect("a page").contains("view angle"));
    assert!(std::fs::metadata(&out).expect("a file").len() > 0);
    assert!(!files.path("scan.csv.lobe.toml").exists(), "nothing was left open");
    let report = json(&["import", text(&file), "--scale", "0.5"]);
    assert_eq!(report["sidecar"].as_str().map(|path| path.ends_with("scan.csv.lobe.toml")), Some(true), "{report}");
    assert!(report["options"].as_str().expect("options").contains("scale = \"0.5\""));
}

#[test]
fn impossible_values_and_bad_options_are_reported() {
    let files = Files::new();
    let file = files.write("scan.csv", &format!("AOI;view angle;azimuth;BRDF\n{}", lambert(0.9)));
    let (code, shown, _) = run(&["import", text(&file)]);
    assert!(code == 3 && shown.contains("FAIL"), "{shown}");
    for (option, word) in
        [("--values", "g"), ("--unit", "gon"), ("--scale", "0"), ("--columns", "theta_i"), ("--in-plane", "x")]
    {
        let (code, _, message) = run(&["info", text(&file), option, word]);
        assert!(code == 2 && message.contains("expected"), "{message}");
    }
    files.write("scan.csv.lobe.toml", "values = \"f\"\nsize = 3\n");
    let (code, _, message) = run(&["eval", text(&file), "--wi", "0,0,1", "--wo", "0,0,1"]);
    assert!(code == 1 && message.contains("scan.csv.lobe.toml:2:") && message.contains("size"), "{message}");
}

#[test]
fn pairs_of_any_spelling() {
    let files = Files::new();
    let file = files.write("scan.csv", &format!("theta_i;theta_o;phi_o;BRDF\n{}", lambert(0.2)));
    let of = |name: &str, bytes: &[u8]| {
        let path = files.path(name);
        std::fs::write(&path, bytes).expect("a file");
        printed(&["eval", text(&file), "--json", "--pairs", text(&path)])
    };
    let wanted = of("plain.csv", b"wix,wiy,wiz,wox,woy,woz\n0.5,0,0.5,0,0,1\n");
    let utf_16: Vec<u8> = "0,5;0;0,5;0;0;1\r\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    for (name, bytes) in [
        ("mark", b"\xef\xbb\xbf0.5,0,0.5,0,0,1\n".to_vec()),
        ("mark and names", b"\xef\xbb\xbfwi.x,wi.y,wi.z,wo.x,wo.y,wo.z\n0.5,0,0.5,0,0,1\n".to_vec()),
        ("swapped", b"wo.x,wo.y,wo.z,wi.x,wi.y,wi.z\n0,0,1,0.5,0,0.5\n".to_vec()),
        ("semicolons", b"0.5;0;0.5;0;0;1\n".to_vec()),
        ("decimal commas", b"0,5;0;0,5;0;0;1\n".to_vec()),
        ("tabs", b"0.5\t0\t0.5\t0\t0\t1\n".to_vec()),
        ("blanks", b"0.5 0 0.5  0 0 1\n".to_vec()),
        ("returns", b"# c\r0.5,0,0.5,0,0,1\r".to_vec()),
        ("UTF-16", [&b"\xff\xfe"[..], &utf_16[..]].concat()),
    ] {
        assert_eq!(of(name, &bytes), wanted, "{name}");
    }
    for (bad, message) in
        [("wix,wiy,wiz,a,b,c\n", "expected wi.x"), ("0,0,1,0,0\n", "5 columns"), ("0,0,1;0,0,1\n", "the columns 0,0,1")]
    {
        let path = files.write("bad.csv", bad);
        let (code, _, found) = run(&["eval", text(&file), "--pairs", text(&path)]);
        assert!(code == 1 && found.contains(message) && found.contains("bad.csv:1:"), "{found}");
    }
}

/// A table of one's own must not be replaced by what was made of it.
#[test]
fn the_measurement_is_not_overwritten() {
    let files = Files::new();
    let table = "theta_i,theta_o,phi_o,f\n30,0,0,0.25\n30,40,0,0.25\n30,40,90,0.25\n30,40,180,0.25\n";
    let csv = files.write("own.csv", table);
    let page = files.write("own.html", table);
    let sidecar = files.write("own.csv.lobe.toml", "unit = \"deg\"\n");
    let table_out = files.path("out.ddr");
    let mut runs = vec![
        vec!["import", text(&csv), "-o", text(&csv)],
        vec!["import", text(&page), "--plot", text(&page), "--no-sidecar"],
        vec!["import", text(&csv), "-o", text(&sidecar), "--to", "csv"],
        vec!["convert", text(&csv), text(&sidecar), "--to", "csv"],
        vec!["resample", text(&csv), text(&table_out), "--fill", "zeros", "--mask", text(&sidecar)],
        vec!["generate", "lambert", text(&sidecar), "--to", "csv"],
        vec!["fit", text(&csv), "--model", "lambert", "-o", text(&sidecar)],
    ];
    let link = files.path("link.csv");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&csv, &link).expect("a link");
        runs.push(vec!["import", text(&csv), "-o", text(&link)]);
    }
    for args in runs {
        let (code, _, message) = run(&args);
        assert!(code == 1 && message.contains("expected another file to write"), "{args:?}: {code} {message}");
    }
    assert_eq!(std::fs::read_to_string(&csv).expect("a file"), table);
    assert_eq!(std::fs::read_to_string(&sidecar).expect("a file"), "unit = \"deg\"\n");
    // What cannot be written is said before the work.
    let nowhere = files.path("nowhere").join("a.csv");
    let (code, printed, message) = run(&["import", text(&csv), "-o", text(&nowhere)]);
    assert!(code == 1 && printed.is_empty() && message.contains("expected a file that can be written"), "{message}");
}

#[cfg(unix)]
#[test]
fn names_and_devices_do_no_harm() {
    let files = Files::new();
    let evil = files.write("evil\u{1b}[31m.csv", "theta_i,theta_o,phi_o,f\n30,0,0,1\n30,40,0,1\n30,40,90,1\n");
    let (_, printed, message) = run(&["import", text(&evil), "--no-sidecar"]);
    let both = format!("{printed}{message}");
    assert!(!both.contains('\u{1b}') && printed.contains("evil\\u{1b}[31m.csv"), "{both:?}");
    let made = std::process::Command::new("mkfifo").arg(files.path("pipe.csv")).status().expect("mkfifo");
    assert!(made.success());
    for input in [text(&files.path("pipe.csv")), "/dev/zero"] {
        let mut import = std::process::Command::new("timeout");
        import.args(["20", env!("CARGO_BIN_EXE_lobe"), "import", input]).stdin(std::process::Stdio::null());
        let ended = import.output().expect("the program");
        let message = String::from_utf8_lossy(&ended.stderr);
        assert!(ended.status.code() == Some(1) && message.contains("a device, a pipe or a socket"), "{message}");
    }
}
