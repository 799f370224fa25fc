//! Runs every command in the documents and help texts as written.
//!
//! - In a block marked `sh`, every line is run by the shell, in a scratch folder with the fixtures. The lines of a
//!   document are run one after the other, so a command may use the output of an earlier one.
//! - A block marked `sh slow` takes minutes, or changes the machine: it is run if `LOBE_SLOW_COMMANDS` is set.
//!   Otherwise, only the names of commands, options, packages, tests and files in it are looked up.
//! - Commands inside a sentence are looked up in the same way.
//! - The examples of a help text are run with the files that they name, which [`scratch`] creates.
//!
//! `LOBE_DRAFT` makes renderings small.

mod commands;
mod names;
mod scratch;

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::thread;

use commands::{Block, blocks, examples, spans, subcommands};
use rayon::prelude::*;
use scratch::Scratch;

/// The documents with commands.
const DOCUMENTS: [&str; 16] = [
    "README.md",
    "CONTRIBUTING.md",
    "docs/accuracy.md",
    "docs/architecture.md",
    "docs/backends.md",
    "docs/benchmarking.md",
    "docs/building.md",
    "docs/c.md",
    "docs/explorer.md",
    "docs/farm.md",
    "docs/fuzzing.md",
    "docs/gallery.md",
    "docs/operations.md",
    "docs/python.md",
    "docs/scenes.md",
    "docs/your-own-measurement.md",
];

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

fn read(document: &str) -> String {
    std::fs::read_to_string(root().join(document)).expect("a document")
}

fn runs_slow_commands() -> bool {
    std::env::var_os("LOBE_SLOW_COMMANDS").is_some()
}

/// The help texts, each with its command; that of the program comes first.
fn help_texts() -> &'static [(String, String)] {
    static TEXTS: OnceLock<Vec<(String, String)>> = OnceLock::new();
    TEXTS.get_or_init(|| {
        let help = |command: &str| {
            let output = Command::new(env!("CARGO_BIN_EXE_lobe"))
                .args(command.split(' ').skip(1))
                .arg("--help")
                .stdin(Stdio::null())
                .output()
                .expect("the program");
            assert!(output.status.success(), "{command} --help");
            String::from_utf8(output.stdout).expect("UTF-8")
        };
        let mut texts = vec![("lobe".to_string(), help("lobe"))];
        let mut at = 0;
        while let Some((command, text)) = texts.get(at).cloned() {
            texts.extend(subcommands(&text).into_iter().map(|name| {
                let command = format!("{command} {name}");
                let text = help(&command);
                (command, text)
            }));
            at += 1;
        }
        texts
    })
}

/// Runs a line in the shell; the error says what went wrong.
fn run(scratch: &Scratch, line: &str) -> Result<(), String> {
    // It would open a browser, and wait for Ctrl-C.
    let ended = match line.split(" #").next() {
        Some(view) if view.starts_with("lobe view") && view.contains("--no-open") => format!("{view} --for 100ms"),
        Some(view) if view.starts_with("lobe view") => format!("{view} --no-open --for 100ms"),
        _ => line.into(),
    };
    let output = scratch.shell(&ended).output().expect("a shell");
    // The status of a pipe is that of its last program.
    let has_failed = text(&output.stderr).lines().any(|line| line.starts_with("error: "));
    // An imported file is checked, and may fail as long as the quantity of its values is not given.
    let is_unsound = line.starts_with("lobe import") && output.status.code() == Some(3);
    match is_unsound || output.status.success() && !has_failed {
        true => Ok(()),
        false => Err(format!("{line}\n{}{}", text(&output.stdout), text(&output.stderr))),
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn every_command_of_the_documents_runs() {
    let run_document = |document: &'static str| {
        let scratch = Scratch::new();
        scratch.fixtures();
        if document == "docs/scenes.md" {
            scratch.scene(&read(document));
        }
        let mut failures = Vec::new();
        for Block { lines, is_slow } in blocks(&read(document)) {
            for line in lines {
                let done = match is_slow && !runs_slow_commands() {
                    true => names::look_up(root(), help_texts(), &line),
                    false => run(&scratch, &line),
                };
                failures.extend(done.err().map(|error| format!("{document}: {error}")));
            }
        }
        failures
    };
    let failures: Vec<String> = thread::scope(|scope| {
        let threads: Vec<_> =
            DOCUMENTS.into_iter().map(|document| scope.spawn(move || run_document(document))).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("a document")).collect()
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn commands_in_sentences_name_existing_things() {
    let mut looked_up = 0;
    let mut failures = Vec::new();
    for document in DOCUMENTS.into_iter().chain(["docs/formats.md", "docs/dependencies.md", "docs/glossary.md"]) {
        for span in spans(&read(document)) {
            looked_up += 1;
            let found = names::look_up(root(), help_texts(), &span);
            failures.extend(found.err().map(|error| format!("{document}: {error}")));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(looked_up > 50, "{looked_up} commands");
}

#[test]
fn every_example_of_a_help_text_runs() {
    let scratch = Scratch::new();
    scratch.examples();
    let all: Vec<(&String, String)> = help_texts()
        .iter()
        .flat_map(|(command, text)| examples(text).into_iter().map(move |example| (command, example)))
        .collect();
    let run_example = |(command, example): &(&String, String)| {
        // The output of one example is not an input of another.
        let own = scratch.copy();
        own.without_output(example);
        run(&own, example).err().map(|error| format!("{command} --help: {error}"))
    };
    let failures: Vec<String> = all.par_iter().filter_map(run_example).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(all.len() > 40, "{} examples", all.len());
}

#[test]
fn every_command_has_examples() {
    for (command, text) in help_texts() {
        let is_group = !subcommands(text).is_empty();
        assert!(is_group || !examples(text).is_empty() || command.ends_with(" help"), "{command}");
    }
}
