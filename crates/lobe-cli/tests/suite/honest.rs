//! Nothing is ignored silently: options are honoured or refused, stated errors are the actual ones, and data that do
//! not determine an answer say so.

use std::path::{Path, PathBuf};

use crate::common::{Files, diffuse, json, printed, run, text};
use lobe_testing::files::fixture;

/// A WINDOW file of matrices on three patches: the name and the values of each block.
fn sheet(blocks: &[(&str, f64)]) -> String {
    let ring = |lower: u32, upper: u32, patches: u32| {
        format!(
            "<AngleBasisBlock><ThetaBounds><LowerTheta>{lower}</LowerTheta><UpperTheta>{upper}</UpperTheta></ThetaBounds>\
             <nPhis>{patches}</nPhis></AngleBasisBlock>"
        )
    };
    let basis =
        format!("<AngleBasis><AngleBasisName>mine</AngleBasisName>{}{}</AngleBasis>", ring(0, 30, 1), ring(30, 90, 2));
    let block = |(name, value): &(&str, f64)| {
        let values = format!("{value} ").repeat(9);
        format!(
            "<WavelengthDataBlock><WavelengthDataDirection>{name}</WavelengthDataDirection>\
             <ColumnAngleBasis>mine</ColumnAngleBasis><RowAngleBasis>mine</RowAngleBasis>\
             <ScatteringData>{values}</ScatteringData></WavelengthDataBlock>"
        )
    };
    document("Columns", &basis, &blocks.iter().map(block).collect::<String>())
}

fn document(structure: &str, basis: &str, blocks: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<WindowElement><Optical><Layer><DataDefinition>\
         <IncidentDataStructure>{structure}</IncidentDataStructure>{basis}</DataDefinition><WavelengthData>\
         <Wavelength unit=\"Integral\">Visible</Wavelength>{blocks}</WavelengthData></Layer></Optical></WindowElement>\n"
    )
}

/// A tree of four dimensions with a peak.
fn tree() -> String {
    let values: Vec<String> = (0..256).map(|i| if i % 17 == 0 { "1.5".into() } else { "0.05".into() }).collect();
    let block = format!(
        "<WavelengthDataBlock><WavelengthDataDirection>Transmission Back</WavelengthDataDirection>\
         <ScatteringData>{{ {} }}</ScatteringData></WavelengthDataBlock>",
        values.join(" ")
    );
    document("TensorTree4", "", &block)
}

fn refused(args: &[&str], word: &str) {
    let (code, _, message) = run(args);
    assert_eq!(code, 2, "{args:?}: {message}");
    assert!(message.contains(word), "{args:?}: {message}");
}

/// The standard error of a command that succeeds.
fn said(args: &[&str]) -> String {
    let (code, _, message) = run(args);
    assert_eq!(code, 0, "{args:?}: {message}");
    message
}

fn value(args: &[&str]) -> f64 {
    json(&[&["eval"], args].concat())["values"][0].as_f64().expect("a value")
}

const UP: [&str; 4] = ["--wi", "0.3,0,0.9", "--wo", "-0.1,0.2,0.9"];
const THROUGH: [&str; 4] = ["--wi", "0.3,0,0.9", "--wo", "-0.1,0.2,-0.9"];

