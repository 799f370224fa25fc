//! Foreign files, compressed files and folders, and files whose control characters must not reach a terminal.

use std::path::PathBuf;

use lobe_testing::examples::{self, DDR, LIGHT_TOOLS, PAB};

use crate::common::{Files, json, printed, run, text};

fn write(files: &Files, name: &str, bytes: &[u8]) -> PathBuf {
    let path = files.path(name);
    std::fs::write(&path, bytes).expect("a file");
    path
}

#[test]
fn every_command_says_what_a_file_is() {
    let files = Files::new();
    let out = files.path("out.html");
    for (name, bytes, expected) in [
        ("page.xml", b"<!DOCTYPE html><html>".as_slice(), "found a web page (HTML); expected a measured material"),
        ("pointer.bsdf", b"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"),
        ("empty.bsdf", b"", "found an empty file"),
        ("half.binary", b"Z\0\0\0Z\0\0\0\xb4\0\0\0\0\0\0\0", "found a MERL file cut short (16 of 34,992,012 bytes)"),
        ("mesh.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "found a mesh (OBJ)"),
    ] {
        let path = write(&files, name, bytes);
        let file = text(&path);
        for args in [
            vec!["info", file],
            vec!["check", file],
            vec!["albedo", file],
            vec!["eval", file, "--wi", "0,0,1", "--wo", "0,0,1"],
            vec!["plot", file, "-o", text(&out)],
            vec!["convert", file, "out.csv"],
        ] {
            // A check lists unreadable files along with those that it checked.
            let (code, report, message) = run(&args);
            let is_said = message.contains(expected) || report.contains(expected);
            assert!(code == 1 && is_said, "{args:?}: {code}: {message}{report}");
        }
    }
}

#[test]
fn folders_of_an_instrument_open_like_files() {
    let files = Files::new();
    let folder = files.path("scan");
    std::fs::create_dir(&folder).expect("a folder");
    for (name, light) in [("a.txt", "0 0"), ("b.txt", "30 0"), ("c.txt", "60 0")] {
        std::fs::write(folder.join(name), PAB.replace("30 0\n", &format!("{light}\n"))).expect("a file");
    }
    let folder = text(&folder);
    let info = json(&["info", folder]);
    assert_eq!(info["format"], "pab gonio-photometer");
    assert_eq!(info["parts"].as_array().map(Vec::len), Some(2));
    let value = printed(&["eval", folder, "--wi", "0,0,1", "--wo", "0,0,1"]);
    assert!(value.starts_with("Y 0.3"), "{value}");
    printed(&["albedo", folder]);
}

#[test]
fn fourier_bsdfs_open_in_every_command() {
    let files = Files::new();
    let path = write(&files, "tiny.bsdf", &examples::tiny_fourier());
    let (file, out) = (text(&path), files.path("out"));
    let info = json(&["info", file]);
    assert_eq!(
        (info["format"].as_str(), info["parts"][0]["kind"].as_str()),
        (Some("Fourier BSDF"), Some("cosine series"))
    );
    assert!(printed(&["info", file]).contains("metadata: { \"made\": \"here\" }"));
    printed(&["albedo", file]);
    printed(&["eval", file, "--wi", "0.6,0,0.8", "--wo=-0.6,0,0.8"]);
    for (command, name) in [("plot", "page.html"), ("convert", "table.npz")] {
        let target = out.with_file_name(name);
        let args = match command {
            "plot" => vec!["plot", file, "-o", text(&target)],
            _ => vec!["convert", file, text(&target)],
        };
        printed(&args);
        assert!(target.metadata().expect("a file").len() > 1000, "{name}");
    }
}

#[test]
fn control_characters_are_never_printed() {
    let files = Files::new();
    let evil = "\u{1b}[31mred\u{7}";
    let harmless = |text: &str| !text.chars().any(|c| c.is_control() && c != '\n');
    let facts =
        write(&files, "facts.bsdf", LIGHT_TOOLS.replace("# made", &format!("# {evil}\nModel {evil}: ")).as_bytes());
    let found = printed(&["info", text(&facts)]);
    assert!(harmless(&found) && found.contains("\\u{1b}[31mred"), "{found:?}");
    let damaged = write(&files, "damaged.ddr", DDR.replace("sigma 2", &format!("sigma {evil}")).as_bytes());
    let pairs = write(&files, "pairs.csv", format!("0,0,1,0,0,{evil}\n").as_bytes());
    let scene = write(&files, "scene.toml", format!("\"{evil}\" = 1\nfilm = {evil}\n").as_bytes());
    let image = files.path("out.png");
    for args in [
        vec!["info", text(&damaged)],
        vec!["eval", text(&facts), "--pairs", text(&pairs)],
        vec!["render", text(&scene), "-o", text(&image)],
    ] {
        let (code, _, message) = run(&args);
        assert!(code != 0 && harmless(&message), "{args:?}: {message:?}");
    }
}
