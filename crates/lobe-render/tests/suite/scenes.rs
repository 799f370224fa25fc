//! Tests of scene files: their meaning, and the errors of wrong ones.

use std::path::{Path, PathBuf};

use lobe_render::scene::Scene;
use lobe_render::shader::Backend;

use super::common::*;

fn parse(text: &str) -> Result<Scene, String> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    Scene::parse(Path::new("scene.toml"), &folder, text, Backend::best()).map_err(|error| error.to_string())
}

const GOOD: &str = r#"[camera]
position = [0, 1, 4]
target = [0, 0, 0]
field_of_view = 45

[film]
width = 32
height = 24

[integrator]
samples = 4

[material.cloth]
file = "cloth-17x7x17x13.ddr"

[material.gold]
model = "conductor"
alpha = 0.2
eta = [0.143, 0.375, 1.442]
k = [3.983, 2.386, 1.603]

[[object]]
shape = "plane"
size = 4
material = "cloth"

[[object]]
shape = "sphere"
radius = 0.5
translate = [0, 0.5, 0]
material = "gold"

[[light]]
kind = "point"
position = [1, 3, 1]
intensity = 20

[[light]]
kind = "environment"
zenith = [0.2, 0.3, 0.5]
horizon = 0.4
"#;

#[test]
fn a_scene_renders() {
    let scene = parse(GOOD).unwrap();
    assert_eq!((scene.size, scene.samples), ([32, 24], 4));
    assert_eq!(format!("{:?}", scene.integrator), format!("{:?}", path_of(8)));
    assert_eq!(scene.hash.len(), 32);
    assert_ne!(scene.hash, parse(&GOOD.replace("intensity = 20", "intensity = 21")).unwrap().hash);
    let mut settings = settings(scene.size, scene.samples, scene.integrator);
    settings.camera = scene.camera;
    assert!(mean(&picture(&scene.world, &settings)) > 0.05);
}

/// Each mistake with the line and the words of its error.
#[test]
fn mistakes_are_named_with_their_line_and_key() {
    let cases: &[(&str, &str, usize, &str)] = &[
        ("field_of_view = 45", "field_of_view = 200", 4, "camera.field_of_view: found 200; expected degrees"),
        ("field_of_view = 45", "field_of_view = nan", 4, "camera.field_of_view"),
        ("field_of_view = 45", "fov = 45", 4, "camera.fov: no such key; expected one of"),
        ("target = [0, 0, 0]", "target = [0, 1, 4]", 3, "camera.target: `target` is at `position`"),
        ("target = [0, 0, 0]", "target = [0, 0]", 3, "camera.target: found [0, 0]; expected three numbers"),
        ("target = [0, 0, 0]", "", 1, "camera.target: found nothing"),
        ("target = [0, 0, 0]", "target = [0, 0, 0", 4, ""),
        ("width = 32", "width = 0", 7, "film.width: found 0; expected a whole number"),
        ("width = 32", "width = 1000000000", 7, "film.width"),
        ("width = 32\nheight = 24", "width = 65536\nheight = 65536", 7, "found 65536 x 65536 pixels"),
        ("width = 32", "width = 32.5", 7, "film.width: found 32.5"),
        ("samples = 4", "samples = -1", 11, "integrator.samples: found -1"),
        ("samples = 4", "kind = \"magic\"", 11, "integrator.kind: found `magic`; expected path"),
        ("file = \"cloth-17x7x17x13.ddr\"", "front = [\"nowhere.ddr\"]", 14, "material.cloth.front"),
        ("file = \"cloth-17x7x17x13.ddr\"", "back = \"nowhere.ddr\"", 14, "expected an array of texts"),
        (
            "model = \"conductor\"",
            "model = \"conductor\"\nfront = [\"README.md\"]",
            16,
            "material.gold: found no or too",
        ),
        ("cloth-17x7x17x13.ddr", "nowhere.ddr", 14, "material.cloth.file"),
        ("cloth-17x7x17x13.ddr", "README.md", 14, "content of no known format"),
        ("model = \"conductor\"", "model = \"gold\"", 17, "material.gold.model: found `gold`; expected lambert"),
        ("alpha = 0.2", "alpha = 0", 18, "material.gold.alpha: found 0"),
        ("eta = [0.143, 0.375, 1.442]", "", 17, "material.gold.eta: found nothing"),
        ("shape = \"plane\"", "shape = \"flat\"", 23, "object[0].shape: found `flat`; expected sphere"),
        ("shape = \"plane\"", "file = \"nowhere.ply\"", 23, "object[0].file"),
        ("size = 4", "sise = 4", 24, "object[0].sise: no such key"),
        (
            "material = \"gold\"",
            "material = \"silver\"",
            31,
            "found `silver`; expected one of the materials: cloth, gold",
        ),
        ("radius = 0.5", "radius = \"big\"", 29, "object[1].radius: found `big`"),
        ("radius = 0.5", "refine = 0", 29, "object[1].refine: found 0; expected a whole number from 1 to 32"),
        ("radius = 0.5", "segments = 512\nrefine = 32", 30, "triangles; expected at most 67108864"),
        ("translate = [0, 0.5, 0]", "translate = [0, inf, 0]", 30, "object[1].translate"),
        ("kind = \"point\"", "kind = \"neon\"", 34, "light[0].kind: found `neon`; expected point"),
        ("intensity = 20", "intensity = -1", 36, "light[0].intensity: found -1"),
        ("intensity = 20", "", 33, "light[0].intensity: found nothing"),
        ("kind = \"point\"", "kind = \"environment\"", 34, "light[0]"),
        ("[[light]]", "[[lamp]]", 33, "lamp: no such key"),
    ];
    for (from, to, line, words) in cases {
        let text = GOOD.replacen(from, to, 1);
        assert_ne!(text, GOOD, "{from}");
        let error = parse(&text).expect_err(to);
        let prefix = format!("scene.toml:{line}: ");
        let found_line: usize = error.split(':').nth(1).unwrap().parse().unwrap();
        assert!(error.starts_with("scene.toml:") && error.contains(words), "{to}: {error}");
        assert!(found_line.abs_diff(*line) <= 1, "{to}: {error}; expected {prefix}");
    }
}