#[test]
fn the_requested_scatter_is_written() {
    let files = Files::new();
    let window = files.write("sheet.xml", &sheet(&[("Transmission Back", 0.2), ("Reflection Back", 0.02)]));
    let path = |name: &str| files.path(name);
    let convert = |out: &Path, more: &[&str]| said(&[&["convert", text(&window), text(out)], more].concat());
    let there = [UP, THROUGH];
    for (out, scatter, expected) in [
        ("a.ddr", None, 0.02),
        ("a.ddt", None, 0.2),
        ("b.ddr", Some("reflection"), 0.02),
        ("b.ddt", Some("transmission"), 0.2),
        ("t.csv", Some("transmission"), 0.2),
        ("r.csv", None, 0.02),
        ("t.ssdd", Some("transmission"), 0.2),
    ] {
        let out = path(out);
        let message = convert(&out, &scatter.map_or(vec![], |scatter| vec!["--scatter", scatter]));
        // The written part is constant, so the stated error is 0; the part that was not written does not count.
        let largest = message.split("largest ").nth(1).and_then(|rest| rest.split(',').next()).expect("an error");
        assert!(largest.parse::<f64>().expect("a number") < 1e-5, "{message}");
        let found = value(&[&[text(&out)], &there[usize::from(expected > 0.1)][..]].concat());
        assert!((found - expected).abs() < 1e-6, "{}: {found}", out.display());
    }
    let kept = path("kept.xml");
    convert(&kept, &["--scatter", "transmission"]);
    assert_eq!(value(&[&[text(&kept)], &UP[..]].concat()), 0.0);
    assert!((value(&[&[text(&kept)], &THROUGH[..]].concat()) - 0.2).abs() < 1e-6);

    refused(&["convert", text(&window), text(&path("x.ddr")), "--scatter", "transmission"], "transmission");
    let dark = files.write("dark.xml", &sheet(&[("Reflection Front", 0.1)]));
    refused(&["convert", text(&dark), text(&path("x.ddr"))], "no light from the front");
    refused(&["convert", text(&dark), text(&path("x.xml")), "--scatter", "transmission"], "no transmission");
    let paint = files.write("paint.ddr", &diffuse([0.5; 3]));
    refused(&["convert", text(&paint), text(&path("x.ssdd")), "--scatter", "transmission"], "found reflection only");
    convert_fine(&["convert", text(&paint), text(&path("y.ssdd")), "--scatter", "reflection"]);
    assert!(!path("x.ddr").exists() && !path("x.xml").exists() && !path("x.ssdd").exists());
}

fn convert_fine(args: &[&str]) {
    assert!(said(args).contains("the values and nodes of the file"));
}

#[test]
fn options_that_change_nothing_are_refused() {
    let files = Files::new();
    let conductor = fixture("conductor-7x8x13.ddr");
    let (conductor, out) = (text(&conductor), |name: &str| files.path(name).to_str().expect("a path").to_string());
    for options in
        [["--basis", "half"], ["--sigma", "0,30"], ["--theta", "0,90"], ["--texels", "16"], ["--zeniths", "8"]]
    {
        refused(&[&["convert", conductor, &out("a.ssdd")], &options[..]].concat(), options[0]);
        refused(&[&["convert", conductor, &out("a.binary")], &options[..]].concat(), options[0]);
        refused(&[&["generate", "lambert", &out("a.binary")], &options[..]].concat(), options[0]);
    }
    refused(&["convert", conductor, &out("a.bsdf"), "--to", "rgl", "--phi", "0,180"], "--phi");
    refused(&["convert", conductor, &out("a.bsdf"), "--to", "rgl", "--azimuths", "9"], "anisotropic");
    refused(&["convert", conductor, &out("a.xml"), "--zeniths", "9"], "--zeniths");
    refused(&["generate", "lambert", &out("a.ddr"), "--basis", "half"], "--basis");

    let binary = out("b.binary");
    said(&["generate", "lambert", &binary]);
    let eval = |more: &[&str]| {
        [&["eval", conductor], &UP[..], more].concat().iter().map(|x| x.to_string()).collect::<Vec<_>>()
    };
    for (option, word) in [(["--lookup", "linear"], "--lookup"), (["--indexed-by", "viewer"], "--indexed-by")] {
        let args = eval(&option);
        refused(&args.iter().map(String::as_str).collect::<Vec<_>>(), word);
    }
    refused(&[&["eval", &binary], &UP[..], &["--edge", "zero"]].concat(), "--edge");
    printed(&[&["eval", &binary], &UP[..], &["--lookup", "linear"]].concat());
    printed(&[&["eval", conductor], &UP[..], &["--edge", "zero"]].concat());

    refused(&["resample", conductor, &out("r.ddr"), "--per-value"], "--per-value");
    refused(&["resample", conductor, &out("r.ddr"), "--limit", "60"], "--limit");
    refused(&["preview", conductor, "-o", &out("p.exr"), "--exposure", "1"], "--exposure");
    for option in [&["--log"][..], &["--linear"], &["--sigma", "30"]] {
        refused(&[&["plot", conductor, "-o", &out("s.svg"), "--kind", "sphere"], option].concat(), option[0]);
    }
    refused(&["merge", &out("p.exr"), "-o", &out("q.exr"), "--exposure", "1"], "--exposure");
}

