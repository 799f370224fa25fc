//! `lobe farm`: its scripts and templates, on schedulers imitated by the shell and by this test.

use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::common::{Files, json, printed, run, text};
use crate::hardening::SCENE;

/// Writes a program into a folder of programs.
fn program(folder: &Path, name: &str, script: &str) {
    let path = folder.join(name);
    std::fs::write(&path, format!("#!/bin/sh\n{script}\n")).expect("a file");
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("a program");
}

/// Runs each task of an array at once, in the order of their numbers, and records the requests in `asked`.
const SBATCH: &str = r#"
echo "$@" >> "$FAKE/asked"
for script; do :; done
tasks=$(sed -n 's/^#SBATCH --array=1-//p' "$script")
job=$(( $(cat "$FAKE/job" 2>/dev/null || echo 40) + 1 ))
echo $job > "$FAKE/job"
if [ -n "$tasks" ]; then
    task=0
    while [ $task -lt $tasks ]; do
        task=$((task + 1))
        tries=0
        until SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_JOB_ID=$job SLURM_RESTART_COUNT=$tries sh "$script" >> "$FAKE/log" 2>&1; do
            grep -q "^requeue ${job}_$task $tries" "$FAKE/scontrol" 2>/dev/null || break
            tries=$((tries + 1))
        done
    done
else
    sh "$script" >> "$FAKE/log" 2>&1 || exit 1
fi
echo "$job;cluster"
"#;

fn submitted(files: &Files, job: &Path) -> bool {
    let bin = files.path("bin");
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap_or_default());
    let mut command = Command::new("sh");
    command.arg(job.join("submit.sh")).arg("--partition=long").env("PATH", path).env("FAKE", files.path(""));
    command.env_remove("SLURM_CPUS_PER_TASK").output().expect("a shell").status.success()
}

