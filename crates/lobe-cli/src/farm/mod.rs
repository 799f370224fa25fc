//! `lobe farm`: rendering a picture on many machines with a job scheduler.
//!
//! Writes scripts and templates around `lobe render --tile --resume` and `lobe merge`: a finished part is not rendered
//! again, an interrupted one continues, and the merge refuses gaps and duplicates.

mod files;
mod openjd;
mod plan;
mod slurm;
mod status;

use clap::Subcommand;

use crate::failure::Failure;

/// Render a scene on many machines: job scripts for Slurm, a job template for OpenJD, and their progress.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe farm slurm scene.toml -o picture.exr --parts 8
  lobe farm openjd scene.toml -o job --parts 8
  lobe farm status look.exr.farm

The picture has the same bits as that of `lobe render` if all machines have the same instructions, or with --strict.")]
pub struct Args {
    #[command(subcommand)]
    engine: Engine,
}

#[derive(Subcommand)]
enum Engine {
    Slurm(slurm::Args),
    Openjd(openjd::Args),
    Status(status::Args),
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    match &args.engine {
        Engine::Slurm(args) => slurm::run(args),
        Engine::Openjd(args) => openjd::run(args),
        Engine::Status(args) => status::run(args),
    }
}
