//! Checks that a command could be run: everything that it names exists.

use std::path::Path;

/// Looks up the names in a command. Capitals such as FILE stand for anything.
pub fn look_up(root: &Path, help: &[(String, String)], command: &str) -> Result<(), String> {
    for line in command.lines() {
        let line = line.split(" # ").next().unwrap_or_default().split("  #").next().unwrap_or_default();
        for part in line.split([';', '|']).flat_map(|part| part.split("&&")) {
            let words: Vec<&str> = part.split_whitespace().skip_while(is_prefix).collect();
            let found = match words.as_slice() {
                ["lobe", rest @ ..] => of_program(help, rest),
                ["cargo", rest @ ..] => of_cargo(root, rest),
                _ => Ok(()),
            };
            found.map_err(|error| format!("{command}\n{error}"))?;
        }
    }
    Ok(())
}

/// Words that may precede a program.
fn is_prefix(word: &&str) -> bool {
    let is_assignment =
        word.split_once('=').is_some_and(|(name, _)| name.chars().all(|c| c.is_ascii_uppercase() || c == '_'));
    is_assignment || ["/usr/bin/time", "time", "taskset", "-c", "1", "do", "$(cargo"].contains(word)
}

fn stands_for_anything(word: &str) -> bool {
    word.chars().all(|c| c.is_ascii_uppercase() || c == '_')
}

/// A command of the program, and its options.
fn of_program(help: &[(String, String)], words: &[&str]) -> Result<(), String> {
    let mut command = String::from("lobe");
    for word in words.iter().take_while(|word| !word.starts_with('-')) {
        let longer = format!("{command} {word}");
        match help.iter().any(|(name, _)| *name == longer) {
            true => command = longer,
            false => break,
        }
    }
    let first = words.first().filter(|word| !word.starts_with('-') && !stands_for_anything(word));
    if let (Some(first), true) = (first, command == "lobe") {
        return Err(format!("found the command {first}; expected one that `lobe --help` lists"));
    }
    let text = help.iter().find(|(name, _)| *name == command).map_or("", |(_, text)| text.as_str());
    for option in words.iter().filter(|word| word.starts_with("--") && word.len() > 2) {
        let option = option.split('=').next().unwrap_or_default();
        let is_there = |line: &str| line.trim_start().split([' ', ',', '=']).any(|word| word == option);
        if !text.lines().any(is_there) {
            return Err(format!("found the option {option}; expected one that `{command} --help` lists"));
        }
    }
    Ok(())
}

/// A command of cargo: packages, tests, benchmarks, examples, commands of the workspace, and folders.
fn of_cargo(root: &Path, words: &[&str]) -> Result<(), String> {
    let own = words.split(|word| *word == "--").next().unwrap_or_default();
    let value = |names: [&str; 2]| {
        let at = own.iter().position(|word| names.contains(word))?;
        own.get(at + 1).copied().filter(|word| !stands_for_anything(word))
    };
    let package = value(["-p", "--package"]);
    let folder = package.map(|package| folder(root, package)).transpose()?;
    let exists = |what: &str, path: String| match root.join(&path).exists() {
        true => Ok(()),
        false => Err(format!("found the {what} {path}; expected one that exists")),
    };
    let under = folder.clone().unwrap_or_else(|| "crates/lobe".into());
    if let Some(test) = value(["--test", "--test"]) {
        let path = format!("{under}/tests/{test}");
        exists("test", if root.join(&path).is_dir() { format!("{path}/main.rs") } else { format!("{path}.rs") })?;
    }
    if let Some(bench) = value(["--bench", "--bench"]) {
        exists("benchmark", format!("{under}/benches/{bench}.rs"))?;
    }
    if let Some(path) = value(["--path", "--path"]) {
        exists("folder", path.into())?;
    }
    if let ["xtask", task, ..] = words {
        let [package, module] = [task.to_string(), format!("src/{task}.rs")].map(|path| root.join("xtask").join(path));
        let is_there = package.is_dir() || module.is_file();
        let is_any = stands_for_anything(task);
        if !is_there && !is_any {
            return Err(format!("found `cargo xtask {task}`; expected a package or a module of xtask"));
        }
    }
    Ok(())
}

/// The folder of a package of the workspace.
fn folder(root: &Path, package: &str) -> Result<String, String> {
    let short = package.strip_prefix("xtask-").unwrap_or(package);
    let folders = [format!("crates/{package}"), format!("xtask/{short}"), "benches".into(), "fuzz".into()];
    let name = format!("name = \"{package}\"");
    let is_it = |folder: &String| {
        let manifest = std::fs::read_to_string(root.join(folder).join("Cargo.toml")).unwrap_or_default();
        manifest.lines().any(|line| line == name)
    };
    folders.into_iter().find(is_it).ok_or_else(|| format!("found the package {package}; expected one of the workspace"))
}

#[test]
fn errors_name_whatever_is_missing() {
    let root = super::root();
    let help = [
        ("lobe".to_string(), "Commands:\n  info  ...".to_string()),
        ("lobe info".to_string(), "Options:\n      --json  Print JSON".to_string()),
    ];
    for good in [
        "lobe info FILE",
        "lobe info a --json",
        "lobe COMMAND --help",
        "cargo test -p lobe-cli --test suite",
        "cargo xtask report --only x",
    ] {
        let good = good.replace(" --help", "");
        assert_eq!(look_up(root, &help, &good), Ok(()), "{good}");
    }
    for (bad, expected) in [
        ("lobe infos FILE", "command infos"),
        ("lobe info --jason", "option --jason"),
        ("cargo test -p lobe-clip", "package lobe-clip"),
        ("cargo test -p lobe-cli --test suites", "tests/suites.rs"),
        ("FOO=1 cargo xtask reports", "cargo xtask reports"),
        ("true && cargo bench -p lobe-benches --bench isos", "isos.rs"),
    ] {
        let found = look_up(root, &help, bad).expect_err(bad);
        assert!(found.contains(expected), "{bad}: {found}");
    }
}
