//! `cargo xtask COMMAND`: the workspace's own commands, one module a command.

use clap::Parser;

/// The workspace's own commands.
#[derive(Parser)]
#[command(bin_name = "cargo xtask", disable_help_subcommand = true)]
enum Command {
    Report(xtask::report::Options),
    #[cfg(target_os = "linux")]
    Peers(xtask::peers::Options),
    Equivalence(xtask::equivalence::Args),
    Sweep(xtask::sweep::Args),
    Asm(xtask::asm::Args),
    Fixtures(xtask::fixtures::Args),
    Gallery(xtask::gallery::Args),
}

fn main() -> anyhow::Result<()> {
    match Command::parse() {
        Command::Report(options) => xtask::report::run(&options),
        #[cfg(target_os = "linux")]
        Command::Peers(options) => xtask::peers::run(&options),
        Command::Equivalence(args) => xtask::equivalence::run(&args),
        Command::Sweep(args) => xtask::sweep::run(&args),
        Command::Asm(args) => xtask::asm::run(&args),
        Command::Fixtures(args) => xtask::fixtures::run(&args),
        Command::Gallery(args) => xtask::gallery::run(&args),
    }
}