#[test]
fn trees_become_matrices_on_request() {
    let files = Files::new();
    let tree = files.write("tree.xml", &tree());
    let out = |name: &str| files.path(name);
    convert_fine(&["convert", text(&tree), text(&out("copy.xml"))]);
    assert!(printed(&["info", text(&out("copy.xml"))]).contains("tensor trees"));
    for (name, options, patches) in
        [("a.xml", &["--to", "klems"][..], "145 x 145"), ("b.xml", &["--basis", "half"][..], "77 x 77")]
    {
        let out = out(name);
        let message = said(&[&["convert", text(&tree), text(&out)], options].concat());
        assert!(message.contains(patches), "{message}");
        assert!(printed(&["info", text(&out)]).contains("Klems matrices"));
    }
    // A file that has these patches keeps its values; another basis is honoured.
    convert_fine(&["convert", text(&out("b.xml")), text(&out("c.xml")), "--to", "klems"]);
    let message = said(&["convert", text(&out("b.xml")), text(&out("d.xml")), "--basis", "quarter"]);
    assert!(message.contains("41 x 41"), "{message}");
}

#[test]
fn nothing_near_the_horizon_stands_out() {
    let files = Files::new();
    let out = |name: &str| files.path(name);
    said(&["generate", "lambert", text(&out("a.bsdf")), "--to", "rgl"]);
    said(&["convert", text(&out("a.bsdf")), text(&out("a.binary"))]);
    let info = json(&["info", text(&out("a.binary"))]);
    let largest = info["parts"][0]["values"]["largest"].as_f64().expect("a number");
    assert!(largest < 0.2, "a bin of {largest} in a white of 0.159");
    said(&["convert", text(&out("a.bsdf")), text(&out("a.xml")), "--basis", "quarter"]);
    let info = json(&["info", text(&out("a.xml"))]);
    let largest = info["parts"][0]["values"]["largest"].as_f64().expect("a number");
    assert!(largest < 0.3, "a patch of {largest}");
    for name in ["a.ddr", "a.csv"] {
        said(&["convert", text(&out("a.bsdf")), text(&out(name))]);
        let largest = json(&["info", text(&out(name))])["parts"][0]["values"]["largest"].as_f64().expect("a number");
        assert!(largest < 0.3, "{name}: {largest}");
    }
}

#[test]
fn stated_errors_are_the_actual_ones() {
    let files = Files::new();
    // A lobe through a sheet: twelve rings of samples about the straight-through direction.
    let mut rows = String::from("# scatter: transmission\ntheta_i,phi_i,theta_o,phi_o,f\n");
    for light in [0.0, 20.0, 40.0_f64] {
        for ring in 0..14 {
            for step in 0..24 {
                let (theta, phi) = (6.0 * f64::from(ring), 15.0 * f64::from(step));
                let along = [light.to_radians(), theta.to_radians()];
                let cos = along[0].cos() * along[1].cos() - along[0].sin() * along[1].sin() * phi.to_radians().cos();
                rows.push_str(&format!("{light},0,{theta},{phi},{}\n", 0.1 + 2.0 * cos.max(0.0).powi(20)));
            }
        }
    }
    let sheet = files.write("lobe.csv", &rows);
    let out = files.path("lobe.ddt");
    let message = said(&["convert", text(&sheet), text(&out)]);
    let stated: f64 = message
        .split("rms ")
        .nth(1)
        .and_then(|rest| rest.split_whitespace().next())
        .and_then(|number| number.parse().ok())
        .expect("an error");
    let compared = json(&["compare", text(&sheet), text(&out)]);
    let found = compared[0]["difference"]["relative_rms"].as_f64().expect("a number");
    assert!(found > 1e-4 && stated / found < 5.0 && found / stated < 5.0, "{stated} stated, {found} found");
}

