//! `lobe plot`: figures of a material, of several, or of a picture.

mod bar;
mod picture;

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use lobe::{Bsdf as _, Side};
use lobe_files::check_output;
use lobe_formats::{Document, Format, write_whole};
use lobe_ops::compare::spheres;
use lobe_ops::describe::{Part, describe};
use lobe_plot::{
    DrawError, Facts, Figure, Fitted, Page, Quantity, Scaling, Shown, Subject, View, ViewError, draw, page_with_fit,
    rasterise,
};

use self::bar::Bar;
use crate::failure::Failure;
use crate::guesses::warn_of_guesses;
use crate::info::picture::is_picture;
use crate::measure::integrates;
use crate::message;
use crate::picture::parse_exposure;
use crate::reading::Reading;

/// Draw materials: curves in the plane of incidence, channels, spectra, slices of the hemisphere, lit spheres,
/// polarisation, or a page of them all; or draw a picture of spectra or of polarised light.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe plot cloth.ddr -o cloth.html                         a page with everything, in one file
  lobe plot paint.bsdf -o paint.svg                         curves in the plane of incidence
  lobe plot paint.bsdf paint.ddr -o both.html               two files in the same figures
  lobe plot paint.bsdf -o lobes.png --kind polar --width 1200
  lobe plot film.csv -o film.svg --kind spectra --sigma 20,60 --theta 20,0,-20
  lobe plot screen.xml -o slices.svg --kind slices --sigma 0,40,60 --channel Visible --side back
  lobe plot cloth.ddr -o warp.png --kind sphere --psi 90
  lobe plot gold.mueller -o gold.svg --kind mueller --channel 550nm
  lobe plot paint.ddr --fit fit.json -o fit.html            where a fit of `lobe fit` fails
  lobe plot glass.exr -o glass.html --at 120,80             a picture of polarised light

The extension of OUT determines what is written: .html is a page, .svg or .png a figure. In every figure, the light is on the left, viewing angles are positive on the side of the mirror direction, and f is in 1/sr, without the cosine. Dots are measured points; dashed lines are extrapolated. Browsers show the value at the pointer.")]
pub struct Args {
    /// The files of measured BRDFs or BTDFs; several files are drawn into the same figures. Or an OpenEXR picture of
    /// spectra or of polarised light.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    /// The file to write: .html, .svg or .png. An existing one is replaced.
    #[arg(short, long)]
    out: PathBuf,
    /// The figure to draw; by default a page in .html, and curves in .svg and .png.
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// Logarithmic values.
    #[arg(long, conflicts_with = "linear")]
    log: bool,
    /// Linear values. By default, curves and slices are logarithmic, spectra are linear, and lobes are logarithmic if
    /// their peaks differ greatly.
    #[arg(long)]
    linear: bool,
    /// Polar angles of the light in degrees; by default knots of the measurement.
    #[arg(long, value_name = "DEG,DEG", value_delimiter = ',', value_parser = parse_sigma)]
    sigma: Vec<f64>,
    /// Viewing angles of spectra in degrees; by default some about the mirror direction.
    #[arg(long, value_name = "DEG,DEG", value_delimiter = ',', allow_hyphen_values = true, value_parser = parse_theta)]
    theta: Vec<f64>,
    /// Azimuth of the light in degrees; by default the first knot.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = parse_angle)]
    psi: Option<f64>,
    /// The side from which the light comes; by default the front, if it has values.
    #[arg(long, value_enum)]
    side: Option<LightSide>,
    /// Draw this channel, by the name that `lobe info` shows; by default the luminance, and spheres in colour.
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// A fit of the file, written by `lobe fit -o FIT.json`: the page shows where it fails.
    #[arg(long, value_name = "FIT")]
    fit: Option<PathBuf>,
    /// Pixels of a picture whose spectra are drawn, by column and row from the upper left; by default some in the middle
    /// row.
    #[arg(long, value_name = "X,Y", value_parser = picture::parse_point)]
    at: Vec<picture::Point>,
    /// The exposure of a picture in stops; by default it is fitted to the picture.
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true, value_parser = parse_exposure)]
    exposure: Option<f32>,
    /// The width of a figure in pixels. Below 560, it is laid out for a narrow column.
    #[arg(long, default_value_t = 960, value_parser = clap::value_parser!(u32).range(100..=8000))]
    width: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// All figures, the facts about the file, the findings of the checks, and the albedo.
    Page,
    /// f against the viewing angle in the plane of incidence.
    Curves,
    /// The same for each channel of one file.
    Channels,
    /// f against the wavelength, at several viewing angles, of one file.
    Spectra,
    /// f as lobes about the point of incidence.
    Polar,
    /// All outgoing directions of each incidence, as disks.
    Slices,
    /// Spheres of the material under several lights.
    Sphere,
    /// All elements of the Mueller matrices of a polarised file, in the plane of incidence.
    Mueller,
    /// Degree and angle of the linear polarisation of what unpolarised light becomes, of a polarised file.
    Polarisation,
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

