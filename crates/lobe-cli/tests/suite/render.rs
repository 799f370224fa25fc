//! `lobe render`, `merge` and `preview` as a user runs them.

use std::path::PathBuf;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use lobe_testing::files::{fixture, fixtures};

const SCENE: &str = r#"
[camera]
position = [0, 1.2, 4]
target = [0, 0.5, 0]

[film]
width = 80
height = 50

[integrator]
samples = 6

[material.cloth]
file = "FIXTURES/cloth-17x7x17x13.ddr"
[material.glass]
model = "glass"

[[object]]
shape = "plane"
size = 4
material = "cloth"
[[object]]
shape = "sphere"
radius = 0.5
translate = [0, 0.5, 0]
material = "glass"

[[light]]
kind = "point"
position = [1, 3, 1]
intensity = 20
[[light]]
kind = "environment"
radiance = 0.5
"#;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let scene = SCENE.replace("FIXTURES", fixtures().to_str().unwrap());
        std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
        Folder(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn command(&self, args: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lobe"));
        command.args(args.split_whitespace()).current_dir(self.0.path()).env_remove("LOBE_BACKEND");
        command
    }

    fn run(&self, args: &str) -> Output {
        self.command(args).output().unwrap()
    }

    fn good(&self, args: &str) {
        let output = self.run(args);
        assert!(output.status.success(), "{args}: {}", String::from_utf8_lossy(&output.stderr));
    }

    /// Fails with this code and message.
    fn bad(&self, args: &str, code: i32, words: &str) {
        let output = self.run(args);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(code) && error.contains(words), "{args}: {error}");
    }
}

#[test]
fn the_same_file_is_written_in_every_way() {
    let folder = Folder::new();
    folder.good("render scene.toml -o whole.exr --strict --threads 1");
    let whole = folder.bytes("whole.exr");
    folder.good("render scene.toml -o two.exr --strict --threads 2");
    assert!(folder.bytes("two.exr") == whole, "two threads");
    for &backend in lobe::Backend::ALL {
        if lobe::Backend::named(backend).is_ok() {
            folder.good(&format!("render scene.toml -o backend.exr --strict --backend {backend}"));
            assert!(folder.bytes("backend.exr") == whole, "{backend}");
        } else {
            println!("skipped {backend}, which this machine does not have");
        }
    }
    for tile in 1..=4 {
        folder.good(&format!("render scene.toml -o tile{tile}.exr --strict --tile {tile}/4"));
    }
    folder.good("merge tile1.exr tile3.exr tile4.exr tile2.exr -o merged.exr");
    assert!(folder.bytes("merged.exr") == whole, "four tiles");
    folder.good("render scene.toml -o a.exr --strict --samples-range 0..4");
    folder.good("render scene.toml -o b.exr --strict --samples-range 4..6");
    folder.good("merge b.exr a.exr -o merged.exr");
    assert!(folder.bytes("merged.exr") == whole, "two ranges of samples");

    folder.bad("merge tile1.exr tile2.exr -o gaps.exr", 1, "expected all of them");
    assert!(!folder.path("gaps.exr").exists());
    folder.good("merge tile1.exr tile2.exr -o gaps.exr --allow-gaps");
    folder.bad("merge tile1.exr a.exr -o twice.exr", 1, "every sample once");
    folder.bad("merge whole.exr -o again.exr", 1, "whole.exr");
}

#[test]
fn killed_and_resumed() {
    let folder = Folder::new();
    // Long enough to be killed on the way.
    let render = "render scene.toml --samples 800 --strict --write-every 50ms";
    let mut child = folder.command(&format!("{render} -o killed.exr")).spawn().unwrap();
    let begun = Instant::now();
    while !folder.path("killed.exr").exists() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(100));
    child.kill().unwrap();
    child.wait().unwrap();
    let (left, meta) = lobe_render::picture::read_partial(&folder.path("killed.exr")).expect("a part is left");
    assert_eq!(meta.total, 800);
    let (least, most) = left.samples();
    assert!(most > 0 && least < 800, "{least} to {most} samples were done");

    folder.bad(&format!("{render} -o killed.exr --resume --crop 0,0,10,10"), 2, "expected a part of this one");
    folder.good(&format!("{render} -o killed.exr --resume"));
    folder.good(&format!("{render} -o whole.exr"));
    assert!(folder.bytes("killed.exr") == folder.bytes("whole.exr"));
    // If there is nothing to continue, it starts.
    folder.good("render scene.toml -o fresh.png --samples 1 --resume");
    let leftovers: Vec<_> = std::fs::read_dir(folder.0.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    let stray = |path: &PathBuf| path.to_string_lossy().contains("part.exr");
    assert!(!leftovers.iter().any(stray), "{leftovers:?}");
}

