//! `lobe render`: pictures of scenes.

use std::io::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser};
use lobe::Backend;
use lobe_render::integrator::INTEGRATORS;
use lobe_render::picture::{Meta, Shown, ToneMap};
use lobe_render::scene::{AnyScene, Scene};
use lobe_render::{Film, Rect, Settings, Transport, render};

use crate::angles::progress;
use crate::draft::Draft;
use crate::failure::Failure;
use crate::message::say;
use crate::picture::{Begun, FILM, Kind, Output};
use crate::progress::Bar;
use crate::summary::Summary;
use crate::{interrupt, message};

/// Render a scene file to EXR or PNG.
#[derive(clap::Args)]
#[command(
    after_help = "The picture does not depend on threads, tiles, or the order of work. With --strict, it does not \
depend on the instructions of the machine either.

Every 30 seconds, and on Ctrl-C, the picture so far is written; an EXR file then also has the exact sums from which \
--resume continues. For a PNG, they are next to it, in OUT.part.exr. A second Ctrl-C ends the program at once. A \
finished picture has no sums, unless --keep-sums is given.

Integrators: `path` for most scenes; `bdpt` for rooms that are lit indirectly and for caustics; `light` for caustics alone; \
`sppm` and `vcm` for caustics that mirrors and glass show, `vcm` if the scene has other light as well. The last four \
follow the light paths of the whole picture in every part of it, so divide their work with --samples-range, not with --tile.

LOBE_DRAFT=N divides sample counts and time limits by N, for a first look.

Examples:
  lobe render scene.toml -o picture.exr
  lobe render scene.toml -o look.png --samples 16 --crop 100,50,300,250
  lobe render scene.toml -o picture.exr --time 10m --resume
  lobe render scene.toml -o picture.exr --keep-sums        and later --resume --samples 256
  lobe render scene.toml -o part2.exr --tile 2/4           on the second of four machines
  lobe render scene.toml -o more.exr --samples-range 64..128
  lobe render glass.toml -o polarised.png --show dolp      of a scene with polarised light
  lobe merge part*.exr -o picture.exr
  lobe render scene.toml -o picture.png --json | jq .shares.materials"
)]
pub struct Args {
    /// The scene, a TOML file.
    scene: PathBuf,
    /// The picture, .exr or .png.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Samples per pixel, instead of those in the scene.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..u32::MAX as i64))]
    samples: Option<u32>,
    /// The integrator, with its default parameters, instead of the one in the scene.
    #[arg(long, value_name = "NAME", value_parser = integrators())]
    integrator: Option<String>,
    /// Stop after this time, such as 90s or 10m, including the time to read the scene; every pixel gets at least one
    /// sample.
    #[arg(long, value_name = "TIME", value_parser = humantime::parse_duration)]
    time: Option<Duration>,
    /// Render the pixels from column X0 and row Y0 up to, but not including, X1 and Y1, counted from the upper left.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = parse_crop)]
    crop: Option<Rect>,
    /// Render part I of N, counted from 1, and write it so that `lobe merge` can add it to the others.
    #[arg(long, value_name = "I/N", value_parser = parse_tile, conflicts_with = "crop")]
    tile: Option<(u32, u32)>,
    /// Render only these samples, and write them so that `lobe merge` can add them to the others.
    #[arg(long, value_name = "A..B", value_parser = parse_range, conflicts_with = "time")]
    samples_range: Option<Range<u32>>,
    /// The interval at which the picture so far is written.
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = humantime::parse_duration)]
    write_every: Duration,
    /// Continue from the file that a stopped rendering, or one with --keep-sums, left behind.
    #[arg(long)]
    resume: bool,
    /// Start anew, even if the sums of an earlier rendering are lost.
    #[arg(long, conflicts_with = "resume")]
    force: bool,
    /// Also write the exact sums of the finished picture, so that --resume can add samples.
    #[arg(long)]
    keep_sums: bool,
    /// The quantity that a PNG shows.
    #[arg(long, value_enum, default_value = "colour")]
    show: Show,
    /// Print statistics of the rendering as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    machine: Machine,
}

/// The use of the machine; the picture does not depend on it, except that the last digits may differ between backends.
#[derive(clap::Args)]
pub struct Machine {
    /// The number of threads; by default as many as the machine has.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..1025))]
    threads: Option<u16>,
    /// The instructions: scalar, sse2, sse4.1, avx2 or avx512; the default is the best set that this machine has.
    #[arg(long, value_name = "NAME")]
    backend: Option<String>,
    /// Round in the same way with all instruction sets, which is slightly slower.
    #[arg(long)]
    strict: bool,
    /// Show no progress and no summary.
    #[arg(long)]
    quiet: bool,
}

impl Machine {
    /// The requested backend.
    pub fn backend(&self) -> Result<Backend, Failure> {
        let backend = match &self.backend {
            Some(name) => Backend::named(name).map_err(|error| Failure::Usage(error.to_string()))?,
            None => Backend::detect().map_err(|error| Failure::Usage(format!("LOBE_BACKEND: {error}")))?,
        };
        Ok(if self.strict { backend.strict() } else { backend })
    }