/// The contents of a file to write.
#[derive(Clone, Copy)]
enum Target {
    Page,
    Svg(Figure),
    Png(Figure),
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let target = target(&args.out, args.kind)?;
    check_output(&args.out, &args.files.iter().chain(&args.fit).collect::<Vec<_>>())?;
    if args.files.iter().any(|file| is_picture(file)) {
        return picture::run(args, target);
    }
    refuse_idle(args, target)?;
    let mut subjects = Vec::new();
    let mut tables = Vec::new();
    for file in &args.files {
        let (format, document) = args.reading.open(file)?;
        warn_of_guesses(file, &document);
        if matches!(target, Target::Page) {
            tables.push(facts(file, format.name(), &document)?);
        }
        let subject = Subject::new(file, format, document)?;
        integrates(file, subject.material().channel_count())?;
        subjects.push(subject.named(&name(file, &args.files)));
    }
    let views = views(args, &subjects)?;
    let shown: Vec<Shown<'_>> = subjects.iter().zip(&views).map(|(subject, view)| Shown { subject, view }).collect();
    let wrong = |error: DrawError| Failure::Usage(format!("{}: {error}", args.files[0].display()));
    let fitted = fitted(args, target, &shown)?;
    let Content { bytes, what, said } = content(target, &shown, &tables, fitted.as_ref(), &args.out)?.map_err(wrong)?;
    write_whole(&args.out, &bytes)?;
    let said: String = said.iter().map(|said| format!("; {said}")).collect();
    let mut out = message::out(false);
    writeln!(out, "{}: {what}, {} bytes{said}", args.out.display(), bytes.len())?;
    Ok(out.flush()?)
}

/// The name of a file, or its path if another one has the same name.
fn name(file: &Path, all: &[PathBuf]) -> String {
    let name = |file: &Path| file.file_name().map(|name| name.to_string_lossy().into_owned());
    let own = name(file);
    let is_unique = all.iter().filter(|other| name(other) == own).count() < 2;
    own.filter(|_| is_unique).unwrap_or_else(|| file.display().to_string())
}

/// Draws a document that was read from a file as `lobe plot` does without further options.
pub fn write(file: &Path, format: Format, document: &Document, out: &Path) -> Result<(), Failure> {
    let target = target(out, None)?;
    let tables = [facts(file, format.name(), document)?];
    let subject = Subject::new(file, format, document.clone())?;
    let shown = [Shown { subject: &subject, view: &View::new(&subject) }];
    let wrong = |error: DrawError| Failure::Usage(format!("{}: {error}", file.display()));
    let Content { bytes, .. } = content(target, &shown, &tables, None, out)?.map_err(wrong)?;
    Ok(write_whole(out, &bytes)?)
}

/// The contents of a file to write, and remarks about it.
struct Content {
    bytes: Vec<u8>,
    what: String,
    said: Vec<String>,
}

