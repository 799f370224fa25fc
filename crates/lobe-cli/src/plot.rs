//! `lobe plot`: figures of a material.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lobe::Side;
use lobe_files::check_output;
use lobe_formats::{Document, open, write_whole};
use lobe_plot::{Facts, Figure, Progress, Scaling, Subject, View, ViewError, draw, page, rasterise};

use crate::describe::{Part, describe};
use crate::failure::Failure;
use crate::guesses::warn_of_guesses;

/// Draw a material: curves in the plane of incidence, slices of the hemisphere, lit spheres, or a page of them all.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe plot cloth.ddr -o cloth.html                         a page with everything, in one file
  lobe plot paint.bsdf -o paint.svg                         curves in the plane of incidence
  lobe plot paint.bsdf -o lobes.png --kind polar --width 1200
  lobe plot screen.xml -o slices.svg --kind slices --sigma 0,40,60 --channel Visible --side back
  lobe plot cloth.ddr -o warp.png --kind sphere --psi 90

The extension of OUT says what is written: .html a page, .svg or .png a figure. In every figure the light is on the left,
angles of view are positive on the side of the mirror direction, and f is in 1/sr, without the cosine.")]
pub struct Args {
    /// The file of a measured BRDF or BTDF.
    file: PathBuf,
    /// The file to write: .html, .svg or .png. An existing one is replaced.
    #[arg(short, long)]
    out: PathBuf,
    /// What to draw; by default a page in .html and curves in .svg and .png.
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// Logarithmic values.
    #[arg(long, conflicts_with = "linear")]
    log: bool,
    /// Linear values. By default curves and slices are logarithmic, and lobes if their peaks differ much.
    #[arg(long)]
    linear: bool,
    /// Polar angles of the light in degrees; by default knots of the measurement.
    #[arg(long, value_name = "DEG,DEG", value_delimiter = ',', value_parser = parse_sigma)]
    sigma: Vec<f64>,
    /// Azimuth of the light in degrees; by default that of the first knot.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = parse_angle)]
    psi: Option<f64>,
    /// The side from which the light comes; by default the front, if there are values.
    #[arg(long, value_enum)]
    side: Option<LightSide>,
    /// Draw this channel, by the name that `lobe info` shows; by default the luminance, and spheres in colour.
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// The width of a figure in pixels.
    #[arg(long, default_value_t = 960, value_parser = clap::value_parser!(u32).range(100..=8000))]
    width: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// All figures, what is known about the file, and the albedo.
    Page,
    /// f against the angle of view in the plane of incidence.
    Curves,
    /// The same as lobes about the point of incidence.
    Polar,
    /// All outgoing directions of each incidence, as disks.
    Slices,
    /// Spheres of the material under several lights.
    Sphere,
}

#[derive(Clone, Copy, ValueEnum)]
enum LightSide {
    /// z > 0
    #[value(alias = "above")]
    Front,
    /// z < 0
    #[value(alias = "below")]
    Back,
}

/// What a file will contain.
enum Target {
    Page,
    Svg(Figure),
    Png(Figure),
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let target = target(&args.out, args.kind)?;
    check_output(&args.out, &[&args.file])?;
    refuse_idle(args)?;
    let (format, document) = open(&args.file)?;
    warn_of_guesses(&args.file, &document);
    let facts = match target {
        Target::Page => facts(&args.file, format.name(), &document)?,
        _ => Vec::new(),
    };
    let subject = Subject::new(&args.file, format, document)?;
    let view = view(args, &subject)?;
    let bar = Bar::new();
    let content = match target {
        Target::Page => page(&subject, &view, &facts, &bar).into_bytes(),
        Target::Svg(figure) => draw(&subject, &view, figure, &bar).into_bytes(),
        Target::Png(figure) => {
            let svg = draw(&subject, &view, figure, &bar);
            rasterise(&svg, args.width).map_err(|error| Failure::File(format!("{}: {error}", args.out.display())))?
        }
    };
    Ok(write_whole(&args.out, &content)?)
}

