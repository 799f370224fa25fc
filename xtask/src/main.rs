//! The workspace's own commands.
#![forbid(unsafe_code)]

mod fixtures;

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
}

fn main() -> anyhow::Result<()> {
    match Arguments::parse().command {
        Command::Fixtures(arguments) => fixtures::run(arguments),
    }
}
