//! The `lobe` program: look at measured materials, evaluate, convert and draw them.
#![forbid(unsafe_code)]

mod albedo;
mod angles;
mod channels;
mod check;
mod compare;
mod convert;
mod describe;
mod eval;
mod failure;
mod generate;
mod info;
mod measure;
mod merge;
mod output;
mod pairs;
mod plot;
mod preview;
mod probe;
mod progress;
mod render;
mod resample;
mod shell;
mod summary;
mod surface;
mod target;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::failure::Failure;

/// Inspect, check, evaluate, convert and draw measured BRDFs and BTDFs.
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
    Check(check::Args),
    Albedo(albedo::Args),
    Compare(compare::Args),
    Plot(plot::Args),
    Preview(preview::Args),
    Render(render::Args),
    Merge(merge::Args),
    Convert(Box<convert::Args>),
    Resample(resample::Args),
    Generate(Box<generate::Args>),
    Completions(shell::Completions),
    Man(shell::Man),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Info(args) => info::run(&args),
        Command::Eval(args) => eval::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Albedo(args) => albedo::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Plot(args) => plot::run(&args),
        Command::Preview(args) => preview::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Resample(args) => resample::run(&args),
        Command::Generate(args) => generate::run(&args),
        Command::Completions(args) => shell::completions(&args),
        Command::Man(args) => shell::man(&args),
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
