//! A job template in the Open Job Description format, for its tools and for Deadline Cloud.

use std::path::{Path, PathBuf};

use lobe_files::{check_folder, check_output, write_whole};
use serde_json::{Value, json};

use super::files::{begin, path, quoted};
use super::plan::{By, Plan, Planned, Wanted, absolute};
use crate::failure::Failure;
use crate::message::say;

/// Write an Open Job Description template: a step with one task per part, and a step that merges the parts.
///
/// The template has parameters for the folder of the scene, which is sent to the machines, the folder for the parts and
/// the picture, which is sent back, and the path of the program. Finished parts are kept, and interrupted ones
/// continue.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe farm openjd scene.toml -o job --parts 8
  lobe farm openjd scene.toml -o job --parts 8 --picture look.png --strict

The command prints how to render the job here with openjd-cli; `deadline bundle submit job` submits it to Deadline Cloud.")]
pub struct Args {
    #[command(flatten)]
    wanted: Wanted,
    /// The folder to write the template to; the picture will be there too.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The name of the picture, .exr or .png.
    #[arg(long, value_name = "NAME", default_value = "picture.exr", value_parser = name)]
    picture: String,
}

fn name(text: &str) -> Result<String, String> {
    let is_name = Path::new(text).file_name().is_some_and(|name| name == text) && !text.contains(['{', '}']);
    let is_picture = [".exr", ".png"].iter().any(|end| text.to_lowercase().ends_with(end));
    match is_name && is_picture {
        true => Ok(text.into()),
        false => Err("expected a name that ends in .exr or .png, without a folder".into()),
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    check_folder(&args.output)?;
    let planned = args.wanted.plan()?;
    let folder = absolute(&args.output)?;
    begin(&folder, &planned.plan)?;
    check_output(&folder.join(&args.picture), &planned.files)?;
    let template = template(&planned, &args.picture)?;
    let file = folder.join("template.json");
    write_whole(&file, serde_json::to_string_pretty(&template)?.as_bytes())?;
    // Default folders must be inside the folder of the template, but values need not be; Deadline Cloud finds them
    // here.
    let root = text(&root(&planned.files))?;
    let values = json!({ "parameterValues": [{ "name": "SceneFolder", "value": root }] });
    write_whole(&folder.join("parameter_values.json"), serde_json::to_string_pretty(&values)?.as_bytes())?;
    let [template, value] = [path(&file)?, quoted(&format!("SceneFolder={root}"))];
    say(format_args!(
        "{}: {} parts; render it here with: openjd run {template} -p {value} --step Merge --run-dependencies",
        file.display(),
        planned.plan.parts
    ));
    Ok(())
}

/// The folder that contains all files of a scene.
fn root(files: &[PathBuf]) -> PathBuf {
    let folder = |file: &Path| file.parent().map_or_else(PathBuf::new, plain);
    let mut folders = files.iter().map(|file| folder(file));
    let mut root = folders.next().unwrap_or_default();
    for folder in folders {
        while !folder.starts_with(&root) {
            root.pop();
        }
    }
    root
}

/// A path without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            std::path::Component::ParentDir => drop(plain.pop()),
            std::path::Component::CurDir => {}
            other => plain.push(other),
        }
    }
    plain
}

/// Text that a template takes literally.
fn text(path: &Path) -> Result<String, Failure> {
    let text = path.to_str().filter(|text| !text.contains("{{"));
    text.map(String::from).ok_or_else(|| {
        let message = "found a path that a template cannot name; expected Unicode without {{";
        Failure::Usage(format!("{}: {message}", path.display()))
    })
}

fn template(planned: &Planned, picture: &str) -> Result<Value, Failure> {
    let Planned { plan, scene, files, lobe, options } = planned;
    let root = root(files);
    let scene = plain(scene);
    let inside = text(scene.strip_prefix(&root).unwrap_or(&scene))?;
    let name: String = text(scene.file_stem().unwrap_or_default().as_ref())?.chars().take(100).collect();
    let part = |number: &str| format!("{{{{Param.OutputFolder}}}}/part-{number}.exr");
    let mut render = vec![
        "render".to_string(),
        format!("{{{{Param.SceneFolder}}}}/{inside}"),
        "-o".into(),
        part("{{Task.Param.Part}}"),
    ];
    let mut parameters = vec![json!({ "name": "Part", "type": "INT", "range": format!("1-{}", plan.parts) })];
    let mut space = json!({});
    match plan.by {
        By::Rows => render.extend(["--tile".into(), format!("{{{{Task.Param.Part}}}}/{}", plan.parts)]),
        By::Samples => {
            let ranges: Vec<String> = (1..=plan.parts).map(|part| plan.option(part)[1].clone()).collect();
            render.extend(["--samples-range".into(), "{{Task.Param.Samples}}".into()]);
            parameters.push(json!({ "name": "Samples", "type": "STRING", "range": ranges }));
            space["combination"] = json!("(Part, Samples)");
        }
    }
    space["taskParameterDefinitions"] = json!(parameters);
    render.extend(options.iter().cloned());
    render.extend(["--resume", "--quiet"].map(String::from));
    let step = |name: &str, arguments: Vec<String>| {
        json!({
            "name": name,
            "script": { "actions": { "onRun": { "command": "{{Param.Lobe}}", "args": arguments } } },
        })
    };
    let mut first = step("Render", render);
    first["parameterSpace"] = space;
    let mut merge = step("Merge", merge_arguments(plan, picture, part));
    merge["dependencies"] = json!([{ "dependsOn": "Render" }]);
    Ok(json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": name,
        "parameterDefinitions": [
            {
                "name": "SceneFolder", "type": "PATH", "objectType": "DIRECTORY", "dataFlow": "IN",
                "description": "The folder that contains all files of the scene",
            },
            {
                "name": "OutputFolder", "type": "PATH", "objectType": "DIRECTORY", "dataFlow": "OUT",
                "default": ".", "description": "The folder for the parts and the picture",
            },
            {
                "name": "Lobe", "type": "STRING", "default": text(lobe)?,
                "description": "The program lobe on the machines that render",
            },
        ],
        "steps": [first, merge],
    }))
}

fn merge_arguments(plan: &Plan, picture: &str, part: impl Fn(&str) -> String) -> Vec<String> {
    let parts = (1..=plan.parts).map(|number| part(&number.to_string()));
    let output = ["-o".into(), format!("{{{{Param.OutputFolder}}}}/{picture}")];
    ["merge".into()].into_iter().chain(parts).chain(output).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_contains_all_files() {
        let root = |files: &[&str]| root(&files.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(root(&["/a/b/scene.toml"]), Path::new("/a/b"));
        assert_eq!(root(&["/a/b/scene.toml", "/a/b/../c/x.ddr", "/a/b/c/d/y.ddr"]), Path::new("/a"));
        assert_eq!(root(&["/a/b/scene.toml", "/a/bc/x.ddr"]), Path::new("/a"));
    }
}
