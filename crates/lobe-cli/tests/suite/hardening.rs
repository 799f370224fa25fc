//! The program with the user's files, with outputs that cannot be written, and with malicious input.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{Files, diffuse, lobe, printed, run, text};

/// A scene with one white sphere, which renders quickly.
pub const SCENE: &str = "[camera]\nposition = [0, 1.2, 4]\ntarget = [0, 0.5, 0]\n[film]\nwidth = 24\nheight = 16\n[integrator]\n\
    samples = 4\n[material.floor]\nmodel = \"lambert\"\nalbedo = 0.5\n[[object]]\nshape = \"sphere\"\nmaterial = \"floor\"\n\
    [[light]]\nkind = \"environment\"\nradiance = 1\n";

/// The program in a shell, which sets limits or redirects.
#[cfg(unix)]
pub fn shell(files: &Files, script: &str) -> (i32, String, String) {
    let mut shell = Command::new("sh");
    shell.args(["-c", script]).env("LOBE", env!("CARGO_BIN_EXE_lobe")).current_dir(files.path(""));
    let output = shell.stdin(Stdio::null()).output().expect("a shell");
    let utf8 = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("an exit code"), utf8(output.stdout), utf8(output.stderr))
}

#[test]
fn figures_without_anything_positive() {
    let files = Files::new();
    let rows = |value: &str| -> String {
        let angles = [(0, 0), (20, 0), (20, 90), (20, 180), (60, 0), (60, 180)];
        angles.map(|(theta, phi)| format!("10,{theta},{phi},{value}\n")).concat()
    };
    let negative = files.write("negative.csv", &format!("theta_i,theta_o,phi_o,f\n{}", rows("-1")));
    let zero = files.write("zero.csv", &format!("theta_i,theta_o,phi_o,f\n{}", rows("0")));
    let blue = files.write("blue.csv", &format!("theta_i,theta_o,phi_o,R,G,B\n{}", rows("1,0.5,-0.01")));
    // Curves of values near the limits of floats.
    let tiny = files.write("tiny.csv", &format!("theta_i,theta_o,phi_o,f\n{}", rows("1e-38")));
    let huge = files.write("huge.csv", &format!("theta_i,theta_o,phi_o,f\n{}", rows("1e38")));
    let grid = files.write("grid.ddr", &diffuse([-0.5; 3]));
    let out = files.path("out.svg");
    for file in [&negative, &zero, &tiny, &huge, &grid] {
        for kind in ["curves", "polar", "slices", "sphere"] {
            // Spheres have their own scale.
            let scales: &[&str] = if kind == "sphere" { &[] } else { &["--log", "--linear"] };
            printed(&["plot", text(file), "-o", text(&out), "--kind", kind]);
            for scale in scales {
                printed(&["plot", text(file), "-o", text(&out), "--kind", kind, scale]);
            }
        }
    }
    printed(&["plot", text(&negative), "-o", text(&files.path("out.html"))]);
    for kind in ["curves", "polar", "slices"] {
        printed(&["plot", text(&blue), "-o", text(&out), "--kind", kind, "--channel", "B", "--linear"]);
    }
}

