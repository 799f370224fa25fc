//! Pictures of wavelengths and of polarised light have the same bytes, however they are rendered.

use std::path::{Path, PathBuf};

use crate::common::{Files, printed, text};

/// What `[spectrum]` says: wavelengths, and polarised light.
const KINDS: [(&str, &str); 2] =
    [("bands", "bands = 9"), ("wavelengths", "wavelengths = [450, 520, 600]\nstokes = true")];

/// Measured matrices, glass with dispersion, films, metals, a polariser and a retarder, under polarised light.
fn scene(spectrum: &str, size: [u32; 2]) -> String {
    let measured = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/standard-7x9x13.mueller");
    let models = [
        ("glass", "model = \"glass\"\nglass = \"SF11\""),
        ("metal", "model = \"conductor\"\nmetal = \"gold\"\nalpha = 0.2"),
        ("mirror", "model = \"mirror\"\nmetal = \"silver\"\nfilm = { eta = 1.8, thickness = 250 }"),
        ("polariser", "model = \"polariser\"\nangle = 20"),
        ("retarder", "model = \"retarder\"\nangle = 70"),
    ];
    let mut scene = format!(
        "[camera]\nposition = [0, 1.4, 4]\ntarget = [0, 0.5, 0]\n[film]\nwidth = {}\nheight = {}\n[spectrum]\n{spectrum}\n\
         [integrator]\nsamples = 6\n[material.floor]\nfile = {measured:?}\n[[object]]\nshape = \"plane\"\nsize = 6\nmaterial = \"floor\"\n",
        size[0], size[1]
    );
    for (at, (name, model)) in models.into_iter().enumerate() {
        let x = 0.7 * (at % 3) as f64 - 0.7;
        let object = match at {
            0..3 => format!("shape = \"sphere\"\nradius = 0.33\nsegments = 24\ntranslate = [{x}, 0.34, 0]"),
            _ => format!("shape = \"plane\"\nsize = 0.7\nrotate = [80, 0, 0]\ntranslate = [{x}, 0.5, 1]"),
        };
        scene += &format!("[material.{name}]\n{model}\n[[object]]\n{object}\nmaterial = \"{name}\"\n");
    }
    scene
        + "[[light]]\nkind = \"point\"\nposition = [2, 3, 2]\nintensity = 6\nspectrum = \"A\"\n\
             [[light]]\nkind = \"environment\"\nzenith = [0.2, 0.3, 0.8]\nhorizon = 0.6\npolarised = { sun = [1, 2, 1] }\n"
}

fn read(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("a picture")
}

#[test]
fn backends_threads_and_parts_make_the_same_picture() {
    let files = Files::new();
    let backends: Vec<&str> = ::lobe::Backend::available().iter().map(|backend| backend.name()).collect();
    for (name, spectrum) in KINDS {
        let scene = files.write("scene.toml", &scene(spectrum, [24, 16]));
        let render = |out: &str, backend: &str, options: &[&str]| -> PathBuf {
            let out = files.path(&format!("{name} {out}.exr"));
            let common = ["render", text(&scene), "-o", text(&out), "--strict", "--backend", backend];
            printed(&[&common[..], options].concat());
            out
        };
        let whole = read(&render("whole", "scalar", &["--threads", "1"]));
        for backend in &backends {
            let other = read(&render("other", backend, &["--threads", "2"]));
            assert!(other == whole, "{name}: {backend}");
        }
        // Each part on another backend.
        for options in [
            [["--samples-range", "0..1"], ["--samples-range", "1..4"], ["--samples-range", "4..6"]],
            [["--tile", "1/3"], ["--tile", "2/3"], ["--tile", "3/3"]],
        ] {
            let out = |at: usize| format!("part {at} by {}", options[at][0]);
            let part = |at: usize| render(&out(at), backends[at % backends.len()], &options[at]);
            let [one, two, three] = [0, 1, 2].map(part);
            let merged = files.path("merged.exr");
            printed(&["merge", text(&two), text(&three), text(&one), "-o", text(&merged)]);
            assert!(read(&merged) == whole, "{name}: parts by {}", options[0][0]);
        }
    }
}

/// The smallest and the largest number of samples of a pixel in an unfinished picture.
#[cfg(unix)]
fn samples(picture: &Path) -> (u32, u32) {
    use lobe_render::picture::{inspect, read_partial_in};
    use lobe_render::{Bands, Energy16, Stokes16, StokesRgb};
    let light = inspect(picture).expect("a picture").light;
    let expected = "sums that can be continued";
    let Some(basis) = light.bands().expect("wavelengths") else {
        return read_partial_in::<StokesRgb>(picture, &()).expect(expected).0.samples();
    };
    if light.stokes {
        return read_partial_in::<Stokes16>(picture, &basis).expect(expected).0.samples();
    }
    let bands = || read_partial_in::<Bands<16>>(picture, &basis).ok().map(|(film, _)| film.samples());
    let energy = || read_partial_in::<Energy16>(picture, &basis).ok().map(|(film, _)| film.samples());
    bands().or_else(energy).expect(expected)
}

/// Killed without a word, like a machine that fails: the last intermediate picture is continued.
#[cfg(unix)]
#[test]
fn killed_and_resumed() {
    use std::os::unix::process::ExitStatusExt as _;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let files = Files::new();
    for (name, spectrum) in KINDS {
        let scene = files.write("scene.toml", &scene(spectrum, [60, 40]));
        let [out, anew] = ["killed", "anew"].map(|kind| files.path(&format!("{name} {kind}.exr")));
        let render = ["render", text(&scene), "-o", text(&out), "--strict"];
        let mut child = Command::new(env!("CARGO_BIN_EXE_lobe"))
            .args(render)
            .args(["--samples", "60000", "--threads", "2", "--write-every", "1ms"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program");
        let begun = Instant::now();
        while !(out.exists() && samples(&out).1 > 0) && begun.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(2));
        }
        // In the midst of the next picture, which is written at every opportunity.
        std::thread::sleep(Duration::from_millis(150));
        child.kill().expect("a child");
        assert_eq!(child.wait().expect("an end").signal(), Some(9), "{name}: too quick to test");
        let (least, most) = samples(&out);
        assert!(most > 0 && least < 60_000, "{name}: {least} to {most}");
        // With another number of samples, so that this test is short.
        let total = (most + 1).to_string();
        printed(&[&render[..], &["--samples", &total, "--resume"]].concat());
        printed(&["render", text(&scene), "-o", text(&anew), "--strict", "--samples", &total, "--threads", "1"]);
        assert!(read(&out) == read(&anew), "{name}");
    }
}
