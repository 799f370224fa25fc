//! The program as a user runs it: its output and its exit codes.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// sigma 0 and 60; theta 0 and 180; every value is pi times a simple number of 1/sr.
const RGB: &str = ";; lacquer\nSource Measured\nTypeSym AxiSymmetrical\nTypeColorModel RGB\nsigma 2 0 60\nphi 1 0\ntheta 2 0 90\n\
    red def 3.14159265359 0 3.14159265359 0 enddef\n\
    gre def 6.28318530718 0 6.28318530718 0 enddef\n\
    blu def 3.14159265359 -6.28318530718 3.14159265359 -6.28318530718 enddef\n";

struct Files(TempDir);

impl Files {
    fn new() -> Self {
        Files(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, content: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }
}

fn lobe(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lobe")).args(args).stdin(Stdio::null()).output().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The output of a command, which has to succeed.
fn printed(args: &[&str]) -> String {
    let output = lobe(args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The exit code of a command that fails, which must print only a message.
fn failed(args: &[&str]) -> (Option<i32>, String) {
    let output = lobe(args);
    assert!(!output.status.success(), "{args:?}");
    assert!(output.stdout.is_empty(), "{args:?}");
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn info_shows_the_file() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let shown = printed(&["info", text(&file)]);
    for line in [
        "format    Integra DDR/DDT",
        "scatter   reflection",
        "channels  3: R G B",
        "sigma     2 knots, 0 to 60 degrees: 0 60",
        "psi       1 knot: 0 degrees",
        "kind      specular table",
        "values    12 of f in 1/sr, -2 to 2, 2 negative, 48 bytes",
        "  comment: lacquer",
    ] {
        assert!(shown.lines().any(|shown| shown == line), "{line:?} is not in\n{shown}");
    }
    let json: serde_json::Value = serde_json::from_str(&printed(&["info", "--json", text(&file)])).unwrap();
    assert_eq!(json["parts"][0]["axes"][0]["knots"], serde_json::json!([0.0, 60.0]));
    assert_eq!(json["parts"][0]["values"]["negative"], 2);
    assert_eq!(json["source"][1], serde_json::json!(["Source", "Measured"]));
}

#[test]
fn info_shows_refraction_and_mirror_reflectance() {
    let files = Files::new();
    let glass = "TypeColorModel BW sigma 2 0 60 sigmat 0 35.26 phi 1 0 theta 1 0 bw def 1 1 enddef";
    let shown = printed(&["info", text(&files.write("glass.ddt", glass))]);
    assert!(shown.contains("scatter   transmission"), "{shown}");
    assert!(shown.contains("refracted at 0 35.26 degrees"), "{shown}");

    let mirror = files.write("mirror.sdr", "TypeColorModel BW\nsigma 2 0 90\nbw def 0.04 1 enddef\n");
    assert!(printed(&["info", text(&mirror)]).contains("2 of mirror reflectance by angle of incidence, 0.04 to 1"));
    let (code, message) = failed(&["eval", text(&mirror), "--angles", "0,0,0,0"]);
    assert_eq!(code, Some(1));
    assert!(message.contains("mirror.sdr: found mirror reflectance; expected a BRDF or BTDF"), "{message}");
}

/// Lines of a name and a number; the numbers agree within a few roundings of `f32`.
fn assert_channels(printed: &str, expected: &[(&str, f64)]) {
    let lines: Vec<(&str, f64)> =
        printed.lines().map(|line| line.split_once(' ').unwrap()).map(|(n, x)| (n, x.parse().unwrap())).collect();
    assert_eq!(lines.len(), expected.len(), "{printed}");
    for ((name, value), (expected_name, expected)) in lines.iter().zip(expected) {
        assert!(name == expected_name && (value - expected).abs() < 1e-6, "{printed} is not {expected:?}");
    }
}

#[test]
fn eval_of_one_pair() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let file = text(&file);
    let eval = |args: &str| printed(&["eval", file].into_iter().chain(args.split(' ')).collect::<Vec<_>>());
    // Halfway from the mirror direction to 90 degrees off it.
    assert_channels(&eval("--wi=-1,0,1 --wo 0,0,3"), &[("R", 0.5), ("G", 1.0), ("B", 0.0)]);
    let extrapolated = [("R", 0.5), ("G", 1.0), ("B", -0.5)];
    assert_channels(&eval("--wi=-1,0,1 --wo 0,0,3 --edge extrapolate"), &extrapolated);
    assert_channels(&eval("--angles 45,0,45,0"), &[("R", 0.5), ("G", 1.0), ("B", 0.0)]);
    // Sigma 70 is beyond the last angle.
    assert_channels(&eval("--angles 70,0,0,0"), &[("R", 1.0), ("G", 2.0), ("B", 1.0)]);
    assert_eq!(eval("--angles 70,0,0,0 --edge zero"), "R 0\nG 0\nB 0\n");
    // Below the horizon.
    assert_eq!(eval("--wi 0,0,1 --wo 0.1,0,-1"), "R 0\nG 0\nB 0\n");
    let json: serde_json::Value = serde_json::from_str(&eval("--angles 0,0,0,0 --json")).unwrap();
    assert_eq!(json["values"], serde_json::json!([1.0, 2.0, 1.0]));
    assert_eq!(json["wi"], serde_json::json!([0.0, 0.0, 1.0]));
}

#[test]
fn eval_of_chosen_channels_with_the_cosine() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let eval = |args: &str| printed(&["eval", text(&file)].into_iter().chain(args.split(' ')).collect::<Vec<_>>());
    assert_channels(&eval("--angles 60,0,0,0 --channel g --cosine"), &[("G", 1.0)]);
    assert_channels(&eval("--angles 0,0,0,0 --channel B --channel R"), &[("B", 1.0), ("R", 1.0)]);
    let json: serde_json::Value = serde_json::from_str(&eval("--angles 0,0,0,0 --json --channel G")).unwrap();
    assert_eq!((&json["channels"], &json["values"]), (&serde_json::json!(["G"]), &serde_json::json!([2.0])));
    let (code, message) = failed(&["eval", text(&file), "--angles", "0,0,0,0", "--channel", "550nm"]);
    assert_eq!((code, message.as_str()), (Some(2), "error: found no channel 550nm; expected one of R, G, B\n"));
}

#[test]
fn every_backend_evaluates_and_others_are_refused() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let run = |backend: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lobe"));
        command.env("LOBE_BACKEND", backend).args(["eval", text(&file), "--angles", "45,0,45,0"]).output().unwrap()
    };
    for backend in lobe::Backend::available() {
        let output = run(backend.name());
        assert!(output.status.success(), "{backend}");
        let printed = String::from_utf8(output.stdout).unwrap();
        assert_channels(&printed, &[("R", 0.5), ("G", 1.0), ("B", 0.0)]);
    }
    let output = run("mmx");
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(
        message.starts_with("error: LOBE_BACKEND: backend `mmx` is unknown; this machine has: scalar"),
        "{message}"
    );
}

