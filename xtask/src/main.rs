//! `cargo xtask COMMAND`: the commands of the workspace.
//!
//! Each is a program in its own package, which is built when it is used, so that no command compiles what another
//! needs. This one has no dependencies and starts at once.
#![forbid(unsafe_code)]

mod ci;
mod counts;
mod python;
mod web;
mod wheel;

use std::process::{Command, ExitCode};

/// A command: its name, its description, and its programs, which run one after the other with the same arguments.
struct Task {
    name: &'static str,
    about: &'static str,
    packages: &'static [&'static str],
}

const TASKS: [Task; 10] = [
    Task {
        name: "report",
        about: "Measure this machine: the paper's tables first, then everything beyond them",
        packages: &["xtask-tables", "xtask-report"],
    },
    Task { name: "peers", about: "Compare speed, values and noise with other libraries", packages: &["xtask-peers"] },
    Task {
        name: "equivalence",
        about: "Check every backend of this CPU against the scalar reference, bit by bit",
        packages: &["xtask-equivalence"],
    },
    Task { name: "cross", about: "Test the backends of other processors on emulators", packages: &["xtask-cross"] },
    Task {
        name: "damage",
        about: "Run every command of the program on damaged files, under limits of memory and time",
        packages: &["xtask-damage"],
    },
    Task {
        name: "sweep",
        about: "Compare acos and asin on every backend with f64, over every f32 of [-1, 1]",
        packages: &["xtask-sweep"],
    },
    Task {
        name: "asm",
        about: "Check that no SIMD intrinsic is called out of line in the release binaries",
        packages: &["xtask-asm"],
    },
    Task {
        name: "outside",
        about: "Compare kernels instantiated by a crate outside the workspace with those of the workspace",
        packages: &["xtask-outside"],
    },
    Task {
        name: "fixtures",
        about: "Compute the tables and meshes in fixtures/ from their seeds, or check the existing ones",
        packages: &["xtask-fixtures"],
    },
    Task {
        name: "gallery",
        about: "Render the scenes in fixtures/scenes, and write docs/gallery.md",
        packages: &["xtask-gallery"],
    },
];

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_default();
    let arguments: Vec<String> = arguments.collect();
    if name == "ci" {
        return ci::run(&arguments);
    }
    if name == "python" {
        return python::run(&arguments);
    }
    if name == "web" {
        return web::run(&arguments);
    }
    let Some(task) = TASKS.iter().find(|task| task.name == name) else {
        help();
        return if ["", "-h", "--help"].contains(&name.as_str()) { ExitCode::SUCCESS } else { ExitCode::from(2) };
    };
    // The programs of a command share their options, so the first one explains them all.
    let is_question = arguments.iter().any(|argument| ["-h", "--help"].contains(&argument.as_str()));
    let packages = if is_question { &task.packages[..1] } else { task.packages };
    for package in packages {
        // The second half of the report ends with the equivalence checks, for which cores are idle while it is built. If they
        // are not wanted, or this fails, cargo says so below.
        if *package == "xtask-report" && arguments.iter().all(|argument| !argument.starts_with("--only")) {
            let _ = cargo()
                .args(["build", "--release", "--quiet", "--package", package, "--package", "xtask-equivalence"])
                .status();
        }
        let mut cargo = cargo();
        cargo.args(["run", "--release", "--quiet", "--package", package, "--"]).args(&arguments);
        match cargo.status() {
            Ok(status) if status.success() => {}
            Ok(status) => return ExitCode::from(status.code().and_then(|code| code.try_into().ok()).unwrap_or(1)),
            Err(error) => {
                eprintln!("cannot run cargo: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// The cargo that runs this.
fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

fn help() {
    println!("The commands of the workspace\n\nUsage: cargo xtask COMMAND [OPTIONS]\n\nCommands:");
    for Task { name, about, .. } in &TASKS {
        println!("  {name:12} {about}");
    }
    println!("  {:12} {}", "python", python::ABOUT);
    println!("  {:12} {}", "web", web::ABOUT);
    println!("  {:12} {}", "ci", ci::ABOUT);
    println!("\n`cargo xtask COMMAND --help` explains the options of a command.");
}