fn engine(files: &Files) {
    let bin = files.path("bin");
    std::fs::create_dir(&bin).expect("a folder");
    program(&bin, "sbatch", SBATCH);
    program(&bin, "scontrol", r#"echo "$@ $SLURM_RESTART_COUNT" >> "$FAKE/scontrol""#);
    program(&bin, "sleep", ":");
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn an_array_of_parts_is_the_picture() {
    let files = Files::new();
    engine(&files);
    // A name that a shell must not split.
    let scene = files.write("a scene's.toml", SCENE);
    let whole = files.path("whole.exr");
    printed(&["render", text(&scene), "-o", text(&whole), "--quiet"]);
    for by in ["rows", "samples"] {
        let out = files.path(&format!("the {by}.exr"));
        printed(&["farm", "slurm", text(&scene), "-o", text(&out), "--parts", "3", "--by", by]);
        let job = files.path(&format!("the {by}.exr.farm"));
        assert_eq!(json(&["farm", "status", text(&job)])["finished"], 0);
        assert!(submitted(&files, &job), "{}", String::from_utf8_lossy(&bytes(&files.path("log"))));
        assert!(bytes(&out) == bytes(&whole), "{by}");
        let status = json(&["farm", "status", text(&job)]);
        assert_eq!((&status["finished"], &status["share"]), (&3.into(), &1.0.into()));
        assert!(printed(&["farm", "status", text(&job)]).starts_with("3 of 3 parts finished, 0 begun, 100.0 %"));
    }
    let asked = String::from_utf8(bytes(&files.path("asked"))).expect("text");
    let lines: Vec<&str> = asked.lines().collect();
    assert!(lines[0].starts_with("--parsable --partition=long ") && lines[0].ends_with("part.sh"), "{asked}");
    assert!(lines[1].starts_with("--parsable --dependency=afterok:41 --kill-on-invalid-dep=yes "), "{asked}");
}

#[test]
fn finished_parts_are_kept_and_others_rendered_again() {
    let files = Files::new();
    engine(&files);
    let scene = files.write("scene.toml", SCENE);
    let out = files.path("picture.png");
    let farm = ["farm", "slurm", text(&scene), "-o", text(&out), "--parts", "4"];
    printed(&farm);
    let job = files.path("picture.png.farm");
    assert!(submitted(&files, &job));
    let first = bytes(&out);
    std::fs::remove_file(job.join("part-2.exr")).expect("a part");
    std::fs::remove_file(&out).expect("a picture");
    printed(&farm);
    assert_eq!(json(&["farm", "status", text(&job)])["finished"], 3);
    assert!(submitted(&files, &job));
    assert!(bytes(&out) == first);
    // Parts of a picture that is divided differently are not parts of this one.
    let (code, _, message) = run(&["farm", "slurm", text(&scene), "-o", text(&out), "--parts", "5"]);
    assert!(code == 2 && message.contains("found a job of 4 parts"), "{message}");
    std::fs::write(job.join("part-3.exr"), "no picture").expect("a file");
    let (code, printed, message) = run(&["farm", "status", text(&job)]);
    assert!(code == 1 && printed.contains("part-3.exr"), "{printed}{message}");
}

#[test]
fn a_part_that_fails_is_requeued_three_times() {
    let files = Files::new();
    engine(&files);
    let scene = files.write("scene.toml", SCENE);
    let out = files.path("picture.exr");
    let bin = files.path("bin");
    // A machine without memory, say.
    program(&bin, "broken", r#"echo no >> "$FAKE/broken"; exit 1"#);
    let broken = bin.join("broken");
    let farm = ["farm", "slurm", text(&scene), "-o", text(&out), "--parts", "1", "--lobe", text(&broken)];
    printed(&farm);
    let job = files.path("picture.exr.farm");
    assert!(!submitted(&files, &job));
    // Once, three more times, and once for the merge.
    assert_eq!(bytes(&files.path("broken")).len(), 3 * 5);
    // An invalid scene is invalid on every machine.
    program(&bin, "broken", r#"echo no >> "$FAKE/usage"; exit 2"#);
    std::fs::remove_file(files.path("scontrol")).expect("what was requeued");
    assert!(!submitted(&files, &job));
    assert_eq!(bytes(&files.path("usage")).len(), 3 * 2);
}

/// Replaces text in double braces.
fn filled(text: &str, values: &[(&str, &str)]) -> String {
    let filled =
        values.iter().fold(text.to_string(), |text, (name, value)| text.replace(&format!("{{{{{name}}}}}"), value));
    assert!(!filled.contains("{{"), "{filled}");
    filled
}

#[test]
fn a_job_template_makes_the_picture() {
    let files = Files::new();
    let scene = files.write("scene.toml", SCENE);
    let (job, whole) = (files.path("job"), files.path("whole.exr"));
    printed(&["render", text(&scene), "-o", text(&whole), "--quiet", "--strict"]);
    for by in ["rows", "samples"] {
        let _ = std::fs::remove_dir_all(&job);
        printed(&["farm", "openjd", text(&scene), "-o", text(&job), "--parts", "3", "--by", by, "--strict"]);
        let template: Value = serde_json::from_slice(&bytes(&job.join("template.json"))).expect("JSON");
        let given: Value = serde_json::from_slice(&bytes(&job.join("parameter_values.json"))).expect("JSON");
        assert_eq!(template["specificationVersion"], "jobtemplate-2023-09");
        let parameters = template["parameterDefinitions"].as_array().expect("parameters");
        let values: Vec<(String, String)> = parameters
            .iter()
            .map(|p| {
                let name = p["name"].as_str().expect("a name");
                // The folder of the scene is given; the default of the other one is relative to the template.
                let value = match (&p["default"], p["type"] == "PATH") {
                    (Value::String(default), true) => text(&job.join(default)).to_string(),
                    (Value::String(default), false) => default.clone(),
                    _ => given["parameterValues"][0]["value"].as_str().expect("a value").to_string(),
                };
                (format!("Param.{name}"), value)
            })
            .collect();
        let perform = |step: &Value, task: &[(&str, &str)]| {
            let mut values: Vec<(&str, &str)> =
                values.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
            values.extend(task);
            let action = &step["script"]["actions"]["onRun"];
            let arguments = action["args"].as_array().expect("arguments");
            let arguments = arguments.iter().map(|argument| filled(argument.as_str().expect("text"), &values));
            let status = Command::new(filled(action["command"].as_str().unwrap(), &values)).args(arguments).status();
            assert!(status.expect("the program").success());
        };
        let [render, merge] = template["steps"].as_array().expect("steps").as_slice() else { panic!("two steps") };
        assert_eq!(merge["dependencies"][0]["dependsOn"], render["name"]);
        let definitions = render["parameterSpace"]["taskParameterDefinitions"].as_array().expect("parameters of tasks");
        assert_eq!(definitions[0]["range"], "1-3");
        for part in 1..=3 {
            let number = part.to_string();
            let samples = definitions.get(1).map(|samples| samples["range"][part - 1].as_str().expect("a range"));
            let mut task = vec![("Task.Param.Part", number.as_str())];
            task.extend(samples.map(|samples| ("Task.Param.Samples", samples)));
            perform(render, &task);
        }
        perform(merge, &[]);
        assert!(bytes(&job.join("picture.exr")) == bytes(&whole), "{by}");
    }
}

#[test]
fn impossible_divisions_are_refused() {
    let files = Files::new();
    let scene = files.write("scene.toml", SCENE);
    let (out, job) = (files.path("out.exr"), files.path("job"));
    for (arguments, words) in [
        (
            vec!["slurm", text(&scene), "-o", text(&out), "--parts", "17"],
            "found 17 parts; expected at most 16, the number of rows",
        ),
        (
            vec!["slurm", text(&scene), "-o", text(&out), "--parts", "5", "--by", "samples"],
            "found 5 parts; expected at most 4, the number of samples",
        ),
        (vec!["slurm", text(&scene), "-o", text(&job), "--parts", "2"], ".exr or .png"),
        (vec!["openjd", text(&scene), "-o", text(&job), "--parts", "2", "--picture", "a/b.exr"], "without a folder"),
        (vec!["openjd", text(&scene), "-o", text(&job), "--parts", "0"], "--parts"),
        (vec!["status", text(&job)], "plan.json"),
    ] {
        let (code, _, message) = run(&[&["farm"], arguments.as_slice()].concat());
        assert!(code != 0 && message.contains(words), "{arguments:?}: {message}");
    }
    assert!(!out.exists() && !job.exists());
}

#[test]
fn a_damaged_plan_is_refused_at_once() {
    let files = Files::new();
    std::fs::create_dir(files.path("job")).expect("a folder");
    let status = |plan: &str| {
        files.write("job/plan.json", plan);
        run(&["farm", "status", text(&files.path("job"))])
    };
    let sound = r#"{"parts": 2, "by": "rows", "size": [8, 6], "samples": 4}"#;
    assert_eq!(status(sound).0, 0);
    for (from, to) in [
        ("\"parts\": 2", "\"parts\": 4000000000"),
        ("\"parts\": 2", "\"parts\": 0"),
        ("[8, 6]", "[4294967295, 4294967295]"),
        ("[8, 6]", "[8, 1]"),
        ("\"samples\": 4", "\"samples\": 0"),
        ("rows", "columns"),
        ("}", ""),
    ] {
        let (code, _, message) = status(&sound.replace(from, to));
        assert!(code == 1 && message.contains("expected the plan of a job"), "{to}: {code} {message}");
    }
}

#[test]
fn no_file_of_the_scene_is_the_picture() {
    let files = Files::new();
    let sky = files.path("sky.exr");
    let plain = files.write("plain.toml", SCENE);
    printed(&["render", text(&plain), "-o", text(&sky)]);
    let before = bytes(&sky);
    let scene = files.write("scene.toml", &SCENE.replace("radiance = 1", "file = \"sky.exr\""));
    for farm in [
        &["farm", "slurm", text(&scene), "-o", text(&sky), "--parts", "2"][..],
        &["farm", "openjd", text(&scene), "-o", text(&files.path("")), "--picture", "sky.exr", "--parts", "2"],
    ] {
        let (code, _, message) = run(farm);
        assert!(code == 1 && message.contains("expected another file to write"), "{farm:?}: {message}");
    }
    assert!(bytes(&sky) == before);
}
