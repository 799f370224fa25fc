//! `lobe preview`: a material on a ball and on a cloth, without a scene file.

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use lobe::{Given, Lookup, Options};
use lobe_files::check_output;
use lobe_render::integrator::Path;
use lobe_render::picture::{Meta, ToneMap, write_exr, write_png};
use lobe_render::preview::{Show, studio};
use lobe_render::shader::{Prepared, from_document};
use lobe_render::{Film, Filter, Rect, Settings, render};

use crate::angles::progress;
use crate::draft::Draft;
use crate::failure::Failure;
use crate::guesses::warn_of_guesses;
use crate::picture::{FILM, Kind, parse_exposure};
use crate::render::Machine;
use crate::{interrupt, message};

/// Show a measured material on a ball and on a draped cloth.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe preview paint.bsdf -o paint.png
  lobe preview velvet.ddr -o velvet.png --show cloth --samples 128 --size 1600x1200

The tangent of the cloth runs along its weft, so that psi of an anisotropic material follows the weave.")]
pub struct Args {
    /// The file of a measured BRDF or BSDF, in any format that lobe opens.
    material: PathBuf,
    /// The picture, .png or .exr.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The objects to show it on.
    #[arg(long, value_enum, default_value = "both")]
    show: Shown,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "800x600", value_parser = parse_size)]
    size: [u32; 2],
    /// Samples per pixel.
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = clap::value_parser!(u32).range(1..65_537))]
    samples: u32,
    /// Stop after this time, including the preparation of the material; every pixel gets at least one sample.
    #[arg(long, value_name = "TIME", default_value = "20s", value_parser = humantime::parse_duration)]
    time: Duration,
    /// For PNG: multiply radiance by two to this power [default: 0].
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = parse_exposure)]
    exposure: Option<f32>,
    #[command(flatten)]
    machine: Machine,
}

#[derive(Clone, Copy, ValueEnum)]
enum Shown {
    /// The ball next to the cloth.
    Both,
    /// The ball alone.
    Ball,
    /// The cloth alone.
    Cloth,
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let pair = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    pair.filter(|size: &[u32; 2]| size.iter().all(|n| (1..=8192).contains(n)))
        .ok_or_else(|| "expected WxH, such as 800x600, up to 8192x8192".into())
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let begun = Instant::now();
    let kind = Kind::of(&args.output)?;
    kind.refuse_exposure(args.exposure, &args.output)?;
    check_output(&args.output, &[&args.material])?;
    let backend = args.machine.backend()?;
    // A grid of half and difference angles that is not interpolated shows its bins; EPFL tables are indexed by the
    // viewer.
    let options = Options { lookup: Lookup::Linear, indexed_by: Given::Viewer, ..Options::default() };
    let (_, document) = lobe_formats::open(&args.material)?;
    warn_of_guesses(&args.material, &document);
    let draft = Draft::from_environment()?;
    let (wanted, time) = (draft.samples(args.samples), draft.time(args.time));
    let bar = (!args.machine.is_quiet()).then(|| progress("preparing the material"));
    let mut watch = |done: usize, all: usize| bar.iter().for_each(|bar| bar(done as f64 / all.max(1) as f64));
    // Half of the time is for the picture itself.
    let limit = time.saturating_sub(begun.elapsed()) / 2;
    let prepared = from_document(&document, &args.material, &options, backend, Some(limit), &mut watch);
    drop(bar);
    let Prepared { shader, is_limited } = prepared.map_err(|error| Failure::File(error.to_string()))?;
    let show = match args.show {
        Shown::Both => Show::Both,
        Shown::Ball => Show::Ball,
        Shown::Cloth => Show::Cloth,
    };
    let (world, camera) = studio(shader, show, backend).map_err(|error| Failure::File(error.to_string()))?;
    let window = Rect { x: 0, y: 0, width: args.size[0], height: args.size[1] };
    let settings = Settings {
        camera,
        size: args.size,
        window,
        filter: Filter::Tent,
        integrator: Arc::new(Path { depth: 4, limit: 4.0 }),
        samples: 0..wanted,
        backend,
        threads: args.machine.threads(),
        time: Some(time.saturating_sub(begun.elapsed())),
    };
    let bar = args.machine.bar();
    let film = Film::try_new(window, FILM)?;
    interrupt::listen();
    let rendered = render(&world, &settings, film, |progress| {
        bar.show(progress.done, progress.total, Some((begun.elapsed(), time)));
        !interrupt::is_asked()
    });
    bar.finish();
    let (film, _) = rendered.map_err(|error| Failure::Usage(error.to_string()))?;
    let elapsed = begun.elapsed();
    match kind {
        Kind::Png => write_png(&args.output, &film, ToneMap { exposure: args.exposure.unwrap_or(0.0) })?,
        Kind::Exr => {
            let scene = "preview".into();
            let meta = Meta {
                scene,
                size: args.size,
                window,
                samples: 0..film.samples().1,
                total: film.samples().1,
                timed: true,
                exposure: args.exposure.unwrap_or(0.0),
                version: Meta::VERSION.into(),
                arithmetic: Meta::arithmetic_of(backend),
            };
            write_exr(&args.output, &film, &meta, false)?;
        }
    }
    if interrupt::is_asked() {
        let message = format!("{}: interrupted; the picture so far was written", args.output.display());
        return Err(Failure::Interrupted(message));
    }
    if !args.machine.is_quiet() {
        let mut out = message::out(false);
        writeln!(out, "{}: {}", args.output.display(), summary(args, kind, wanted, film.samples(), elapsed))?;
        if is_limited {
            let noise =
                "The sampling of the material was prepared coarsely, to keep within --time; this gives more noise.";
            writeln!(out, "{noise}")?;
        }
        out.flush()?;
    }
    Ok(())
}

/// A summary of the output: the pixels, the number of samples reached, and the exposure.
fn summary(args: &Args, kind: Kind, wanted: u32, (least, most): (u32, u32), elapsed: Duration) -> String {
    let [width, height] = args.size;
    let samples = if least == most { least.to_string() } else { format!("{least} to {most}") };
    let mut words = format!("{width} x {height} pixels of {samples} samples in {:.1} s", elapsed.as_secs_f64());
    if least < wanted {
        words.push_str(&format!(", not {wanted}, because the time of --time was up"));
    }
    match kind {
        Kind::Png => words + &format!("; exposure {:+} EV", args.exposure.unwrap_or(0.0)),
        // Values are not scaled.
        Kind::Exr => words,
    }
}