#[test]
fn other_representations_are_shown_and_evaluated() {
    let files = Files::new();
    let file = files.write("mine.csv", "theta_i,theta_o,phi_o,550nm\n30,0,0,1\n30,60,0,2\n30,60,180,3\n");
    let shown = printed(&["info", text(&file)]);
    for line in [
        "format    table with named columns",
        "kind      scattered samples",
        "channels  1: 550nm",
        "samples   3 pairs of directions, isotropic",
        "light     1 direction, at 30 degrees",
    ] {
        assert!(shown.lines().any(|shown| shown == line), "{line:?} is not in\n{shown}");
    }
    let value =
        printed(&["eval", text(&file), "--wi", "0.5,0,0.8660254", "--wo=-0.8660254,0,0.5", "--channel", "550nm"]);
    assert_channels(&value, &[("550nm", 3.0)]);

    let head = "VERSION 0.3\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\nPARAM_TYPE spherical_coordinate_system\n\
        PARAM0_LIST 0\nPARAM2_LIST 0 90\nPARAM3_LIST 0\nDATA ascii\n0.25\n0.25\n";
    let sheet = files.write("film.ssdd", &format!("{head}{}", head.replace("brdf", "btdf").replace("0.25", "0.5")));
    let shown = printed(&["info", text(&sheet)]);
    assert!(
        shown.contains("\nreflection\nkind      spherical grid\n") && shown.contains("\ntransmission\n"),
        "{shown}"
    );
    let json: serde_json::Value = serde_json::from_str(&printed(&["info", "--json", text(&sheet)])).unwrap();
    assert_eq!(json["parts"][1]["scatter"], "transmission");
    let eval = |wo: &str| printed(&["eval", text(&sheet), "--wi", "0,0,1", "--wo", wo]);
    assert_eq!((eval("0.6,0,0.8").as_str(), eval("0.6,0,-0.8").as_str()), ("Y 0.25\n", "Y 0.5\n"));
}