#[test]
fn control_characters_of_a_file_are_shown_and_not_obeyed() {
    let files = Files::new();
    let evil = "\u{1b}]0;pwned\u{7}\u{1b}[31mred\u{9b}2J";
    let ddr =
        files.write("evil.ddr", &diffuse([0.5; 3]).replace("Source Generated", &format!("Source {evil}\n;; {evil}")));
    let bad = files.write("bad.ddr", &diffuse([0.5; 3]).replace("ASymmetrical", evil));
    let csv = files.write("evil.csv", &format!("theta_i,theta_o,phi_o,{evil}\n10,0,0,1\n10,10,0,1\n10,10,90,1\n"));
    for args in [
        &["info", text(&ddr)][..],
        &["info", text(&bad)],
        &["info", text(&csv)],
        &["check", text(&ddr)],
        &["check", text(&csv)],
        &["check", text(&bad)],
        &["albedo", text(&csv)],
        &["compare", text(&csv), text(&csv), "--pairs", "10"],
        &["eval", text(&csv), "--wi", "0,0,1", "--wo", "0,0,1"],
        &["eval", text(&csv), "--wi", "0,0,1", "--wo", "0,0,1", "--channel", "none"],
        &["info", text(&ddr), "--json"],
    ] {
        let (_, printed, message) = run(args);
        // JSON may contain those above the first 32 unescaped.
        let is_json = args.contains(&"--json");
        let is_control = |c: char| c.is_control() && !matches!(c, '\n' | '\t') && (c < ' ' || !is_json);
        assert!(!format!("{printed}{message}").contains(is_control), "{args:?}: {printed:?} {message:?}");
    }
    assert!(printed(&["info", text(&ddr)]).contains("\\u{1b}]0;pwned\\u{7}"));
}

#[test]
fn no_input_is_overwritten() {
    let files = Files::new();
    let table = files.write("a.ddr", &diffuse([0.5; 3]));
    let (scene, before) = (files.write("scene.toml", SCENE), std::fs::read(&table).expect("a file"));
    let material = SCENE.replace("model = \"lambert\"\nalbedo = 0.5", "file = \"picture.png\"");
    let measured = files.write("measured.toml", &material);
    std::fs::copy(&table, files.path("picture.png")).expect("a copy");
    for args in [
        &["convert", text(&table), text(&table)][..],
        &["resample", text(&table), text(&table), "--error", "0.1"],
        &["resample", text(&table), text(&files.path("b.ddr")), "--fill", "zeros", "--mask", text(&table)],
        &[
            "resample",
            text(&table),
            text(&files.path("b.ddr")),
            "--fill",
            "zeros",
            "--mask",
            text(&files.path("b.ddr")),
        ],
        &["render", text(&measured), "-o", text(&files.path("picture.png")), "--samples", "1"],
        &["merge", text(&files.path("picture.png")), "-o", text(&files.path("picture.png"))],
        &["preview", text(&files.path("picture.png")), "-o", text(&files.path("picture.png"))],
        &["plot", text(&files.path("picture.png")), "-o", text(&files.path("picture.png"))],
    ] {
        let (code, _, message) = run(args);
        assert!(code == 1 && message.contains("expected another file to write"), "{args:?}: {message}");
    }
    assert_eq!(std::fs::read(&table).expect("a file"), before);
    assert_eq!(std::fs::read(files.path("picture.png")).expect("a file"), before);
    assert_eq!(std::fs::read_to_string(scene).expect("a file"), SCENE);
}

#[test]
fn outputs_are_tested_before_the_work_begins() {
    let files = Files::new();
    let table = files.write("a.ddr", &diffuse([0.5; 3]));
    let scene = files.write("scene.toml", &SCENE.replace("samples = 4", "samples = 4000000"));
    std::fs::create_dir(files.path("folder.ddr")).expect("a folder");
    std::fs::create_dir(files.path("folder.png")).expect("a folder");
    let nowhere = |name: &str| files.path("nowhere").join(name);
    let begun = Instant::now();
    for args in [
        &["render", text(&scene), "-o", text(&nowhere("a.exr"))][..],
        &["render", text(&scene), "-o", text(&files.path("folder.png"))],
        &["preview", text(&table), "-o", text(&nowhere("a.png")), "--samples", "60000", "--time", "1h"],
        &["convert", text(&table), text(&nowhere("a.binary")), "--to", "merl"],
        &["convert", text(&table), text(&files.path("folder.ddr"))],
        &["generate", "cloth", text(&nowhere("a.ddr")), "--paths", "4000000"],
        &["resample", text(&table), text(&nowhere("a.ddr")), "--error", "0.001"],
        &["plot", text(&table), "-o", text(&nowhere("a.html"))],
    ] {
        let (code, _, message) = run(args);
        assert!(code == 1 && message.contains("expected a file that can be written"), "{args:?}: {message}");
    }
    assert!(begun.elapsed() < Duration::from_secs(60));
}

