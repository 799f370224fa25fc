//! `lobe merge`: joins the parts of a picture.

use std::path::PathBuf;

use lobe_files::check_output;
use lobe_render::picture::{ToneMap, inspect, write_exr_in, write_png_in};
use lobe_render::{Bands, Rgb, Stokes16, StokesRgb, Transport, merge_in};

use crate::failure::Failure;
use crate::picture::{Kind, parse_exposure};
use crate::render::Show;

/// Add the parts of a picture written by `lobe render --tile` and `--samples-range`. The result has the same bits as
/// the picture rendered at once.
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
    /// For PNG: multiply radiance by two to this power; by default the exposure of the scene.
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = parse_exposure)]
    exposure: Option<f32>,
    /// The quantity that a PNG shows.
    #[arg(long, value_enum, default_value = "colour")]
    show: Show,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let kind = Kind::of(&args.output)?;
    kind.refuse_exposure(args.exposure, &args.output)?;
    check_output(&args.output, &args.parts)?;
    // Parts of other pictures are refused when they are merged.
    let light = inspect(&args.parts[0])?.light;
    let bands = light.bands().map_err(|error| Failure::File(format!("{}: {error}", args.parts[0].display())))?;
    match bands {
        None if light.stokes => merged::<StokesRgb>(args, kind, &()),
        None => merged::<Rgb>(args, kind, &()),
        Some(bands) if light.stokes => merged::<Stokes16>(args, kind, &bands),
        Some(bands) if bands.count() <= 8 => merged::<Bands<8>>(args, kind, &bands),
        Some(bands) if bands.count() <= 16 => merged::<Bands<16>>(args, kind, &bands),
        Some(bands) => merged::<Bands<32>>(args, kind, &bands),
    }
}

/// Merges parts with their channels.
fn merged<T: Transport>(args: &Args, kind: Kind, basis: &T::Basis) -> Result<(), Failure> {
    let shown = args.show.shown(&args.output, kind, T::POLARISED)?;
    let merged = merge_in::<T>(&args.parts, args.allow_gaps, basis);
    let (film, meta) = merged.map_err(|error| Failure::File(error.to_string()))?;
    let tone = ToneMap { exposure: args.exposure.unwrap_or(meta.exposure) };
    match kind {
        Kind::Exr => write_exr_in(&args.output, &film, basis, &meta, false)?,
        Kind::Png => write_png_in(&args.output, &film, basis, tone, shown)?,
    }
    Ok(())
}
