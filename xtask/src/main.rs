//! The workspace's own commands: `cargo xtask COMMAND`.

mod report;

use clap::Parser;

#[derive(Parser)]
#[command(about = "The workspace's own commands", disable_help_subcommand = true)]
enum Command {
    /// Measure this machine and write target/report/index.html and report.json
    Report(report::Options),
}

fn main() -> anyhow::Result<()> {
    match Command::parse() {
        Command::Report(options) => report::run(&options),
    }
}
