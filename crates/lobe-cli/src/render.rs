//! `lobe render`: pictures of scenes.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::builder::{PossibleValue, PossibleValuesParser};
use lobe::Backend;
use lobe_render::integrator::{self, INTEGRATORS};
use lobe_render::picture::{Meta, ToneMap, read_partial, write_exr, write_png};
use lobe_render::scene::Scene;
use lobe_render::{Film, Rect, Settings, render};

use crate::failure::Failure;
use crate::progress::Bar;
use crate::summary::Summary;

/// Render a scene file to EXR or PNG.
#[derive(clap::Args)]
#[command(
    after_help = "The picture does not depend on threads, tiles, or the order of work. With --strict it does not depend \
on the instructions of the machine either.

Every 30 seconds the picture so far is written; an EXR file then also has the exact sums from which \
--resume continues. For a PNG they are next to it, in OUT.part.exr.

Examples:
  lobe render scene.toml -o picture.exr
  lobe render scene.toml -o look.png --samples 16 --crop 100,50,300,250
  lobe render scene.toml -o picture.exr --time 10m --resume
  lobe render scene.toml -o part2.exr --tile 2/4           on the second of four machines
  lobe render scene.toml -o more.exr --samples-range 64..128
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
    /// Stop after this time, such as 90s or 10m, at the latest; every pixel has a sample by then.
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
    /// How often the picture so far is written.
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = humantime::parse_duration)]
    write_every: Duration,
    /// Continue from the file that a stopped rendering has left.
    #[arg(long)]
    resume: bool,
    /// Print what the rendering took as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    machine: Machine,
}

/// How to use the machine; the picture does not depend on it, except for the last digits on other backends.
#[derive(clap::Args)]
pub struct Machine {
    /// Number of threads; by default as many as the machine has.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..1025))]
    threads: Option<u16>,
    /// The instructions: scalar, sse2, sse4.1, avx2 or avx512; by default the best of this machine.
    #[arg(long, value_name = "NAME")]
    backend: Option<String>,
    /// Round the same way on all machines and instructions, which is a little slower.
    #[arg(long)]
    strict: bool,
    /// Show no progress.
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

    /// A progress bar, unless none is wanted.
    pub fn bar(&self) -> Bar {
        Bar::new(self.quiet)
    }
}

/// The names of integrators, each with what it does.
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

/// With a time limit only, there is no other limit.
const UNLIMITED: u32 = 1 << 20;

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let kind = Kind::of(&args.output)?;
    let backend = args.machine.backend()?;
    let scene = Scene::open(&args.scene, backend).map_err(|error| Failure::File(error.to_string()))?;
    let total = match (args.samples, args.time) {
        (Some(samples), _) => samples,
        (None, Some(_)) => UNLIMITED,
        (None, None) => scene.samples.max(args.samples_range.as_ref().map_or(0, |range| range.end)),
    };
    let samples = args.samples_range.clone().unwrap_or(0..total);
    if samples.end > total {
        return Err(Failure::Usage(format!(
            "--samples-range: found samples up to {}; expected {total} at most",
            samples.end
        )));
    }
    let window = window(args, scene.size)?;
    let (integrator, hash) = match args.integrator.as_deref().and_then(integrator::named) {
        // Parts of pictures by different integrators must not be merged.
        Some(spec) => ((spec.default)(), format!("{}-{}", scene.hash, spec.name)),
        None => (scene.integrator, scene.hash),
    };
    let meta = Meta { scene: hash, size: scene.size, window, samples: samples.clone(), total };
    let partial = args.tile.is_some() || args.samples_range.is_some();
    if partial && kind == Kind::Png {
        let message = format!("{}: found a PNG file; expected .exr, which holds exact sums", args.output.display());
        return Err(Failure::Usage(message));
    }
    let output = Output { path: &args.output, kind, tone: ToneMap { exposure: scene.exposure }, meta };
    let film = if args.resume { output.resume()? } else { Film::new(window) };
    let settings = Settings {
        camera: scene.camera,
        size: scene.size,
        window,
        filter: scene.filter,
        integrator,
        samples,
        backend,
        threads: args.machine.threads(),
        time: args.time,
    };
    let bar = args.machine.bar();
    let begun = Instant::now();
    let (mut written, mut failed) = (begun, None);
    let rendered = render(&scene.world, &settings, film, |progress| {
        bar.show(progress.done, progress.total, settings.time.map(|limit| (progress.elapsed, limit)));
        if written.elapsed() >= args.write_every {
            failed = output.write_part(&progress.film()).err();
            written = Instant::now();
        }
        failed.is_none()
    });
    bar.finish();
    if let Some(failure) = failed {
        return Err(failure);
    }
    let (film, stats) = rendered.map_err(|error| Failure::Usage(error.to_string()))?;
    if stats.invalid > 0 {
        eprintln!("warning: {} samples were not finite and count as black", stats.invalid);
    }
    output.write(&film, partial)?;
    let summary = Summary::new([window.width, window.height], film.samples(), begun.elapsed(), &stats);
    if args.json {
        println!("{}", serde_json::to_string_pretty(&summary)?);
    } else if !args.machine.quiet {
        println!("{}: {summary}", args.output.display());
    }
    Ok(())
}

