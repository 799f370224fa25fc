//! The `lobe` program: look at measured materials and evaluate them.
#![forbid(unsafe_code)]

mod albedo;
mod angles;
mod check;
mod compare;
mod describe;
mod eval;
mod failure;
mod info;
mod pairs;
mod progress;
mod resample;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::failure::Failure;

/// Look at measured BRDFs and BTDFs and evaluate them.
#[derive(Parser)]
#[command(
    name = "lobe",
    version,
    after_help = "Exit codes: 0 done, 1 a file is unreadable or damaged, 2 wrong usage, 3 a check failed."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Info(info::Args),
    Eval(eval::Args),
    Albedo(albedo::Args),
    Check(check::Args),
    Compare(compare::Args),
    Resample(resample::Args),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Info(args) => info::run(&args),
        Command::Eval(args) => eval::run(&args),
        Command::Albedo(args) => albedo::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Resample(args) => resample::run(&args),
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
