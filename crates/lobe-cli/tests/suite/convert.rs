//! `lobe convert`, `lobe generate`, `lobe completions` and `lobe man` from outside.

use std::process::{Command, Output};

use lobe_testing::files::fixture;
use tempfile::TempDir;

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Folder(tempfile::tempdir().expect("a folder"))
    }

    /// Runs lobe in the folder.
    fn lobe(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_lobe")).current_dir(&self.0).args(arguments).output().expect("lobe runs")
    }

    /// The standard error of a command that succeeds.
    fn said(&self, arguments: &[&str]) -> String {
        let output = self.lobe(arguments);
        let said = String::from_utf8(output.stderr).expect("text");
        assert!(output.status.success(), "{arguments:?}: {said}");
        said
    }

    /// The message of a command that is refused with exit code 2; no file is written.
    fn refused(&self, arguments: &[&str], out: &str) -> String {
        let output = self.lobe(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!self.0.path().join(out).exists(), "{out} was written");
        String::from_utf8(output.stderr).expect("text")
    }

    fn printed(&self, arguments: &[&str]) -> String {
        let output = self.lobe(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.path().join(name)).expect("a text file")
    }

    /// The largest of the errors at the probes, and the median.
    fn errors(said: &str) -> [f64; 2] {
        let number = |after: &str| {
            let rest = said.split(after).nth(1).unwrap_or_else(|| panic!("no {after:?} in {said}"));
            rest.trim().split([',', '\n', ' ']).next().and_then(|x| x.parse().ok()).expect("a number")
        };
        [number("largest"), number("median")]
    }
}

const CONDUCTOR: &str = "conductor-7x8x13.ddr";

#[test]
fn data_that_a_format_can_hold_are_written_unchanged() {
    let folder = Folder::new();
    let source = fixture(CONDUCTOR);
    let source = source.to_str().expect("a path in UTF-8");
    let said = folder.said(&["convert", source, "table.ssdd"]);
    assert_eq!(said, "table.ssdd: SSDD, with the values and nodes of the file\n");
    folder.said(&["convert", "table.ssdd", "table.csv"]);
    folder.said(&["convert", "table.csv", "back.ddr"]);
    assert!(folder.read("back.ddr") == std::fs::read_to_string(fixture(CONDUCTOR)).expect("the fixture"));

    let said = folder.said(&["convert", source, "table.bsdf", "--to", "zemax"]);
    assert_eq!(
        said,
        "table.bsdf: Zemax BSDF, with the values and nodes of the file; R G B, assumed to be linear sRGB, as X Y Z\n"
    );
    let angles = ["--angles", "25,0,4,60"];
    let rgb: Vec<f64> = folder
        .printed(&[&["eval", source], &angles[..]].concat())
        .split_whitespace()
        .skip(1)
        .step_by(2)
        .map(|x| x.parse().expect("a number"))
        .collect();
    let xyz = folder.printed(&[&["eval", "table.bsdf", "--channel", "Y"], &angles[..]].concat());
    let y: f64 = xyz.split_whitespace().nth(1).expect("a value").parse().expect("a number");
    let expected = 0.2126529 * rgb[0] + 0.7151833 * rgb[1] + 0.0721638 * rgb[2];
    assert!((y - expected).abs() < 1e-5 * expected, "{y} instead of {expected}");

    folder.said(&["convert", source, "green.bsdf", "--to", "zemax", "--channel", "G"]);
    let green = folder.printed(&[&["eval", "green.bsdf"], &angles[..]].concat());
    let green: f64 = green.split_whitespace().nth(1).expect("a value").parse().expect("a number");
    assert!((green - rgb[1]).abs() < 1e-6 * rgb[1], "{green} instead of {}", rgb[1]);
}