/// The extension and the kind must agree.
fn target(out: &Path, kind: Option<Kind>) -> Result<Target, Failure> {
    let extension = out.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let figure = match kind {
        Some(Kind::Page) => None,
        Some(Kind::Curves) | None => Some(Figure::Curves),
        Some(Kind::Polar) => Some(Figure::Polar),
        Some(Kind::Slices) => Some(Figure::Slices),
        Some(Kind::Sphere) => Some(Figure::Sphere),
    };
    let usage = |found: &str, expected: &str| {
        Err(Failure::Usage(format!("{}: found {found}; expected {expected}", out.display())))
    };
    match (extension.as_deref(), figure) {
        (Some("html" | "htm"), _) if kind.is_none_or(|kind| kind == Kind::Page) => Ok(Target::Page),
        (Some("html" | "htm"), _) => usage("a figure in .html", "--kind page, or .svg or .png"),
        (Some("svg"), Some(figure)) => Ok(Target::Svg(figure)),
        (Some("png"), Some(figure)) => Ok(Target::Png(figure)),
        (Some("svg" | "png"), None) => usage("a page in a picture", "a file in .html"),
        (Some(other), _) => usage(&format!("the extension .{other}"), ".html, .svg or .png"),
        (None, _) => usage("no extension", ".html, .svg or .png"),
    }
}

/// Refuses options that change nothing in spheres, which have lights and a scale of their own.
fn refuse_idle(args: &Args) -> Result<(), Failure> {
    let given = [("--log", args.log), ("--linear", args.linear), ("--sigma", !args.sigma.is_empty())];
    let found = given.into_iter().find(|(_, is_given)| *is_given && args.kind == Some(Kind::Sphere));
    match found {
        Some((name, _)) => Err(Failure::Usage(format!(
            "{}: found {name}, which is for curves, lobes and slices; expected no option that changes nothing in spheres",
            args.out.display()
        ))),
        None => Ok(()),
    }
}

fn view(args: &Args, subject: &Subject) -> Result<View, Failure> {
    let wrong = |error: ViewError| Failure::Usage(format!("{}: {error}", args.file.display()));
    let mut view = View { width: args.width, ..View::new(subject) };
    if let Some(side) = args.side {
        let side = match side {
            LightSide::Front => Side::Front,
            LightSide::Back => Side::Back,
        };
        view = view.lit_from(subject, side).map_err(wrong)?;
    }
    if let Some(name) = &args.channel {
        view = view.channel(subject, name).map_err(wrong)?;
    }
    if let Some(psi) = args.psi {
        view.psi = psi.to_radians();
    }
    view.scaling = match (args.log, args.linear) {
        (true, _) => Some(Scaling::Log),
        (_, true) => Some(Scaling::Linear),
        _ => None,
    };
    view.sigmas = args.sigma.iter().map(|sigma| sigma.to_radians()).collect();
    view.sigmas.sort_by(f64::total_cmp);
    view.sigmas.dedup();
    Ok(view)
}

/// What `lobe info` says, as tables.
fn facts(file: &Path, format: &str, document: &Document) -> Result<Vec<Facts>, Failure> {
    let row = |name: &str, value: String| (String::from(name), value);
    let mut rows = vec![row("format", format.into())];
    // A folder and the standard input have none.
    if let Some(metadata) = std::fs::metadata(file).ok().filter(std::fs::Metadata::is_file) {
        rows.push(row("file", format!("{} bytes", metadata.len())));
    }
    rows.extend(document.source.iter().cloned());
    let mut tables = vec![Facts { title: "The file".into(), rows }];
    tables.extend(describe(document).iter().map(part));
    Ok(tables)
}

fn part(part: &Part) -> Facts {
    let title = if part.name.is_empty() { "Grid and values".into() } else { part.name.clone() };
    Facts { title, rows: part.rows().into_iter().map(|(name, value)| (name.into(), value)).collect() }
}

fn parse_angle(text: &str) -> Result<f64, String> {
    let angle: Option<f64> = text.trim().parse().ok();
    angle.filter(|angle| angle.is_finite()).ok_or_else(|| format!("found `{text}`; expected an angle in degrees"))
}

fn parse_sigma(text: &str) -> Result<f64, String> {
    let sigma = parse_angle(text)?;
    match (0.0..90.0).contains(&sigma) {
        true => Ok(sigma),
        false => Err(format!("found {sigma}; expected 0 or more and less than 90 degrees")),
    }
}

/// A bar on standard error, if that is a terminal, once a second has passed.
struct Bar(ProgressBar);

/// Work that takes less than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

impl Bar {
    fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg:8} {bar:40} {percent:>3} % {eta} left") {
            bar.set_style(style);
        }
        Bar(bar)
    }
}

impl Progress for Bar {
    fn begin(&self, figure: &str, pairs: u64) {
        self.0.set_message(figure.to_string());
        self.0.set_length(pairs);
        self.0.set_position(0);
    }

    fn advance(&self, pairs: u64) {
        if self.0.is_hidden() && self.0.elapsed() > PATIENCE {
            self.0.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.0.inc(pairs);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
