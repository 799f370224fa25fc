//! The workspace's own commands.
#![forbid(unsafe_code)]

mod fixtures;
mod pictures;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(about = "The workspace's own commands")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Make the tables in fixtures/ from their seeds, or check those that are there
    Fixtures(fixtures::Arguments),
    /// Draw the pictures of the documentation
    Pictures(pictures::Arguments),
}

fn main() -> anyhow::Result<()> {
    match Arguments::parse().command {
        Command::Fixtures(arguments) => fixtures::run(arguments),
        Command::Pictures(arguments) => pictures::run(arguments),
    }
}