/// A full device, and a pipe that nobody reads.
#[cfg(target_os = "linux")]
#[test]
fn a_full_output_causes_no_panic() {
    let files = Files::new();
    files.write("a.ddr", &diffuse([0.5; 3]));
    files.write("scene.toml", SCENE);
    files.write("pairs.csv", &"0,0,1,0,0,1\n".repeat(1000));
    for command in [
        "info a.ddr",
        "check a.ddr",
        "albedo a.ddr --sigma 0,30",
        "compare a.ddr a.ddr --pairs 100",
        "eval a.ddr --pairs pairs.csv",
        "eval a.ddr --pairs pairs.csv --json",
        "render scene.toml -o a.exr",
        "render scene.toml -o a.exr --json",
        "convert a.ddr b.ssdd",
        "resample a.ddr b.ddr",
        "completions bash",
        "man",
    ] {
        let (code, _, message) = shell(&files, &format!("\"$LOBE\" {command} > /dev/full"));
        let is_silent = command.starts_with("convert");
        assert_eq!(code, if is_silent { 0 } else { 1 }, "{command}: {message}");
        assert_eq!(message.contains("No space left"), !is_silent, "{command}: {message}");
        let (code, _, message) = shell(&files, &format!("\"$LOBE\" {command} 2>&1 | true"));
        assert!(code == 0 && !message.contains("panicked"), "{command}: {message}");
        let (_, _, message) = shell(&files, &format!("\"$LOBE\" {command} >&- 2>&-; echo $? >&2"));
        assert!(!message.contains("101"), "{command}: {message}");
        let (code, ..) = shell(&files, &format!("\"$LOBE\" {command} 2> /dev/full > /dev/null"));
        assert_eq!(code, 0, "{command}");
    }
    assert_eq!(shell(&files, "\"$LOBE\" info none.ddr 2> /dev/full").0, 1);
}