    /// The number of threads.
    pub fn threads(&self) -> usize {
        self.threads.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from)
    }

    /// `true` if no progress should be shown.
    pub fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// A progress bar, unless none is wanted.
    pub fn bar(&self) -> Bar {
        Bar::new(self.quiet)
    }
}

/// The names of integrators, each with its summary.
fn integrators() -> PossibleValuesParser {
    let values: Vec<_> = INTEGRATORS.iter().map(|spec| PossibleValue::new(spec.name).help(spec.summary)).collect();
    PossibleValuesParser::new(values)
}

fn parse_crop(text: &str) -> Result<Rect, String> {
    let numbers: Vec<u32> =
        text.split(',').map(|part| part.trim().parse::<u32>()).collect::<Result<_, _>>().map_err(|e| e.to_string())?;
    match numbers[..] {
        [x0, y0, x1, y1] if x0 < x1 && y0 < y1 => Ok(Rect { x: x0, y: y0, width: x1 - x0, height: y1 - y0 }),
        _ => Err("expected X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1".into()),
    }
}

fn parse_tile(text: &str) -> Result<(u32, u32), String> {
    let pair = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    pair.filter(|&(i, n): &(u32, u32)| 1 <= i && i <= n).ok_or_else(|| "expected I/N with 1 <= I <= N".into())
}

fn parse_range(text: &str) -> Result<Range<u32>, String> {
    let pair = text.split_once("..").and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
    pair.filter(|range: &Range<u32>| !range.is_empty()).ok_or_else(|| "expected A..B with A < B".into())
}

/// If only a time limit is given, the number of samples is not limited.
const UNLIMITED: u32 = 1 << 20;

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let begun = Instant::now();
    let kind = Kind::of(&args.output)?;
    let partial = args.tile.is_some() || args.samples_range.is_some();
    if partial && kind == Kind::Png {
        let message = format!("{}: found a PNG file; expected .exr, which holds exact sums", args.output.display());
        return Err(Failure::Usage(message));
    }
    let output = Output::new(&args.output, kind, partial || args.keep_sums);
    output.check(&[&args.scene])?;
    let backend = args.machine.backend()?;
    let bar = (!args.machine.is_quiet()).then(|| progress("preparing materials"));
    let mut watch = |share: f64| bar.iter().for_each(|bar| bar(share));
    let scene = AnyScene::open_with_progress(&args.scene, backend, args.integrator.as_deref(), &mut watch);
    drop(bar);
    let begun = Beginning { begun, backend, partial };
    match scene.map_err(|error| Failure::File(error.to_string()))? {
        AnyScene::Rgb(scene) => run_scene(args, begun, output, scene),
        AnyScene::Bands8(scene) => run_scene(args, begun, output, scene),
        AnyScene::Bands16(scene) => run_scene(args, begun, output, scene),
        AnyScene::Bands32(scene) => run_scene(args, begun, output, scene),
        AnyScene::StokesRgb(scene) => run_scene(args, begun, output, scene),
        AnyScene::Stokes16(scene) => run_scene(args, begun, output, scene),
        AnyScene::EnergyRgb(scene) => run_scene(args, begun, output, scene),
        AnyScene::Energy16(scene) => run_scene(args, begun, output, scene),
    }
}

/// The information that does not depend on the scene.
struct Beginning {
    begun: Instant,
    backend: Backend,
    /// `true` if other parts are rendered elsewhere.
    partial: bool,
}