#[test]
fn resampling_is_reported_with_its_error() {
    let folder = Folder::new();
    let source = fixture(CONDUCTOR);
    let source = source.to_str().expect("a path in UTF-8");
    let coarse = folder.said(&["convert", source, "coarse.bsdf", "--to", "rgl", "--zeniths", "6", "--texels", "12"]);
    assert!(
        coarse.starts_with(
            "coarse.bsdf: RGL BSDF, resampled: isotropic reflection, 6 theta_i x 1 phi_i, 12 x 12 texels\n"
        ),
        "{coarse}"
    );
    let fine = folder.said(&["convert", source, "fine.bsdf", "--to", "rgl"]);
    let ([_, coarse], [_, fine]) = (Folder::errors(&coarse), Folder::errors(&fine));
    assert!(fine < 0.5 * coarse && fine < 5e-3, "median {fine} after {coarse}");
    assert!(folder.printed(&["info", "fine.bsdf"]).contains("RGL BSDF"));

    let klems = folder.said(&["convert", source, "sheet.xml", "--basis", "quarter"]);
    assert!(klems.contains("means over 41 x 41 patches"), "{klems}");
    assert!(folder.printed(&["info", "sheet.xml"]).contains("CIE-X"));
}

#[test]
fn data_that_a_format_cannot_hold_are_refused() {
    let folder = Folder::new();
    std::fs::write(
        folder.0.path().join("glass.ddt"),
        "TypeSym ASymmetrical TypeColorModel BW sigma 2 0 60 phi 2 0 360 theta 2 0 180 bw def 1 1 1 1 1 1 1 1 enddef",
    )
    .expect("written");
    let said = folder.refused(&["convert", "glass.ddt", "x.bsdf", "--to", "rgl"], "x.bsdf");
    assert_eq!(said, "error: x.bsdf: found transmission; expected reflection in RGL BSDF\n");
    let said = folder.refused(&["convert", "glass.ddt", "x.bsdf"], "x.bsdf");
    assert!(
        said.contains("the extension .bsdf, which RGL and Zemax and LightTools files share; expected --to"),
        "{said}"
    );
    let said = folder.refused(&["convert", "glass.ddt", "x.txt"], "x.txt");
    assert!(said.contains("the extension .txt, which belongs to no format that lobe writes"), "{said}");
    let said = folder.refused(&["convert", "glass.ddt", "x.sdt"], "x.sdt");
    assert!(said.contains("expected mirror reflectances"), "{said}");
    let said = folder.refused(&["convert", "glass.ddt", "x.ssdd", "--channel", "R"], "x.ssdd");
    assert!(said.contains("found no channel R; expected one of Y"), "{said}");

    let cloth = fixture("cloth-17x7x17x13.ddr");
    let cloth = cloth.to_str().expect("a path in UTF-8");
    let said = folder.refused(&["convert", cloth, "x.binary"], "x.binary");
    assert!(said.contains("found an anisotropic material; expected an isotropic one in MERL"), "{said}");
    let spectral = "TypeSym ASymmetrical TypeColorModel spectral 2 sigma 1 0 phi 2 0 360 theta 2 0 180 wl 450 def 1 1 1 1 enddef wl 600 def 1 1 1 1 enddef";
    std::fs::write(folder.0.path().join("spectral.ddr"), spectral).expect("written");
    let said = folder.refused(&["convert", "spectral.ddr", "x.xml"], "x.xml");
    assert!(said.contains("found the channels 450nm 600nm; expected one channel, X Y Z or named bands"), "{said}");
    folder.said(&["convert", "spectral.ddr", "x.xml", "--channel", "600nm"]);
}

