//! `lobe merge`: parts of a picture back together.

use std::path::PathBuf;

use lobe_files::check_output;
use lobe_render::merge;
use lobe_render::picture::{ToneMap, write_exr, write_png};

use crate::failure::Failure;
use crate::picture::Kind;

/// Add the parts of a picture that `lobe render --tile` and `--samples-range` have written. The result is the same bits
/// as the picture rendered at once.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe merge part*.exr -o picture.exr
  lobe merge part1.exr part2.exr -o look.png --allow-gaps --exposure 1")]
pub struct Args {
    /// The parts.
    #[arg(required = true)]
    parts: Vec<PathBuf>,
    /// The picture, .exr or .png.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Write the picture even if samples are missing.
    #[arg(long)]
    allow_gaps: bool,
    /// For PNG: multiply radiance by two to this power; by default that of the scene.
    #[arg(long, allow_hyphen_values = true)]
    exposure: Option<f32>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let kind = Kind::of(&args.output)?;
    kind.refuse_exposure(args.exposure, &args.output)?;
    check_output(&args.output, &args.parts)?;
    let (film, meta) = merge(&args.parts, args.allow_gaps).map_err(|error| Failure::File(error.to_string()))?;
    match kind {
        Kind::Exr => write_exr(&args.output, &film, &meta, false)?,
        Kind::Png => write_png(&args.output, &film, ToneMap { exposure: args.exposure.unwrap_or(meta.exposure) })?,
    }
    Ok(())
}