/// Renders a scene with its channels.
fn run_scene<T: Transport>(
    args: &Args,
    Beginning { begun, backend, partial }: Beginning,
    mut output: Output<'_>,
    scene: Scene<T>,
) -> Result<(), Failure> {
    output.shown = args.show.shown(&args.output, Kind::of(&args.output)?, T::SHOWS_POLARISATION)?;
    output.check(&scene.files)?;
    let draft = Draft::from_environment()?;
    let range = args.samples_range.as_ref().map(|range| draft.range(range));
    let total = match (args.samples, args.time) {
        (Some(samples), _) => draft.samples(samples),
        (None, Some(_)) => UNLIMITED,
        (None, None) => draft.samples(scene.samples).max(range.as_ref().map_or(0, |range| range.end)),
    };
    let samples = range.unwrap_or(0..total);
    if samples.end > total {
        return Err(Failure::Usage(format!(
            "--samples-range: found samples up to {}; expected {total} at most",
            samples.end
        )));
    }
    let window = window(args, scene.size)?;
    let Scene { integrator, hash, .. } = scene;
    // Parts of pictures by different integrators must not be merged.
    let hash = match &args.integrator {
        Some(name) => format!("{hash}-{name}"),
        None => hash,
    };
    output.tone = ToneMap { exposure: scene.exposure };
    let meta = Meta {
        scene: hash,
        size: scene.size,
        window,
        samples: samples.clone(),
        total,
        timed: args.time.is_some(),
        exposure: scene.exposure,
        version: Meta::VERSION.into(),
        arithmetic: Meta::arithmetic_of(backend),
    };
    let basis = scene.world.basis();
    let film = match (args.resume, output.earlier()?) {
        (true, Some(earlier)) => match output.resume(basis, &meta, &earlier)? {
            Begun::Sums(film) => film,
            Begun::Finished(samples) => {
                say(format_args!("{}: already finished, with {samples} samples", args.output.display()));
                return Ok(());
            }
        },
        (true, None) => {
            if !args.machine.quiet {
                say(format_args!("{}: missing, so there is nothing to continue", output.part().display()));
            }
            Film::try_new(window, FILM)?
        }
        (false, Some(earlier)) if earlier.has_sums && !args.force => return Err(output.refuse(&earlier)),
        (false, _) => Film::try_new(window, FILM)?,
    };
    let settings = Settings {
        camera: scene.camera,
        size: scene.size,
        window,
        filter: scene.filter,
        integrator,
        samples,
        backend,
        threads: args.machine.threads(),
        time: args.time.map(|time| draft.time(time).saturating_sub(begun.elapsed())),
    };
    let bar = args.machine.bar();
    let started = Instant::now();
    let (mut written, mut warned) = (started, None);
    interrupt::listen();
    let rendered = render(&scene.world, &settings, film, |progress| {
        bar.show(progress.done, progress.total, settings.time.map(|limit| (progress.elapsed, limit)));
        if written.elapsed() >= args.write_every && !interrupt::is_asked() {
            // The work continues: there may be space again when it is finished.
            if let Err(failure) = output.write_so_far(basis, &meta, || progress.film()) {
                let warning = format!("warning: the picture so far was not written: {failure}");
                if warned.as_ref() != Some(&warning) {
                    bar.say(&warning);
                    warned = Some(warning);
                }
            }
            written = Instant::now();
        }
        !interrupt::is_asked()
    });
    bar.finish();
    let (film, stats) = rendered.map_err(|error| Failure::Usage(error.to_string()))?;
    if stats.invalid > 0 {
        say(format_args!("warning: {} samples were not finite and were counted as black", stats.invalid));
    }
    if stats.light_paths > 0 && stats.landed == 0 {
        say(format_args!("warning: none of {} light paths met a surface", stats.light_paths));
    }
    let (least, most) = film.samples();
    if interrupt::is_asked() && least < meta.samples.end - meta.samples.start {
        return Err(output.interrupted(&film, basis, &meta));
    }
    output.write(&film, basis, &meta, partial)?;
    let summary = Summary::new([window.width, window.height], (least, most), started.elapsed(), &stats);
    let mut out = message::out(args.json);
    if args.json {
        serde_json::to_writer_pretty(&mut out, &summary)?;
        writeln!(out)?;
    } else if !args.machine.quiet {
        writeln!(out, "{}: {summary}", args.output.display())?;
    }
    Ok(out.flush()?)
}

/// The quantity that a PNG shows.
#[derive(Clone, Copy, Default, PartialEq, ValueEnum)]
pub enum Show {
    /// The colour of light.
    #[default]
    Colour,
    /// The degree of linear polarisation.
    Dolp,
    /// The angle of linear polarisation as a hue, with the degree as brightness.
    Aolp,
}

impl Show {
    /// Refuses a quantity that the picture does not have.
    pub fn shown(self, path: &Path, kind: Kind, is_polarised: bool) -> Result<Shown, Failure> {
        let refuse = |found: &str, expected: &str| {
            Err(Failure::Usage(format!("{}: found --show with {found}; expected {expected}", path.display())))
        };
        match self {
            Show::Colour => Ok(Shown::Colour),
            _ if kind == Kind::Exr => refuse("an EXR file, which has all quantities as channels", ".png"),
            _ if !is_polarised => refuse(
                "a picture without polarisation",
                "a scene with `stokes = true` in [spectrum] and no other `sensor`",
            ),
            Show::Dolp => Ok(Shown::Degree),
            Show::Aolp => Ok(Shown::Angle),
        }
    }
}

/// The pixels to render.
fn window(args: &Args, size: [u32; 2]) -> Result<Rect, Failure> {
    let whole = Rect { x: 0, y: 0, width: size[0], height: size[1] };
    if let Some((tile, tiles)) = args.tile {
        return whole.strip(tile, tiles).ok_or_else(|| {
            Failure::Usage(format!("--tile: found {tiles} parts; expected at most {}, the number of rows", size[1]))
        });
    }
    let crop = args.crop.unwrap_or(whole);
    match whole.intersection(&crop) {
        Some(inside) if inside == crop => Ok(crop),
        _ => {
            let message = format!("--crop: found pixels outside the picture; expected up to {},{}", size[0], size[1]);
            Err(Failure::Usage(message))
        }
    }
}