#[test]
fn models_become_tables() {
    let folder = Folder::new();
    let said = folder.said(&["generate", "lambert", "white.ddr", "--albedo", "0.5"]);
    assert!(
        said.starts_with("white.ddr: Integra DDR/DDT, resampled: isotropic reflection, 19 sigma x 1 psi"),
        "{said}"
    );
    assert!(Folder::errors(&said)[0] < 1e-6, "{said}");
    let knots = ["--sigma", "0,30,60", "--psi", "0,180,360", "--theta", "0,10,40,180", "--phi", "0,90,180,270,360"];
    let said = folder.said(&[&["generate", "ggx", "brushed.ssdd", "--alpha", "0.1,0.4"], &knots[..]].concat());
    assert!(said.contains("anisotropic reflection, 3 sigma x 3 psi x 4 theta x 5 phi"), "{said}");
    for (model, option) in [
        ("ward", "--alpha=0.3"),
        ("oren-nayar", "--roughness=30"),
        ("phong", "--exponent=9"),
        ("blinn", "--exponent=9"),
    ] {
        let said = folder.said(&["generate", model, "table.ddr", option]);
        assert!(Folder::errors(&said)[1] < 0.03, "{model}: {said}");
    }
    let small =
        ["--paths", "20", "--sigma", "0,60", "--psi", "0,90,180,270,360", "--theta", "0,30,180", "--phi", "0,180,360"];
    let said = folder.said(&[&["generate", "cloth", "cloth.ddr"], &small[..]].concat());
    assert!(said.contains("anisotropic"), "{said}");
    let said = folder.refused(&["generate", "ward", "x.ddr", "--specular", "1.5"], "x.ddr");
    assert!(said.contains("found `1.5`; expected a number from 0 to 1"), "{said}");
}

#[test]
fn the_shell_knows_the_commands() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = folder.printed(&["completions", shell]);
        assert!(script.contains("convert") && script.contains("generate"), "{shell}");
    }
    let page = folder.printed(&["man"]);
    assert!(page.contains(".TH lobe 1"), "{page}");
    folder.printed(&["man", "--out", "pages"]);
    for page in ["lobe.1", "lobe-convert.1", "lobe-generate-ggx.1"] {
        assert!(folder.read(&format!("pages/{page}")).contains(".SH"), "{page}");
    }
}

#[test]
fn every_command_has_an_example() {
    let folder = Folder::new();
    for command in ["info", "eval", "convert", "generate", "completions", "man"] {
        let help = folder.printed(&[command, "--help"]);
        assert!(help.contains("Example") && help.contains(&format!("lobe {command}")), "{command}: {help}");
    }
}