/// The pixels to render.
fn window(args: &Args, size: [u32; 2]) -> Result<Rect, Failure> {
    let whole = Rect { x: 0, y: 0, width: size[0], height: size[1] };
    if let Some((tile, tiles)) = args.tile {
        // Strips of rows, as equal as can be.
        let row = |tile: u32| (u64::from(size[1]) * u64::from(tile) / u64::from(tiles)) as u32;
        let (y, end) = (row(tile - 1), row(tile));
        if y == end {
            let message = format!("--tile: found {tiles} parts of {} rows; expected at most as many", size[1]);
            return Err(Failure::Usage(message));
        }
        return Ok(Rect { x: 0, y, width: size[0], height: end - y });
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

/// The kinds of files that pictures are written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// OpenEXR.
    Exr,
    /// PNG.
    Png,
}

impl Kind {
    /// The kind given by the name of a file.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        let is = |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
        match (is("exr"), is("png")) {
            (true, _) => Ok(Kind::Exr),
            (_, true) => Ok(Kind::Png),
            _ => Err(Failure::Usage(format!("{}: expected a name that ends in .exr or .png", path.display()))),
        }
    }
}

/// Where the picture goes.
struct Output<'a> {
    path: &'a Path,
    kind: Kind,
    tone: ToneMap,
    meta: Meta,
}

impl Output<'_> {
    /// The file that a stopped rendering leaves.
    fn part(&self) -> PathBuf {
        match self.kind {
            Kind::Exr => self.path.into(),
            Kind::Png => {
                let mut name = self.path.as_os_str().to_owned();
                name.push(".part.exr");
                name.into()
            }
        }
    }

    /// The film so far: to look at, and to continue.
    fn write_part(&self, film: &Film) -> Result<(), Failure> {
        write_exr(&self.part(), film, &self.meta, true)?;
        if self.kind == Kind::Png {
            write_png(self.path, film, self.tone)?;
        }
        Ok(())
    }

    fn write(&self, film: &Film, partial: bool) -> Result<(), Failure> {
        match self.kind {
            // What ended before its time says what it has, not what it was to have.
            Kind::Exr if !partial => {
                let samples = self.meta.samples.start..self.meta.samples.start + film.samples().1;
                let total = self.meta.total.min(samples.end);
                write_exr(self.path, film, &Meta { samples, total, ..self.meta.clone() }, false)?;
            }
            Kind::Exr => write_exr(self.path, film, &self.meta, true)?,
            Kind::Png => {
                write_png(self.path, film, self.tone)?;
                // Only a rendering that took long has left one.
                match std::fs::remove_file(self.part()) {
                    Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                        return Err(Failure::File(format!("{}: {error}", self.part().display())));
                    }
                    _ => {}
                }
            }
        }
        Ok(())
    }

    /// The film of an earlier rendering, or an empty film.
    fn resume(&self) -> Result<Film, Failure> {
        let part = self.part();
        if !part.exists() {
            return Ok(Film::new(self.meta.window));
        }
        let (film, meta) = read_partial(&part)?;
        let same = meta.scene == self.meta.scene
            && (meta.size, meta.window) == (self.meta.size, self.meta.window)
            && meta.samples.start == self.meta.samples.start;
        if !same {
            let message = format!(
                "{}: found a part of another picture, or of other pixels or samples of it; expected a part of this one",
                part.display()
            );
            return Err(Failure::Usage(message));
        }
        Ok(film)
    }
}