#[cfg(target_os = "linux")]
#[test]
fn devices_and_pipes_are_not_read() {
    let files = Files::new();
    files.write("a.ddr", &diffuse([0.5; 3]));
    let (code, ..) = shell(&files, "mkfifo pipe.csv pipe.exr");
    assert_eq!(code, 0);
    for input in ["/dev/zero", "pipe.csv"] {
        files.write("m.toml", &SCENE.replace("model = \"lambert\"\nalbedo = 0.5", &format!("file = \"{input}\"")));
        files.write("o.toml", &SCENE.replace("shape = \"sphere\"", &format!("file = \"{input}\"")));
        files.write("e.toml", &SCENE.replace("radiance = 1", &format!("file = \"{input}\"")));
        for command in [
            format!("info {input}"),
            format!("check {input}"),
            format!("convert {input} b.ddr"),
            format!("preview {input} -o b.png"),
            format!("compare a.ddr {input}"),
            format!("render {input} -o b.png"),
            format!("merge {input} -o b.png"),
            "render m.toml -o b.png".into(),
            "render o.toml -o b.png".into(),
            "render e.toml -o b.png".into(),
        ] {
            let (code, printed, message) = shell(&files, &format!("timeout 20 \"$LOBE\" {command}"));
            let refused = format!("{printed}{message}").contains("a device, a pipe or a socket; expected a file");
            assert!(code == 1 && refused, "{command}: {code} {printed} {message}");
        }
    }
    let (code, _, message) = shell(&files, "timeout 20 \"$LOBE\" eval a.ddr --pairs /dev/zero");
    assert!(code == 1 && message.contains("a device, a pipe or a socket"), "{message}");
    let (code, _, message) = shell(&files, "timeout 20 \"$LOBE\" eval a.ddr --pairs - < /dev/zero");
    assert!(code == 1 && message.contains("a line of 65536 bytes or more"), "{message}");
    for command in ["convert a.ddr pipe.csv --to csv", "render m.toml -o pipe.exr", "convert a.ddr /dev/null --to csv"]
    {
        let (code, _, message) = shell(&files, &format!("timeout 20 \"$LOBE\" {command}"));
        assert!(
            code == 1 && message.contains("a device, a pipe or a socket; expected a file that"),
            "{command}: {message}"
        );
    }
    assert!(!std::fs::metadata("/dev/null").expect("a device").is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn fewer_threads_are_used_if_the_system_refuses_more() {
    let files = Files::new();
    files.write("scene.toml", SCENE);
    let (code, ..) = shell(&files, "\"$LOBE\" render scene.toml -o all.exr --strict");
    assert_eq!(code, 0);
    let (code, _, message) =
        shell(&files, "ulimit -v 2000000; \"$LOBE\" render scene.toml -o few.exr --strict --threads 1024");
    assert_eq!(code, 0, "{message}");
    assert_eq!(
        std::fs::read(files.path("few.exr")).expect("a picture"),
        std::fs::read(files.path("all.exr")).expect("a picture")
    );
}

#[test]
fn pairs_are_answered_as_they_arrive() {
    let files = Files::new();
    let table = files.write("a.ddr", &diffuse([0.5; 3]));
    let mut child = Command::new(env!("CARGO_BIN_EXE_lobe"))
        .args(["eval", text(&table), "--pairs", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program");
    let (mut input, mut output) =
        (child.stdin.take().expect("a pipe"), BufReader::new(child.stdout.take().expect("a pipe")));
    // Each answer arrives before the next pair is sent; if answers were buffered, this would wait forever.
    for _ in 0..3 {
        input.write_all(b"0,0,1,0,0,1\n").expect("a reader");
        let mut line = String::new();
        output.read_line(&mut line).expect("an answer");
        assert!((line.trim().parse::<f64>().expect("a number") - 0.5 / std::f64::consts::PI).abs() < 1e-6, "{line}");
    }
    drop(input);
    assert!(child.wait().expect("an end").success());
}

#[test]
fn pairs_by_name_and_with_semicolons() {
    let files = Files::new();
    let wi = "theta_i,theta_o,phi_o,f\n0,0,0,1\n0,60,0,2\n0,60,180,2\n60,0,0,5\n60,60,0,5\n60,60,180,5\n";
    let table = files.write("a.csv", wi);
    let eval = |pairs: &str| printed(&["eval", text(&table), "--pairs", text(&files.write("pairs.csv", pairs))]);
    let expected = eval("0.5,0,0.8660254,0,0,1\n");
    assert!(expected.trim().parse::<f64>().expect("a number") > 2.0);
    assert_eq!(eval("wo.x,wo.y,wo.z,wi.x,wi.y,wi.z\n0,0,1,0.5,0,0.8660254\n"), expected);
    assert_eq!(eval("0.5;0;0.8660254;0;0;1\n"), expected);
    assert_eq!(eval("\u{feff}0.5,0,0.8660254,0,0,1\n"), expected);
    let (code, printed, message) =
        run(&["eval", text(&table), "--pairs", text(&files.write("none.csv", "# nothing\n"))]);
    assert!((code, printed.as_str()) == (0, "") && message.contains("found no pairs"), "{message}");
}

#[test]
fn angles_out_of_range_and_options_without_effect_are_refused() {
    let files = Files::new();
    let table = files.write("a.ddr", &diffuse([0.5; 3]));
    let grid = files.write("a.csv", "theta_i,theta_o,phi_o,f\n30,0,0,1\n30,60,0,2\n30,60,180,3\n");
    for (args, expected) in [
        (&["eval", text(&table), "--angles", "100,0,0,0"][..], "found sigma 100; expected 0 to 90"),
        (&["eval", text(&table), "--angles=-1,0,0,0"], "found sigma -1"),
        (&["eval", text(&table), "--angles", "0,0,181,0"], "found theta 181; expected 0 to 180"),
        (&["eval", text(&table), "--angles", "0,0,0,0", "--lookup", "linear"], "--lookup: found specular table"),
        (
            &["eval", text(&table), "--angles", "0,0,0,0", "--indexed-by", "viewer"],
            "--indexed-by: found specular table",
        ),
        (&["eval", text(&grid), "--angles", "0,0,0,0", "--edge", "zero"], "--edge: found scattered samples"),
    ] {
        let (code, _, message) = run(args);
        assert!(code == 2 && message.contains(expected), "{args:?}: {message}");
    }
    printed(&["eval", text(&table), "--angles", "90,360,180,-30", "--edge", "zero"]);
}

#[test]
fn every_help_lists_the_exit_codes() {
    let top = printed(&["--help"]);
    let commands =
        top.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1).take_while(|line| !line.is_empty());
    let names: Vec<&str> = commands
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(names.len() > 12, "{names:?}");
    for name in names.iter().filter(|name| **name != "help") {
        assert!(printed(&[name, "--help"]).contains("Exit codes: 0 done"), "{name}");
    }
    assert!(printed(&["generate", "ggx", "--help"]).contains("Exit codes: 0 done"));
}

#[test]
fn leftovers_of_a_killed_program_are_cleaned_up() {
    let files = Files::new();
    let table = files.write("a.ddr", &diffuse([0.5; 3]));
    files.write(".lobe-x1y2z3.tmp", "half of a file");
    printed(&["convert", text(&table), text(&files.path("b.ssdd"))]);
    assert_eq!(files.path(".lobe-x1y2z3.tmp").exists(), !cfg!(unix));
    assert!(lobe(&["info", text(&files.path("b.ssdd"))]).status.success());
}

#[test]
fn a_dash_is_standard_input() {
    let files = Files::new();
    let table = diffuse([0.5; 3]);
    let path = files.write("a.ddr", &table);
    let fed = |args: &[&str], input: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lobe"));
        let child = command.args(args).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let mut child = child.expect("the program");
        // A program that does not read its input closes the pipe.
        let _ = child.stdin.take().expect("a pipe").write_all(input.as_bytes());
        let output = child.wait_with_output().expect("an end");
        let utf8 = |bytes| String::from_utf8(bytes).expect("UTF-8");
        (output.status.code(), utf8(output.stdout), utf8(output.stderr))
    };
    let out = |name: &str| files.path(name).to_str().expect("UTF-8").to_owned();
    for args in [
        &["info", "-"][..],
        &["check", "-"],
        &["albedo", "-", "--sigma", "30"],
        &["eval", "-", "--angles", "0,0,0,0"],
        &["compare", "-", text(&path), "--within", "0", "--pairs", "100"],
        &["compare", "-", "-", "--within", "0", "--pairs", "100"],
        &["convert", "-", &out("b.ssdd")],
        &["resample", "-", &out("b.ddr")],
        &["plot", "-", "-o", &out("b.svg")],
        &["plot", "-", "-o", &out("b.html")],
        &["preview", "-", "-o", &out("b.png"), "--size", "32x24", "--samples", "1"],
    ] {
        let (code, _, message) = fed(args, &table);
        assert_eq!(code, Some(0), "{args:?}: {message}");
    }
    let (code, _, message) = fed(&["render", "-", "-o", &out("c.png")], SCENE);
    assert_eq!(code, Some(0), "{message}");
    let (code, _, message) = fed(&["info", "-"], "nothing");
    assert!(code == Some(1) && message.starts_with("error: -: found "), "{message}");
    let (code, _, message) = fed(&["convert", text(&path), "-", "--to", "csv"], "");
    assert!(code == Some(1) && message.contains("expected the name of a file to write"), "{message}");
}