#[test]
fn eval_of_many_pairs() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let with_header =
        files.write("pairs.csv", "wix,wiy,wiz,wox,woy,woz\n# light above\n\n0,0,1,0,0,1\n-1,0,1, 0,0,2\r\n");
    let printed_rows = printed(&["eval", text(&file), "--pairs", text(&with_header)]);
    let rows: Vec<Vec<f64>> =
        printed_rows.lines().map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    assert_eq!((rows.len(), &rows[0]), (2, &vec![1.0, 2.0, 1.0]));
    for (value, expected) in rows[1].iter().zip([0.5, 1.0, 0.0]) {
        assert!((value - expected).abs() < 1e-6, "{printed_rows}");
    }
    let lines = printed(&["eval", text(&file), "--json", "--pairs", text(&with_header)]);
    assert_eq!(lines.lines().count(), 2);

    let mut child = Command::new(env!("CARGO_BIN_EXE_lobe"))
        .args(["eval", text(&file), "--pairs", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(b"0,0,1,0,0,1\n").unwrap();
    assert_eq!(child.wait_with_output().unwrap().stdout, b"1,2,1\n");
}

#[test]
fn errors_in_pairs_name_the_line() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    for (content, expected) in [
        ("a,b,c,d,e,f\n0,0,1,0,0,1\n0,0,0,0,0,1\n", "bad.csv:3: found a direction of zero length"),
        ("0,0,1,0,0,1\n# note\n\n0,0,nan,0,0,1\n", "bad.csv:4: found `nan`; expected a finite number"),
        ("0,0,1,0,0,x\n", "bad.csv:1: found `x`"),
        ("0,0,1,0,0,1\n0,0,1,0,0\n", "bad.csv:2: found 5 columns; expected 6"),
    ] {
        let (code, message) = failed(&["eval", text(&file), "--pairs", text(&files.write("bad.csv", content))]);
        // A damaged file, like any other.
        assert_eq!(code, Some(1), "{message}");
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn exit_codes() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let file = text(&file);
    let broken = files.write("broken.ddr", &RGB.replace("gre def 6.28318530718", "gre def\n nan"));
    for (args, code, expected) in [
        (vec!["info", text(&broken)], 1, "broken.ddr:10: found `nan`; expected a value, a finite number"),
        (vec!["info", "no/such/file.ddr"], 1, "no/such/file.ddr: found"),
        (vec!["info", text(&files.write("note.txt", "hello"))], 1, "note.txt: found content of no known format"),
        (vec!["eval", file, "--pairs", "no/such.csv"], 1, "no/such.csv: "),
        (vec!["eval", file], 2, "--wi"),
        (vec!["eval", file, "--wi", "0,0,1"], 2, "--wo"),
        (vec!["eval", file, "--wi", "0,0,0", "--wo", "0,0,1"], 2, "zero length"),
        (vec!["eval", file, "--wi", "0,0", "--wo", "0,0,1"], 2, "2 numbers; expected 3"),
        (vec!["eval", file, "--wi", "0,0,inf", "--wo", "0,0,1"], 2, "found `inf`"),
        (vec!["eval", file, "--angles", "0,0,0,0", "--wi", "0,0,1", "--wo", "0,0,1"], 2, "cannot be used with"),
        (vec!["eval", file, "--angles", "0,0,0,0", "--edge", "mirror"], 2, "possible values"),
        (vec!["paint"], 2, "unrecognized"),
    ] {
        let (got, message) = failed(&args);
        assert_eq!(got, Some(code), "{args:?}: {message}");
        assert!(message.contains(expected), "{args:?}: {message}");
    }
}

#[test]
fn a_reader_that_stops_early_is_not_a_failure() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let pairs = files.write("pairs.csv", &"0,0,1,0,0,1\n".repeat(100_000));
    let mut child = Command::new(env!("CARGO_BIN_EXE_lobe"))
        .args(["eval", text(&file), "--pairs", text(&pairs)])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}
