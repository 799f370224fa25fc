//! Refused renderings, and the parts, sums and pictures that renderings leave behind: no work is lost.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{Files, printed, run, text};
use crate::hardening::SCENE;

/// Parts of a picture of a mesh whose vertices are in another file.
#[test]
fn parts_of_two_versions_of_a_buffer_are_not_merged() {
    let files = Files::new();
    let vertices = |x: f32| -> Vec<u8> {
        let corners = [[-1.0, 0.0, 0.0], [x, 0.0, 0.0], [0.0, 1.0, 0.0]];
        corners.as_flattened().iter().flat_map(|x: &f32| x.to_le_bytes()).collect()
    };
    files.write("ext.gltf", r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors": [{"bufferView": 0, "componentType": 5126,
        "count": 3, "type": "VEC3"}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "ext.bin"}]}"#);
    let scene = files.write("ext.toml", &SCENE.replace("shape = \"sphere\"", "file = \"ext.gltf\""));
    let part = |number: u32, x: f32| -> PathBuf {
        std::fs::write(files.path("ext.bin"), vertices(x)).expect("a file");
        let part = files.path(&format!("{number}-{x}.exr"));
        printed(&["render", text(&scene), "-o", text(&part), "--tile", &format!("{number}/2")]);
        part
    };
    let (one, two, other) = (part(1, 1.0), part(2, 1.0), part(2, 2.0));
    let out = files.path("out.png");
    printed(&["merge", text(&one), text(&two), "-o", text(&out)]);
    let (code, _, message) = run(&["merge", text(&one), text(&other), "-o", text(&out)]);
    assert!(code == 1 && message.contains("found the scene of"), "{message}");
    let (code, _, message) = run(&["merge", text(&one), "-o", text(&out)]);
    assert!(code == 1 && message.contains("samples 0..4 of rows 8..16"), "{message}");
}

#[test]
fn sums_are_not_lost() {
    let files = Files::new();
    let scene = files.write("scene.toml", SCENE);
    let render = |out: &str, options: &[&str]| {
        run(&[&["render", text(&scene), "-o", text(&files.path(out)), "--strict"], options].concat())
    };
    let good = |out: &str, options: &[&str]| {
        let (code, _, message) = render(out, options);
        assert_eq!(code, 0, "{out} {options:?}: {message}");
        message
    };
    // A finished picture may be rendered again; without sums, nothing can be added to it.
    good("whole.exr", &[]);
    good("whole.exr", &[]);
    assert!(good("whole.exr", &["--resume"]).contains("already finished, with 4 samples"));
    let (code, _, message) = render("whole.exr", &["--resume", "--samples", "9"]);
    assert!(code == 2 && message.contains("--keep-sums"), "{message}");
    // With its sums it continues, and ends like one that was rendered at once.
    good("kept.exr", &["--keep-sums"]);
    let (code, _, message) = render("kept.exr", &[]);
    assert!(code == 2 && message.contains("the sums of an earlier rendering of 4 samples"), "{message}");
    let (code, _, message) = render("kept.exr", &["--resume", "--samples", "2"]);
    assert!(code == 2 && message.contains("found 4 samples, more than the 2"), "{message}");
    good("kept.exr", &["--resume", "--samples", "9"]);
    good("nine.exr", &["--samples", "9"]);
    let read = |name: &str| std::fs::read(files.path(name)).expect("a picture");
    assert!(read("kept.exr") == read("nine.exr"));
    // The same applies to a PNG, which has its sums next to it.
    good("kept.png", &["--keep-sums"]);
    assert_eq!(render("kept.png", &[]).0, 2);
    good("kept.png", &["--resume", "--samples", "9"]);
    good("nine.png", &["--samples", "9"]);
    assert!(read("kept.png") == read("nine.png"));
    // --force overwrites them.
    good("lost.exr", &["--keep-sums"]);
    good("lost.exr", &["--force"]);
    assert!(read("lost.exr") == read("whole.exr"));
    // Sums of other arithmetic cannot be continued.
    if lobe_of("avx2") {
        good("fused.exr", &["--keep-sums"]);
        let out = files.path("fused.exr");
        let fused = ["render", text(&scene), "-o", text(&out), "--backend", "avx2", "--resume"];
        let (code, _, message) = run(&fused);
        assert!(code == 2 && message.contains("the arithmetic"), "{message}");
    }
}