/// The inner error concerns what is drawn, the outer one writing it.
fn content(
    target: Target,
    shown: &[Shown<'_>],
    tables: &[Vec<Facts>],
    fitted: Option<&Fitted<'_>>,
    out: &Path,
) -> Result<Result<Content, DrawError>, Failure> {
    let bar = Bar::new();
    let figure = match target {
        Target::Page => {
            let Page { html, figures, said } = page_with_fit(shown, tables, fitted, &bar);
            return Ok(Ok(Content { bytes: html.into_bytes(), what: format!("a page of {figures} figures"), said }));
        }
        Target::Svg(figure) | Target::Png(figure) => figure,
    };
    let drawing = match draw(shown, figure, &bar) {
        Ok(drawing) => drawing,
        Err(error) => return Ok(Err(error)),
    };
    let width = shown.first().map_or(0, |first| first.view.width);
    let bytes = match target {
        Target::Png(_) => {
            rasterise(&drawing.svg, width).map_err(|error| Failure::File(format!("{}: {error}", out.display())))?
        }
        _ => drawing.svg.into_bytes(),
    };
    Ok(Ok(Content { bytes, what: format!("{figure}, {width} pixels wide"), said: drawing.said }))
}

/// The width of the spheres of a fit and its file, in pixels.
const PIXELS: usize = 256;

/// The fit to show with the only file.
fn fitted<'a>(args: &Args, target: Target, shown: &[Shown<'_>]) -> Result<Option<Fitted<'a>>, Failure> {
    let Some(file) = &args.fit else { return Ok(None) };
    let refuse = |found: String, expected: &str| {
        Err(Failure::Usage(format!("{}: found {found}; expected {expected}", file.display())))
    };
    let [Shown { subject, view }] = shown else {
        return refuse(format!("a fit with {} files", shown.len()), "the file that was fitted");
    };
    if !matches!(target, Target::Page) {
        return refuse("a fit with a figure".into(), "a page, .html, to show it on");
    }
    let text = String::from_utf8_lossy(&lobe_files::read(file)?).into_owned();
    let saved = lobe_fit::output::read(&text).map_err(|error| Failure::File(format!("{}: {error}", file.display())))?;
    let aspect = saved.aspect();
    if aspect.light != view.side || !subject.scatters(view.side).contains(&aspect.scatter) {
        return refuse(format!("a fit of {aspect}"), "one of what is shown (--side chooses the light)");
    }
    let material = subject.material().channels();
    let names = material.names();
    let modelled = saved.fitted.channels().clone();
    let at = |name: &str| names.iter().position(|known| known == name);
    let (measured, modelled) = match (&saved.channels[..], &args.channel) {
        ([one], _) if names.len() > 1 => match at(one) {
            Some(index) => (Quantity::channel(material, index), Quantity::channel(&modelled, 0)),
            None => return refuse(format!("a fit of the channel {one}"), &format!("one of {}", names.join(", "))),
        },
        (same, Some(name)) if same == names => match names.iter().position(|known| known.eq_ignore_ascii_case(name)) {
            Some(index) => (Quantity::channel(material, index), Quantity::channel(&modelled, index)),
            None => (Quantity::of(material), Quantity::of(material)),
        },
        (same, None) if same == names => (Quantity::of(material), Quantity::of(material)),
        // A fit of linear sRGB: the luminance of both.
        (rgb, None) if rgb == ["R", "G", "B"] && Quantity::of(material).name == "luminance" => {
            (Quantity::of(material), Quantity::of(&modelled))
        }
        (other, _) => {
            return refuse(format!("a fit of the channels {}", other.join(" ")), &format!("of {}", names.join(" ")));
        }
    };
    let facts = vec![Facts { title: "The fit".into(), rows: saved.facts.clone() }];
    let (fitted, channels) = (saved.fitted, saved.channels.len());
    // A channel, or the plane of incidence alone, has no appearance.
    let is_whole = !subject.measured().is_in_plane(aspect) && (channels > 1 || names.len() == 1);
    let spheres = is_whole.then(|| spheres(subject.material(), &fitted, aspect, PIXELS).ok()).flatten();
    let f = Box::new(move |wi: [f64; 3], wo: [f64; 3], out: &mut [f64]| fitted.f(wi, wo, out));
    Ok(Some(Fitted { scatter: aspect.scatter, channels, modelled, measured, f, facts, spheres }))
}

