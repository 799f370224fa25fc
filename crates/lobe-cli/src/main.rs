//! The `lobe` program: inspect, evaluate, convert and draw measured materials.
#![forbid(unsafe_code)]
// The macros panic if nobody reads their output, or a disk is full; `message` does not.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod albedo;
mod angles;
mod certificate;
mod check;
mod compare;
mod convert;
mod draft;
mod eval;
mod failure;
mod farm;
mod fit;
mod generate;
mod guesses;
mod import;
mod info;
mod interrupt;
mod matrices;
mod matrix;
mod measure;
mod merge;
mod message;
mod output;
mod pairs;
mod picture;
mod plot;
mod preview;
mod probe;
mod progress;
mod reading;
mod render;
mod resample;
mod shell;
mod summary;
mod target;
mod threads;
mod view;

use std::io::{Write as _, stdout};
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::failure::Failure;

/// The same for all commands, at the end of each help text.
const EXIT_CODES: &str = "Exit codes: 0 done, 1 a file cannot be read or written or is damaged, or there is not enough memory, \
2 wrong usage, 3 a check failed or a bound was not met, 130 interrupted.";

/// Inspect, check, evaluate, convert and draw measured BRDFs and BTDFs.
///
/// If the name of a file to read is `-`, standard input is read.
#[derive(Parser)]
#[command(
    name = "lobe",
    version,
    after_help = EXIT_CODES
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Import(Box<import::Args>),
    Info(info::Args),
    Eval(Box<eval::Args>),
    Check(check::Args),
    Albedo(albedo::Args),
    Compare(compare::Args),
    Fit(Box<fit::Args>),
    Plot(Box<plot::Args>),
    Preview(preview::Args),
    View(view::Args),
    Render(render::Args),
    Matrix(matrix::Args),
    Merge(merge::Args),
    Farm(Box<farm::Args>),
    Convert(Box<convert::Args>),
    Resample(resample::Args),
    Generate(Box<generate::Args>),
    Completions(shell::Completions),
    Man(shell::Man),
}

/// The arguments of the program, as they are parsed and as help, completions and manual pages show them.
fn command() -> clap::Command {
    Cli::command().mut_subcommands(with_exit_codes)
}

fn with_exit_codes(command: clap::Command) -> clap::Command {
    let help = command.get_after_help().map(|help| format!("{help}\n\n")).unwrap_or_default();
    command.after_help(format!("{help}{EXIT_CODES}")).mut_subcommands(with_exit_codes)
}

fn main() -> ExitCode {
    let cli = match command().try_get_matches().and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => return explain(&error),
    };
    lobe_files::name_standard_input();
    if !matches!(cli.command, Command::Info(_) | Command::View(_) | Command::Completions(_) | Command::Man(_)) {
        threads::start();
    }
    let done = match cli.command {
        Command::Import(args) => import::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Eval(args) => eval::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Albedo(args) => albedo::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Fit(args) => fit::run(&args),
        Command::Plot(args) => plot::run(&args),
        Command::Preview(args) => preview::run(&args),
        Command::View(args) => view::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Matrix(args) => matrix::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Farm(args) => farm::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Resample(args) => resample::run(&args),
        Command::Generate(args) => generate::run(&args),
        Command::Completions(args) => shell::completions(&args),
        Command::Man(args) => shell::man(&args),
    };
    end(done)
}

/// Prints a help text, or what is wrong with the arguments.
fn explain(error: &clap::Error) -> ExitCode {
    match error.print().and_then(|()| stdout().flush()) {
        Err(unwritten) if !error.use_stderr() => end(Err(unwritten.into())),
        _ => ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2)),
    }
}

fn end(done: Result<(), Failure>) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::OutputClosed) => ExitCode::SUCCESS,
        Err(failure) => {
            message::say(format_args!("error: {failure}"));
            failure.exit_code()
        }
    }
}