/// A conversion reports the numbers that `lobe compare` finds, and the file keeps them.
#[test]
fn what_a_conversion_states_is_what_compare_finds() {
    let folder = Folder::new();
    let source = fixture(CONDUCTOR);
    let source = source.to_str().expect("a path in UTF-8");
    for (out, options, comment) in [
        ("a.bsdf", &["--to", "rgl", "--zeniths", "8", "--texels", "16"][..], true),
        ("b.xml", &["--basis", "quarter"], true),
        ("c.xml", &["--basis", "tree3", "--depth", "4", "--leaf-error", "0.2"], true),
        ("d.txt", &["--to", "astm"], false),
        ("e.bsdf", &["--to", "lighttools"], true),
        ("f.mbsdf", &[], true),
        ("g.binary", &["--to", "merl"], false),
        ("h.brdf", &["--channel", "G"], true),
        ("i.bin", &[], false),
        ("j.pbsdf", &["--channel", "G"], false),
    ] {
        let output = folder.lobe(&[&["convert", source, out, "--json"], options].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{out}: {said}");
        let stated: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let channel = if options.contains(&"--channel") { options } else { &[] };
        let found = folder.printed(&[&["compare", "--json", source, out, "--pixels", "8"], channel].concat());
        let found: serde_json::Value = serde_json::from_str(&found).expect("JSON");
        for name in ["max", "rms", "relative_rms", "pairs"] {
            let [stated, found] = [&stated["error"], &found].map(|list| list[0]["difference"][name].as_f64());
            assert!(stated.is_some() && stated == found, "{out}: {name} {stated:?} and {found:?}");
        }
        let max = format!("{:.3e}", stated["error"][0]["difference"]["max"].as_f64().expect("a number"));
        assert!(said.contains(&max), "{out}: {said}");
        let bytes = std::fs::read(folder.0.path().join(out)).expect("the file");
        let is_kept = bytes.windows(max.len()).any(|bytes| bytes == max.as_bytes());
        assert_eq!(is_kept, comment, "{out}");
    }
}

/// Nodes are refined until the bound is met; if it cannot be met, nothing is written.
#[test]
fn a_bound_is_met_or_the_conversion_fails() {
    let folder = Folder::new();
    let source = fixture(CONDUCTOR);
    let source = source.to_str().expect("a path in UTF-8");
    let knots = ["--sigma", "0,30,60,85", "--theta", "0,5,15,30,60,90,180", "--phi", "0,90,180,270,360"];
    folder.said(&["generate", "ggx", "gold.bsdf", "--to", "rgl", "--alpha", "0.4"]);
    let coarse = folder.lobe(&[&["convert", "gold.bsdf", "coarse.ddr", "--json"], &knots[..]].concat());
    let error = |output: &Output| {
        let stated: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        stated["error"][0]["difference"]["relative_rms"].as_f64().expect("a number")
    };
    let before = error(&coarse);
    let bound = format!("{:.5}", before / 3.0);
    let fine = folder.lobe(&[&["convert", "gold.bsdf", "fine.ddr", "--json", "--error", &bound], &knots[..]].concat());
    assert!(fine.status.success(), "{}", String::from_utf8_lossy(&fine.stderr));
    assert!(error(&fine) <= before / 3.0, "{} after {before}", error(&fine));
    folder.said(&["compare", "gold.bsdf", "fine.ddr", "--within", &bound, "--pixels", "8"]);
    // There are no finer patches than those of the full basis.
    let output = folder.lobe(&["convert", source, "x.xml", "--basis", "half", "--error", "1e-4"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("the smallest error that was reached is") && said.contains("145 x 145 patches"), "{said}");
    assert!(!folder.0.path().join("x.xml").exists());
}

#[test]
fn matrices_are_multiplied() {
    let folder = Folder::new();
    let write = |name: &str, text: &str| std::fs::write(folder.0.path().join(name), text).expect("written");
    write("v.mtx", "#?RADIANCE\nNROWS=1\nNCOLS=2\nNCOMP=3\nFORMAT=ascii\n\n1 2 3\t4 5 6\n");
    write("s.txt", "1 1 1\n0.5 1 2\n");
    let printed = folder.printed(&["matrix", "v.mtx", "s.txt"]);
    assert!(printed.ends_with("FORMAT=ascii\n\n3 7 15\n"), "{printed}");
    let printed = folder.printed(&["matrix", "v.mtx", "s.txt", "--minus", "v.mtx,s.txt", "--plus", "v.mtx,s.txt"]);
    assert!(printed.ends_with("\n\n3 7 15\n"), "{printed}");
    folder.said(&["matrix", "v.mtx", "s.txt", "-o", "out.mtx", "--format", "float"]);
    write("one.txt", "2 2 2\n");
    let printed = folder.printed(&["matrix", "out.mtx", "one.txt"]);
    assert!(printed.ends_with("\n\n6 14 30\n"), "{printed}");
    let said = folder.refused(&["matrix", "s.txt", "v.mtx", "s.txt", "v.mtx", "v.mtx", "-o", "x.mtx"], "x.mtx");
    assert!(said.contains("v.mtx (1 rows x 2 columns of 3 components): found 1 rows; expected 2"), "{said}");
}

#[test]
fn a_page_shows_where_a_fit_fails() {
    let folder = Folder::new();
    let source = fixture(CONDUCTOR);
    let source = source.to_str().expect("a path in UTF-8");
    folder.printed(&["fit", source, "--model", "lambert", "-o", "fit.json"]);
    folder.printed(&["plot", source, "-o", "page.html", "--fit", "fit.json", "--width", "200"]);
    let page = folder.read("page.html");
    assert!(
        page.contains("The fit, and where it fails") && page.contains("lambert") && page.contains("rms "),
        "no fit"
    );
    assert!(page.contains("CIE ΔE 2000") && page.contains(" % below "), "no spheres");
    let said = folder.refused(&["plot", source, "-o", "x.svg", "--fit", "fit.json"], "x.svg");
    assert!(said.contains("a fit with a figure"), "{said}");
    let said = folder.lobe(&["plot", source, "-o", "y.html", "--fit", source]);
    assert_eq!(said.status.code(), Some(1));
}