/// The extension and the kind must agree.
fn target(out: &Path, kind: Option<Kind>) -> Result<Target, Failure> {
    let extension = out.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let figure = match kind {
        Some(Kind::Page) => None,
        Some(Kind::Curves) | None => Some(Figure::Curves),
        Some(Kind::Channels) => Some(Figure::Channels),
        Some(Kind::Spectra) => Some(Figure::Spectra),
        Some(Kind::Polar) => Some(Figure::Polar),
        Some(Kind::Slices) => Some(Figure::Slices),
        Some(Kind::Sphere) => Some(Figure::Sphere),
        Some(Kind::Mueller) => Some(Figure::Mueller),
        Some(Kind::Polarisation) => Some(Figure::Polarisation),
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

/// Refuses options that have no effect: those of pictures, and those of lights and scales on spheres, which have their
/// own.
fn refuse_idle(args: &Args, target: Target) -> Result<(), Failure> {
    let refuse = |file: &Path, name: &str, purpose: &str, expected: &str| {
        let file = file.display();
        Err(Failure::Usage(format!("{file}: found {name}, which is for {purpose}; expected {expected}")))
    };
    // Spectra are drawn by themselves or on a page.
    let has_spectra = matches!((args.kind, target), (Some(Kind::Page | Kind::Spectra), _) | (None, Target::Page));
    let of_pictures = [("--at", !args.at.is_empty()), ("--exposure", args.exposure.is_some())];
    let of_figures = [("--log", args.log), ("--linear", args.linear), ("--sigma", !args.sigma.is_empty())];
    let found = |given: &[(&'static str, bool)]| given.iter().find(|(_, is_given)| *is_given).map(|(name, _)| *name);
    if let Some(name) = found(&of_pictures) {
        return refuse(&args.files[0], name, "pictures", "an OpenEXR picture");
    }
    if !args.theta.is_empty() && !has_spectra {
        return refuse(&args.out, "--theta", "spectra", "--kind spectra, or a page");
    }
    match found(&of_figures).filter(|_| args.kind == Some(Kind::Sphere)) {
        Some(name) => refuse(&args.out, name, "curves, lobes and slices", "no option that has no effect on spheres"),
        None => Ok(()),
    }
}

/// The view of each material, with the same light for all.
fn views(args: &Args, subjects: &[Subject]) -> Result<Vec<View>, Failure> {
    let mut views: Vec<View> = Vec::new();
    for (subject, file) in subjects.iter().zip(&args.files) {
        let wrong = |error: ViewError| Failure::Usage(format!("{}: {error}", file.display()));
        let mut view = View { width: args.width, ..View::new(subject) };
        let side = match args.side {
            Some(LightSide::Front) => Some(Side::Front),
            Some(LightSide::Back) => Some(Side::Back),
            None => views.first().map(|first| first.side),
        };
        if let Some(side) = side {
            view = view.lit_from(subject, side).map_err(wrong)?;
        }
        if let Some(name) = &args.channel {
            view = view.channel(subject, name).map_err(wrong)?;
        }
        view.psi = args.psi.map(f64::to_radians).or(views.first().map(|first| first.psi)).unwrap_or(view.psi);
        view.scaling = match (args.log, args.linear) {
            (true, _) => Some(Scaling::Log),
            (_, true) => Some(Scaling::Linear),
            _ => None,
        };
        view.sigmas = args.sigma.iter().map(|sigma| sigma.to_radians()).collect();
        view.sigmas.sort_by(f64::total_cmp);
        view.sigmas.dedup();
        view.thetas = args.theta.iter().map(|theta| theta.to_radians()).collect();
        views.push(view);
    }
    Ok(views)
}

/// The facts of `lobe info`, as tables.
fn facts(file: &Path, format: &str, document: &Document) -> Result<Vec<Facts>, Failure> {
    let row = |name: &str, value: String| (String::from(name), value);
    let mut rows = vec![row("format", format.into())];
    // A folder and standard input have no size.
    if let Some(metadata) = std::fs::metadata(file).ok().filter(std::fs::Metadata::is_file) {
        rows.push(row("file", format!("{} bytes", metadata.len())));
    }
    rows.extend(document.notes.iter().map(|note| row("read as", note.clone())));
    rows.extend(document.doubts.iter().map(|doubt| row("doubtful", doubt.clone())));
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

fn parse_theta(text: &str) -> Result<f64, String> {
    let theta = parse_angle(text)?;
    match theta.abs() < 90.0 {
        true => Ok(theta),
        false => Err(format!("found {theta}; expected more than -90 and less than 90 degrees")),
    }
}

fn parse_sigma(text: &str) -> Result<f64, String> {
    let sigma = parse_angle(text)?;
    match (0.0..90.0).contains(&sigma) {
        true => Ok(sigma),
        false => Err(format!("found {sigma}; expected 0 or more and less than 90 degrees")),
    }
}