#[test]
fn options_that_make_no_difference_are_errors() {
    let with = |line: &str| parse(&GOOD.replace("17x13.ddr\"\n", &format!("17x13.ddr\"\n{line}\n")));
    for (line, expected) in [
        ("lookup = \"linear\"", "expected a grid of half and difference angles"),
        ("indexed_by = \"light\"", "expected a material of the EPFL database"),
    ] {
        let error = with(line).expect_err(line);
        assert!(
            error.contains("scene.toml:15:") && error.contains("specular table") && error.ends_with(expected),
            "{error}"
        );
    }
    assert!(with("edge = \"zero\"").is_ok());
    let sheet =
        GOOD.replace("file = \"cloth-17x7x17x13.ddr\"", "front = [\"cloth-17x7x17x13.ddr\"]\nlookup = \"nearest\"");
    let error = parse(&sheet).expect_err("a sheet");
    assert!(error.contains("scene.toml:15:") && error.ends_with("half and difference angles"), "{error}");
}

#[test]
fn meshes_with_bad_numbers_are_errors() {
    let folder = folder();
    let scene = |mesh: &str| {
        std::fs::write(folder.path().join("mesh.obj"), mesh).unwrap();
        let text = GOOD.replacen("shape = \"plane\"\nsize = 4", "file = \"mesh.obj\"", 1);
        let text = text.replacen("file = \"cloth-17x7x17x13.ddr\"", "model = \"lambert\"\nalbedo = 0.5", 1);
        Scene::parse(Path::new("scene.toml"), folder.path(), &text, Backend::best()).map_err(|error| error.to_string())
    };
    assert!(scene("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n").is_ok());
    for bad in ["v 0 0 nan\nv 1 0 0\nv 0 0 1\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 4\n", "v 0 0\nf 1 1 1\n"] {
        let error = scene(bad).expect_err(bad);
        assert!(error.contains("scene.toml:24: object[0].file") && error.contains("mesh.obj"), "{error}");
    }
    // Far beyond what rays can reach.
    let error = scene("v 0 0 0\nv 1e30 0 0\nv 0 0 1\nf 1 2 3\n").expect_err("a huge triangle");
    assert!(error.contains("object[0]"), "{error}");
    // A degenerate triangle is not an error, but it does not emit.
    assert!(scene("v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\n").is_ok());
    let text = GOOD.replacen("size = 4", "size = 4\nradiance = 5", 1);
    assert!(parse(&text).is_ok());
}

#[test]
fn files_that_are_not_text() {
    let folder = folder();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, [b'[', 0xff, 0xfe]).unwrap();
    let error = Scene::open(&path, Backend::best()).unwrap_err().to_string();
    assert!(error.contains("scene.toml:1: ") && error.contains("UTF-8"), "{error}");
    let error = Scene::open(&folder.path().join("missing.toml"), Backend::best()).unwrap_err().to_string();
    assert!(error.contains("missing.toml:1: "), "{error}");
    for text in ["", "[camera]", "camera = 3", "[[camera]]", "object = 1"] {
        assert!(parse(text).is_err(), "{text}");
    }
}