/// Pictures of wavelengths and of polarised light continue as others do.
#[test]
fn sums_of_spectra_and_of_polarised_light_are_not_lost() {
    let files = Files::new();
    for (name, spectrum) in
        [("bands", "bands = 8"), ("stokes", "stokes = true"), ("energy", "stokes = true\nsensor = \"energy\"")]
    {
        let scene = files.write(&format!("{name}.toml"), &format!("{SCENE}\n[spectrum]\n{spectrum}\n"));
        let [kept, whole] = ["kept", "whole"].map(|kind| files.path(&format!("{name}-{kind}.exr")));
        let render = ["render", text(&scene), "--strict", "-o"];
        printed(&[&render[..], &[text(&kept), "--keep-sums"]].concat());
        printed(&[&render[..], &[text(&kept), "--resume", "--samples", "9"]].concat());
        printed(&[&render[..], &[text(&whole), "--samples", "9"]].concat());
        let read = |path: &PathBuf| std::fs::read(path).expect("a picture");
        assert!(read(&kept) == read(&whole), "{name}");
    }
}

fn lobe_of(backend: &str) -> bool {
    let available = ::lobe::Backend::available();
    available.iter().any(|found| found.name() == backend)
}

#[test]
fn tiles_ended_by_the_time_limit_are_merged() {
    let files = Files::new();
    let scene = files.write("scene.toml", SCENE);
    let bright = files.write("bright.toml", &SCENE.replace("height = 16", "height = 16\nexposure = -2"));
    let (a, b, out) = (files.path("a.exr"), files.path("b.exr"), files.path("out.exr"));
    for (tile, part) in [("1/2", &a), ("2/2", &b)] {
        printed(&["render", text(&scene), "-o", text(part), "--tile", tile, "--time", "50ms"]);
    }
    printed(&["merge", text(&a), text(&b), "-o", text(&out)]);
    let (code, _, message) = run(&["merge", text(&b), "-o", text(&out)]);
    assert!(code == 1 && message.contains("rows 0..8"), "{message}");
    // A PNG has the exposure of the scene, as if it were rendered at once.
    let part = |tile: &str| {
        let part = files.path(&format!("bright{}.exr", &tile[..1]));
        printed(&["render", text(&bright), "-o", text(&part), "--tile", tile]);
        part
    };
    let (one, two) = (part("1/2"), part("2/2"));
    let (merged, whole) = (files.path("merged.png"), files.path("whole.png"));
    printed(&["merge", text(&one), text(&two), "-o", text(&merged)]);
    printed(&["render", text(&bright), "-o", text(&whole)]);
    let read = |path: &PathBuf| std::fs::read(path).expect("a picture");
    assert!(read(&merged) == read(&whole));
    printed(&["merge", text(&one), text(&two), "-o", text(&merged), "--exposure", "0"]);
    assert!(read(&merged) != read(&whole));
}

/// Ctrl-C saves the samples so far; with `--resume`, nothing is lost.
#[cfg(unix)]
#[test]
fn interrupted_and_resumed() {
    let files = Files::new();
    let scene = files.write("scene.toml", &SCENE.replace("width = 24\nheight = 16", "width = 400\nheight = 300"));
    for out in ["a.exr", "a.png"] {
        let out = files.path(out);
        let render = ["render", text(&scene), "-o", text(&out), "--samples", "500", "--strict", "--threads", "1"];
        let child =
            Command::new(env!("CARGO_BIN_EXE_lobe")).args(render).stderr(Stdio::piped()).spawn().expect("the program");
        std::thread::sleep(Duration::from_millis(1500));
        let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
        assert!(sent.success());
        let ended = child.wait_with_output().expect("an end");
        let message = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(130), "{message}");
        assert!(message.contains("continue with the same command and --resume"), "{message}");
        assert!(out.exists());
        let part = if text(&out).ends_with("png") { files.path("a.png.part.exr") } else { out.clone() };
        let (film, _) = lobe_render::picture::read_partial(&part).expect("sums");
        let (least, most) = film.samples();
        assert!(most > 0 && least < 500, "{least} to {most}");
        // With another number of samples, so that this test is short.
        let most = (most + 1).to_string();
        let resume = ["render", text(&scene), "-o", text(&out), "--samples", &most, "--strict", "--resume"];
        assert_eq!(run(&resume).0, 0);
        let anew = files.path(if text(&out).ends_with("png") { "b.png" } else { "b.exr" });
        printed(&["render", text(&scene), "-o", text(&anew), "--samples", &most, "--strict"]);
        assert!(std::fs::read(&out).expect("a picture") == std::fs::read(&anew).expect("a picture"));
    }
}

