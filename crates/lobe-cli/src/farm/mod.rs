//! `lobe farm`: a picture on many machines, by engines that run jobs there.
//!
//! What is made are scripts and templates around `lobe render --tile --resume` and `lobe merge`: a part that is finished is not
//! made again, one that was interrupted goes on, and the merge refuses gaps and doubles.

mod files;
mod openjd;
mod plan;
mod slurm;
mod status;

use clap::Subcommand;

use crate::failure::Failure;

/// Render a scene on many machines: job scripts for Slurm, a job template for OpenJD, and how far they are.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe farm slurm scene.toml -o picture.exr --parts 8
  lobe farm openjd scene.toml -o job --parts 8
  lobe farm status look.exr.farm

The picture is the same bits as that of `lobe render`, on machines with the same instructions, or on all with --strict.")]
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
