//! The program from outside: what it prints, and the code it ends with.

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

/// What the command prints, which has to succeed.
fn printed(args: &[&str]) -> String {
    let output = lobe(args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The exit code of a command that fails, which has to print nothing but a message.
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
        "values    12 of f in 1/sr, -2 to 2, 2 negative, 48 bytes as f32",
        "  comment: lacquer",
    ] {
        assert!(shown.lines().any(|shown| shown == line), "{line:?} is not in\n{shown}");
    }
    let json: serde_json::Value = serde_json::from_str(&printed(&["info", "--json", text(&file)])).unwrap();
    assert_eq!(json["axes"][0]["knots_degrees"], serde_json::json!([0.0, 60.0]));
    assert_eq!(json["values"]["negative"], 2);
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
    assert!(message.contains("mirror.sdr: found Integra SDR/SDT, which is no table"), "{message}");
}

#[test]
fn eval_of_one_pair() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let file = text(&file);
    // Half way from the mirror direction to 90 degrees off it.
    let half = "--wi=-1,0,1 --wo 0,0,3";
    let args: Vec<&str> = ["eval", file].into_iter().chain(half.split(' ')).collect();
    assert_eq!(printed(&args), "R 0.5\nG 1\nB 0\n");
    assert_eq!(
        printed(&["eval", file, "--wi", "-1,0,1", "--wo", "0,0,3", "--edge", "extrapolate"]),
        "R 0.5\nG 1\nB -0.5\n"
    );
    assert_eq!(printed(&["eval", file, "--angles", "45,0,45,0"]), "R 0.5\nG 1\nB 0\n");
    // Sigma 70 is beyond the last angle.
    assert_eq!(printed(&["eval", file, "--angles", "70,0,0,0"]), "R 1\nG 2\nB 1\n");
    assert_eq!(printed(&["eval", file, "--angles", "70,0,0,0", "--edge", "zero"]), "R 0\nG 0\nB 0\n");
    // Below the horizon.
    assert_eq!(printed(&["eval", file, "--wi", "0,0,1", "--wo", "0.1,0,-1"]), "R 0\nG 0\nB 0\n");
    let json: serde_json::Value =
        serde_json::from_str(&printed(&["eval", file, "--angles", "0,0,0,0", "--json"])).unwrap();
    assert_eq!(json["values"], serde_json::json!([1.0, 2.0, 1.0]));
    assert_eq!(json["wi"], serde_json::json!([0.0, 0.0, 1.0]));
}

#[test]
fn eval_of_many_pairs() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    let with_header =
        files.write("pairs.csv", "wix,wiy,wiz,wox,woy,woz\n# light above\n\n0,0,1,0,0,1\n-1,0,1, 0,0,2\r\n");
    assert_eq!(printed(&["eval", text(&file), "--pairs", text(&with_header)]), "1,2,1\n0.5,1,0\n");
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
fn bad_pairs_are_named_with_their_line() {
    let files = Files::new();
    let file = files.write("lacquer.ddr", RGB);
    for (content, expected) in [
        ("a,b,c,d,e,f\n0,0,1,0,0,1\n0,0,0,0,0,1\n", "bad.csv:3: found a direction of zero length"),
        ("0,0,1,0,0,1\n# note\n\n0,0,nan,0,0,1\n", "bad.csv:4: found `nan`; expected a finite number"),
        ("0,0,1,0,0,x\n", "bad.csv:1: found `x`"),
        ("0,0,1,0,0,1\n0,0,1,0,0\n", "bad.csv:2: found 5 columns; expected 6"),
    ] {
        let (code, message) = failed(&["eval", text(&file), "--pairs", text(&files.write("bad.csv", content))]);
        assert_eq!(code, Some(2), "{message}");
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
fn a_reader_that_has_enough_is_no_failure() {
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
