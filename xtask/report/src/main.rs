//! The second half of `cargo xtask report`.
#![forbid(unsafe_code)]

use clap::Parser;

fn main() -> anyhow::Result<()> {
    xtask_report::run(&xtask_tables::Options::parse())
}
