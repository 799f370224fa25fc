//! `lobe plot` as a user runs it.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use quick_xml::Reader;
use quick_xml::events::Event;

/// Lacquer, measured up to 60 degrees from the mirror direction.
const LACQUER: &str = "Source Measured\nTypeSym AxiSymmetrical\nTypeColorModel RGB\nsigma 3 0 30 60\nphi 1 0\ntheta 3 0 20 60\n\
    red def 9 2 1 9 2 1 9 2 1 enddef\ngre def 8 1 1 8 1 1 8 1 1 enddef\nblu def 7 1 1 7 1 1 7 1 1 enddef\n";

fn lobe(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lobe")).args(args).stdin(Stdio::null()).output().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// How many elements of a name a well-formed document has.
fn count(xml: &str, wanted: &str) -> usize {
    let mut reader = Reader::from_str(xml);
    let mut found = 0;
    loop {
        match reader.read_event().unwrap() {
            Event::Start(element) | Event::Empty(element) if element.name().as_ref() == wanted => found += 1,
            Event::Eof => return found,
            _ => {}
        }
    }
}

#[test]
fn the_extension_chooses_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("lacquer.ddr");
    std::fs::write(&file, LACQUER).unwrap();
    let out = |name: &str| folder.path().join(name);
    for (name, more) in [
        ("curves.svg", vec![]),
        ("polar.svg", vec!["--kind", "polar", "--linear"]),
        ("slices.svg", vec!["--kind", "slices", "--sigma", "0,45", "--channel", "g"]),
        ("sphere.svg", vec!["--kind", "sphere"]),
        ("page.html", vec![]),
        ("curves.png", vec!["--log", "--psi", "-30"]),
    ] {
        let out = out(name);
        let mut args = vec!["plot", text(&file), "-o", text(&out), "--width", "240"];
        args.extend(more);
        let output = lobe(&args);
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        // It reports the size of the output, the light, and the exposure.
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let bytes = std::fs::metadata(&out).unwrap().len();
        assert!(said.starts_with(&format!("{}: ", out.display())), "{args:?}: {said}");
        assert!(said.contains(&format!(" {bytes} bytes")) && said.ends_with('\n'), "{args:?}: {said}");
        let expected = if name == "sphere.svg" { "spheres exposed at " } else { "light at 0° " };
        assert!(said.contains(expected) && output.stderr.is_empty(), "{args:?}: {said}");
    }
    let read = |name: &str| std::fs::read_to_string(out(name)).unwrap();
    // A disk for each of the two requested incidences, and the colour bar.
    assert_eq!(count(&read("slices.svg"), "image"), 3);
    assert!(read("slices.svg").contains("σ = 45°") && read("slices.svg").contains("channel G"));
    assert_eq!(count(&read("curves.svg"), "clipPath"), 1);
    // Three incidences, each with a sample in the legend and a line in the plot whose measured part ends.
    assert!(read("curves.svg").contains("class=\"s2\"") && !read("curves.svg").contains("class=\"s3\""));
    assert!(read("polar.svg").contains("linear radius"));
    // Spheres, logarithmic and linear curves, channels, lobes and slices.
    assert_eq!(count(read("page.html").trim_start_matches("<!DOCTYPE html>"), "figure"), 6);
    assert!(
        read("page.html").contains("Integra DDR/DDT")
            && read("page.html").contains("3 knots, 0 to 60 degrees: 0 30 60")
    );
    let png = std::fs::File::open(out("curves.png")).unwrap();
    let reader = png::Decoder::new(std::io::BufReader::new(png)).read_info().unwrap();
    assert_eq!(reader.info().width, 240);
}

#[test]
fn a_failed_plot_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("lacquer.ddr");
    std::fs::write(&file, LACQUER).unwrap();
    let out = |name: &str| text(&folder.path().join(name)).to_string();
    for (name, more, code, expected) in [
        ("no/such/folder/a.svg", vec![], 1, "a.svg"),
        ("a.pdf", vec![], 2, "found the extension .pdf; expected .html, .svg or .png"),
        ("a", vec![], 2, "found no extension"),
        ("a.svg", vec!["--kind", "page"], 2, "found a page in a picture"),
        ("a.html", vec!["--kind", "polar"], 2, "found a figure in .html"),
        ("a.svg", vec!["--channel", "Visible"], 2, "found no channel Visible; expected one of R, G, B"),
        ("a.svg", vec!["--side", "below"], 2, "found no values for light from the back"),
        ("a.svg", vec!["--sigma", "0,90"], 2, "expected 0 or more and less than 90 degrees"),
        ("a.svg", vec!["--log", "--linear"], 2, "cannot be used with"),
        ("a.png", vec!["--width", "9"], 2, "100..=8000"),
        ("a.svg", vec!["--kind", "spectra"], 2, "found the channels R, G, B; expected at least two wavelengths"),
        ("a.svg", vec!["--kind", "spectra", "--theta", "0,-90"], 2, "more than -90 and less than 90 degrees"),
    ] {
        let out = out(name);
        let mut args = vec!["plot", text(&file), "-o", &out];
        args.extend(more);
        let output = lobe(&args);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {message}");
        assert!(message.contains(expected), "{args:?}: {message}");
        assert!(output.stdout.is_empty(), "{args:?}");
    }
    let output = lobe(&["plot", &out("missing.ddr"), "-o", &out("a.svg")]);
    assert_eq!(output.status.code(), Some(1));
    // Only the material is there: no partial figure, no temporary file.
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["lacquer.ddr"]);
}

#[test]
fn several_files_are_drawn_together() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("new")).unwrap();
    let (old, new) = (folder.path().join("lacquer.ddr"), folder.path().join("new/lacquer.ddr"));
    std::fs::write(&old, LACQUER).unwrap();
    std::fs::write(&new, LACQUER.replace("9 2 1", "6 2 1")).unwrap();
    let out = folder.path().join("both.svg");
    let output = lobe(&["plot", text(&old), text(&new), "-o", text(&out), "--sigma", "0,30"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let svg = std::fs::read_to_string(&out).unwrap();
    assert_eq!(count(&svg, "clipPath"), 2);
    // Files of one name are distinguished by their paths.
    assert!(svg.contains("/new/lacquer.ddr: σ = 30°"), "the path of the second file");
    for (more, code, expected) in [
        (vec!["--kind", "channels"], 2, "found 2 files; expected one for the figure channels"),
        (vec!["--channel", "Visible"], 2, "found no channel Visible"),
    ] {
        let output = lobe(&[&["plot", text(&old), text(&new), "-o", text(&out)], more.as_slice()].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(code) && message.contains(expected), "{message}");
    }
}