#[test]
fn the_albedo_of_a_tree_is_exact() {
    let files = Files::new();
    let tree = files.write("tree.xml", &tree());
    let found = json(&["albedo", text(&tree), "--sigma", "10"]);
    let (albedo, error) = (&found[0]["albedos"][0]["values"][0], &found[0]["albedos"][0]["error"]);
    // One leaf of 4^4 cells: 16 for the light, each with 16 for the viewer, one or more of which are bright.
    let cells: Vec<f64> = (0..256).map(|i| if i % 17 == 0 { 1.5 } else { 0.05 }).collect();
    let sums: Vec<f64> = cells.chunks(16).map(|row| std::f64::consts::PI * row.iter().sum::<f64>() / 16.0).collect();
    let albedo = albedo.as_f64().expect("a number");
    assert!(sums.iter().any(|sum| (sum - albedo).abs() < 1e-5), "{albedo} is not among {sums:?}");
    assert_eq!(error.as_f64(), Some(0.0));
}

fn in_plane(files: &Files) -> PathBuf {
    let mut rows = String::from("theta_i,theta_o,phi_o,f\n");
    for light in [10, 40, 70] {
        for theta in (0..80).step_by(10) {
            rows.push_str(&format!("{light},{theta},180,0.3\n{light},{theta},0,0.2\n"));
        }
    }
    files.write("plane.csv", &rows)
}

#[test]
fn warnings_tell_of_undetermined_values() {
    let files = Files::new();
    let plane = in_plane(&files);
    let plane = text(&plane);
    let (code, shown, message) = run(&["albedo", plane]);
    assert_eq!((code, shown.as_str()), (3, ""), "{message}");
    assert!(message.contains("only in the plane of incidence, so there is no albedo"), "{message}");
    let svg = files.path("plane.svg");
    let ddr = files.path("plane.ddr");
    for args in [
        [&["eval", plane], &UP[..]].concat(),
        vec!["plot", plane, "-o", text(&svg)],
        vec![
            "resample",
            plane,
            text(&ddr),
            "--sigma",
            "0,40,80",
            "--psi",
            "0",
            "--theta",
            "0,60,180",
            "--phi",
            "0,180,360",
        ],
    ] {
        let message = said(&args);
        assert!(message.contains("warning: ") && message.contains("guessed everywhere else"), "{args:?}: {message}");
    }
    let whole = files.write("whole.ddr", &diffuse([0.5; 3]));
    assert_eq!(said(&[&["eval", text(&whole)], &UP[..]].concat()), "");
    assert_eq!(said(&["albedo", text(&whole)]), "");
}

#[test]
fn sides_have_one_name() {
    let files = Files::new();
    let window = files.write("sheet.xml", &sheet(&[("Transmission Back", 0.2), ("Reflection Back", 0.02)]));
    let info = printed(&["info", text(&window)]);
    // WINDOW's back is the front here: the side to which the normal points.
    assert!(info.contains("Visible transmission front") && info.contains("transmission back in the file"), "{info}");
    let check = printed(&["check", text(&window)]);
    assert!(check.contains("Visible transmission front") && !check.contains("dark there"), "{check}");
    assert!(check.contains("no transmission back: that of the other direction is used for it"), "{check}");
    let back = [["--wi", "0.3,0,-0.9", "--wo", "-0.1,0.2,0.9"], ["--wi", "0.3,0,-0.9", "--wo", "-0.1,0.2,-0.9"]];
    assert!((value(&[&[text(&window)], &back[0][..]].concat()) - 0.2).abs() < 1e-6);
    assert_eq!(value(&[&[text(&window)], &back[1][..]].concat()), 0.0);
    assert!(printed(&["albedo", text(&window), "--side", "front"]).contains("transmission front"));
    let svg = files.path("a.svg");
    said(&["plot", text(&window), "-o", text(&svg), "--side", "back"]);
    assert!(std::fs::read_to_string(&svg).expect("a figure").contains("light from the back"));
}
