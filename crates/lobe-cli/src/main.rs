//! The `lobe` program: look at measured materials, evaluate them, and make pictures of them.
#![forbid(unsafe_code)]

mod describe;
mod eval;
mod failure;
mod info;
mod merge;
mod pairs;
mod preview;
mod progress;
mod render;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::failure::Failure;

/// Look at measured BRDFs and BTDFs, evaluate them, and make pictures of them.
#[derive(Parser)]
#[command(name = "lobe", version, after_help = "Exit codes: 0 done, 1 a file is unreadable or damaged, 2 wrong usage.")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Info(info::Args),
    Eval(eval::Args),
    Preview(preview::Args),
    Render(render::Args),
    Merge(merge::Args),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Info(args) => info::run(&args),
        Command::Eval(args) => eval::run(&args),
        Command::Preview(args) => preview::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Merge(args) => merge::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::OutputClosed) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit_code()
        }
    }
}