/// A second Ctrl-C ends at once: while the picture is written, and if nobody reads what the program says.
#[cfg(unix)]
#[test]
fn interrupted_twice() {
    let files = Files::new();
    // Its sums take seconds to write.
    let scene = files.write("scene.toml", &SCENE.replace("width = 24\nheight = 16", "width = 2400\nheight = 1600"));
    for is_read in [true, false] {
        let out = files.path("a.exr");
        let (reader, mut writer) = std::io::pipe().expect("a pipe");
        if !is_read {
            // What a pipe of Linux holds: the program waits with its first word.
            writer.write_all(&[b'x'; 65_536]).expect("a pipe with room");
        }
        let mut child = Command::new(env!("CARGO_BIN_EXE_lobe"))
            .args(["render", text(&scene), "-o", text(&out), "--samples", "5000", "--threads", "1"])
            .stderr(writer)
            .spawn()
            .expect("the program");
        let interrupt = || {
            let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
            assert!(sent.success());
        };
        std::thread::sleep(Duration::from_millis(2500));
        interrupt();
        let mut said = String::new();
        let mut lines = BufReader::new(reader);
        if is_read {
            lines.read_line(&mut said).expect("a line");
            assert!(said.contains("interrupt again to end at once"), "{said}");
        } else {
            std::thread::sleep(Duration::from_millis(1000));
        }
        interrupt();
        let begun = Instant::now();
        let ended = loop {
            if let Some(ended) = child.try_wait().expect("a child") {
                break ended;
            }
            if begun.elapsed() > Duration::from_secs(60) {
                let _ = child.kill();
                panic!("it does not end");
            }
            std::thread::sleep(Duration::from_millis(5));
        };
        assert_eq!(ended.code(), Some(130), "read: {is_read}");
        if is_read {
            let mut rest = String::new();
            lines.read_to_string(&mut rest).expect("what it said");
            assert!(!rest.contains("--resume goes on"), "too quick to test: {rest}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_failed_intermediate_save_is_a_warning() {
    let files = Files::new();
    let scene = files.write("scene.toml", &SCENE.replace("width = 24\nheight = 16", "width = 200\nheight = 150"));
    let folder = files.path("folder");
    std::fs::create_dir(&folder).expect("a folder");
    let out = folder.join("a.exr");
    let mut child = Command::new(env!("CARGO_BIN_EXE_lobe"))
        .args(["render", text(&scene), "-o", text(&out), "--samples", "300", "--threads", "1", "--write-every", "20ms"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program");
    let begun = Instant::now();
    while !out.exists() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    // For a while, something that is not replaced is in its place.
    std::fs::remove_file(&out).expect("a file");
    std::fs::create_dir(&out).expect("a folder");
    // The warning, however long the machine takes for it.
    let mut said = BufReader::new(child.stderr.take().expect("a pipe"));
    let mut message = String::new();
    said.read_line(&mut message).expect("a line");
    let is_running = child.try_wait().expect("a child").is_none();
    let _ = std::fs::remove_dir(&out);
    said.read_to_string(&mut message).expect("what it said");
    let ended = child.wait_with_output().expect("an end");
    assert!(is_running, "too short to test: {message}");
    assert!(ended.status.success() && out.is_file(), "{message}");
    assert!(message.contains("warning: the picture so far was not written"), "{message}");
}

#[test]
fn a_wrong_key_of_a_scene_suggests_the_right_one() {
    let files = Files::new();
    let scene = files.write("scene.toml", &SCENE.replace("samples", "sampels"));
    let (code, _, message) = run(&["render", text(&scene), "-o", text(&files.path("a.png"))]);
    assert!(code == 1 && message.contains("did you mean `samples`?"), "{message}");
}
