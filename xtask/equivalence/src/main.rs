//! `cargo xtask equivalence`.
#![forbid(unsafe_code)]

use clap::Parser;

fn main() -> anyhow::Result<()> {
    xtask_equivalence::run(&xtask_equivalence::Args::parse())
}