#[test]
fn time_crop_and_png() {
    let folder = Folder::new();
    folder.good("render scene.toml -o crop.png --crop 10,20,40,30 --time 1ms");
    let png = folder.bytes("crop.png");
    assert_eq!(png[16..24], [0, 0, 0, 30, 0, 0, 0, 10], "width and height of the crop");
    folder.bad("render scene.toml -o crop.png --crop 10,20,400,30", 2, "expected up to 80,50");
    folder.bad("render scene.toml -o crop.png --crop 10,20,5,30", 2, "X0 < X1");
    folder.bad("render scene.toml -o tile.png --tile 1/2", 2, "expected .exr");
    folder.bad("render scene.toml -o tile.exr --tile 3/2", 2, "1 <= I <= N");
    folder.bad("render scene.toml -o tile.exr --tile 1/51", 2, "expected at most 50, the number of rows");
    folder.bad("render scene.toml -o picture.jpg", 2, "ends in .exr or .png");
    folder.bad("render scene.toml -o picture.png --backend mmx", 2, "mmx");
    folder.bad("render scene.toml -o range.exr --samples 4 --samples-range 2..6", 2, "expected 4 at most");
    folder.bad("render missing.toml -o picture.png", 1, "missing.toml:1: ");
    std::fs::write(folder.path("bad.toml"), SCENE.replace("size = 4", "sise = 4")).unwrap();
    folder.bad("render bad.toml -o picture.png", 1, "bad.toml:");
    folder.bad("render scene.toml -o nowhere/picture.png --samples 1", 1, "nowhere/picture.png");
}

#[test]
fn pictures_record_their_samples_and_statistics() {
    let folder = Folder::new();
    let short = folder.run("render scene.toml -o short.exr --time 1ms --samples 100000 --json");
    let took: serde_json::Value = serde_json::from_slice(&short.stdout).expect("JSON");
    let most = took["samples"][1].as_u64().expect("a number");
    assert!((1..100_000).contains(&most) && took["size"][0] == 80 && took["rays"].as_u64() > Some(4000), "{took}");
    assert!(took["lanes"].as_f64() > Some(0.5) && took["lanes_in_use"].as_array().is_some(), "{took}");
    let exr = folder.bytes("short.exr");
    let says = |text: String| exr.windows(text.len()).any(|window| window == text.as_bytes());
    assert!(says(format!("samples = [0, {most}]\ntotal = {most}")), "the samples that there are, {most}");

    let line = folder.run("render scene.toml -o line.png");
    let line = String::from_utf8_lossy(&line.stdout).into_owned();
    assert!(line.starts_with("line.png: 80 x 50 pixels of 6 samples in ") && line.lines().count() == 1, "{line}");
    assert!(folder.run("render scene.toml -o line.png --quiet").stdout.is_empty());
}

#[test]
fn a_preview_of_a_file() {
    let folder = Folder::new();
    let fixture = fixture("conductor-7x8x13.ddr").display().to_string();
    let said = |arguments: &str| {
        let output = folder.run(arguments);
        assert!(output.status.success(), "{arguments}");
        String::from_utf8(output.stdout).expect("UTF-8")
    };
    // It reports the number of samples and the exposure.
    let line = said(&format!("preview {fixture} -o ball.png --size 64x48 --samples 4 --exposure -1"));
    assert!(
        line.starts_with("ball.png: 64 x 48 pixels of 4 samples in ") && line.ends_with("; exposure -1 EV\n"),
        "{line}"
    );
    let line = said(&format!("preview {fixture} -o short.png --size 320x240 --samples 60000 --time 1ms"));
    assert!(line.contains(", not 60000, because the time of --time was up; exposure +0 EV\n"), "{line}");
    assert!(said(&format!("preview {fixture} -o ball.png --size 64x48 --samples 1 --quiet")).is_empty());
    assert_eq!(folder.bytes("ball.png")[16..24], [0, 0, 0, 64, 0, 0, 0, 48]);
    folder.good(&format!("preview {fixture} -o ball.exr --size 64x48 --samples 2 --show cloth"));
    // A grid of angles is sampled by histograms, which are coarse if there is hardly any time to build them.
    let mut table = String::from("theta_i,theta_o,phi_o,f\n");
    for (incident, theta, phi) in (0..36).map(|k| (k / 12 * 30, k / 4 % 3 * 30, k % 4 * 60)) {
        table += &format!("{incident},{theta},{phi},{}\n", 1 + incident + theta + phi);
    }
    std::fs::write(folder.path("table.csv"), &table).unwrap();
    let prepared = |time: &str| {
        let said = said(&format!("preview table.csv -o ball.png --size 16x16 --samples 1 --time {time}"));
        said.lines().nth(1).map(str::to_owned)
    };
    assert!(prepared("1ms").is_some_and(|line| line.contains("coarsely, to keep within --time")));
    assert_eq!(prepared("5min"), None);
    folder.bad("preview scene.toml -o ball.png", 1, "found a scene (TOML); expected a measured material");
    folder.bad(&format!("preview {fixture} -o ball.png --size 64"), 2, "expected WxH");
}
