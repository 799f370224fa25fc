//! `lobe convert`: a measured material in another format.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use lobe::{Aspect, Data, Lookup, Material, Options, Scatter, Side};
use lobe_files::{Files, check_output, in_memory};
use lobe_formats::{Document, Format, Part, convert};
use lobe_ops::certificate::{Certificate, Stated};
use lobe_ops::certify::Incomparable;
use lobe_ops::remeasure::{MaterialSurface, Sides};
use lobe_table::window::klems::AngleBasis;
use lobe_table::window::{self, Band, Block, Blocks, Component};
use lobe_table::{mueller, polarised};
use serde::Serialize;

use crate::certificate::{Source, report, split};
use crate::failure::Failure;
use crate::measure::{self, Job, Resampled, is_of_sheets};
use crate::message::{self, say};
use crate::output::{Output, side};
use crate::reading::Reading;
use crate::target::Target;

/// Convert a material to another format.
#[derive(clap::Args)]
#[command(
    after_help = "The extension of OUT, or --to, determines the format to write. If that format has the representation of the file, knots and values are written unchanged. Otherwise the material is resampled, and the nodes are reported together with the error that `lobe compare` finds; files of formats with comments keep both. --error refines the nodes until the relative error (root mean square) is met; if it cannot be, the exit code is 3 and no file is written. What the format cannot express is refused, and so is an option that would change nothing. Trees of WINDOW XML are written as trees, unless --to klems or --basis asks for matrices.

WINDOW XML keeps the bands of another WINDOW XML file, Solar among them. Of wavelengths from 400 to 700 nm and beyond, it holds the averages under D65 (CIE-X, Visible, CIE-Z) and, if the wavelengths reach over 95 % of direct sunlight (ASTM G173), that under sunlight (Solar); otherwise the reason is stated. Nothing else has a solar band.

Examples:
  lobe convert paint.ddr paint.ssdd                           the same table in another format
  lobe convert paint.ddr paint.bsdf --to rgl                  for Mitsuba and pbrt
  lobe convert cloth.ddr cloth.bsdf --to rgl --azimuths 49    finer
  lobe convert gold.binary gold.xml --basis half              Klems matrices for Radiance
  lobe convert paint.ddr tree.xml --basis tree3               a tensor tree
  lobe convert paint.bsdf fine.ddr --error 0.05               as fine as necessary
  lobe convert paint.ddr green.brdf --channel G               for Ansys Speos
  lobe convert paint.ddr lens.bsdf --to lighttools            for LightTools
  lobe convert paint.bsdf paint.npz                           for numpy.load
  lobe convert gold.mueller gold.csv --to mueller-csv         Mueller matrices as a table
  lobe convert paint.ddr green.pbsdf --channel G              for polarising renderers
  lobe convert film.ssdd film.bsdf --to zemax --channel G --scatter transmission

Grids of half and difference angles (MERL) are interpolated between the centres of their bins."
)]
pub struct Args {
    /// The file of a measured material.
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    output: Output,
    /// The measurement to write, if the file has both and the format holds one, or only one is wanted.
    #[arg(long, value_enum)]
    scatter: Option<ScatterKind>,
    /// The largest relative error (root mean square) of a resampled file: nodes are refined until it is met.
    #[arg(long, value_name = "SHARE", value_parser = bound)]
    error: Option<f64>,
    /// Print JSON: an object that describes the written file and its error.
    #[arg(long)]
    json: bool,
}

fn bound(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share: &f64| *share > 0.0 && share.is_finite());
    share.ok_or_else(|| format!("found `{text}`; expected a number above 0"))
}

/// The output of `--json`.
#[derive(Serialize)]
struct Answer {
    output: String,
    format: &'static str,
    /// The nodes in words; `None` if those of the file were written.
    resampled: Option<String>,
    /// How the channels were changed; `None` if they were not.
    note: Option<String>,
    /// The error as `lobe compare` prints it; `None` if nothing changed, or if it is unknown.
    error: Option<Certificate>,
    /// Why there is no error; `None` if there is one.
    no_error: Option<String>,
}

/// Why a file whose values were not resampled has no error.
const UNCHANGED: &str = "the values and nodes are those of the file";

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ScatterKind {
    /// Both directions on one side.
    Reflection,
    /// The directions on opposite sides.
    Transmission,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    check_output(&args.output.out, &[&args.file])?;
    let (_, document) = args.reading.open(&args.file)?;
    let answer = written(document, args)?;
    if args.json {
        let mut out = message::out(true);
        serde_json::to_writer_pretty(&mut out, &answer)?;
        writeln!(out)?;
        out.flush()?;
    }
    Ok(())
}

/// Writes a document that was read from a file as `lobe convert` does without further options.
pub fn write(file: &Path, document: Document, out: &Path, to: Option<Format>) -> Result<(), Failure> {
    let (output, reading) = (Output::new(out, to), Reading::default());
    written(document, &Args { file: file.into(), reading, output, scatter: None, error: None, json: false }).map(|_| ())
}

fn written(document: Document, args: &Args) -> Result<Answer, Failure> {
    let (target, out) = (args.output.target()?, args.output.out.as_path());
    let asked = args.scatter.map(|kind| match kind {
        ScatterKind::Reflection => Scatter::Reflection,
        ScatterKind::Transmission => Scatter::Transmission,
    });
    let document = choose(document, target, asked, args)?;
    let format = target.format;
    let answer = |resampled, note, stated: Option<Stated>| {
        let (error, no_error) = stated.map_or_else(|| (None, Some(UNCHANGED.into())), split);
        Answer { output: out.display().to_string(), format: format.spec().word, resampled, note, error, no_error }
    };
    let channel = args.output.channel.as_deref();
    if (target.writer.holds)(&document) && !asks_for_matrices(&document, args) {
        args.output.refuse_all()?;
        if let Some(Kept { note, stated }) = kept(&document, target, args)? {
            return Ok(answer(None, note, stated));
        }
    }
    let is_polarised = document.parts.iter().any(|part| part.data.representation().is_polarised());
    let keeps_matrices = is_polarised && matches!(target.writer.resampled_as, Ok(mueller::KIND | polarised::KIND));
    if keeps_matrices && channel.is_some() {
        let expected = "no such option: matrices are converted with all of their wavelengths";
        return Err(Failure::Usage(format!("{}: found --channel; expected {expected}", out.display())));
    }
    if let Some(Data::Mirror(_)) = document.only() {
        let message = format!("{format}: found mirror reflectances; expected values for pairs of directions");
        return Err(Failure::Usage(message));
    }
    let options = Options { lookup: Lookup::Linear, ..Options::default() };
    let material = Material::from_document(&document, &options).map_err(|error| error.in_file(&args.file))?;
    let sides = match document.only() {
        Some(data) if !data.representation().is_two_sided() => Sides::One(data.representation().scatter()),
        _ if is_of_sheets(target.writer.resampled_as) => Sides::Both,
        _ => Sides::One(one_of_both(&material, target, asked, args)?),
    };
    let scatter = match sides {
        Sides::One(scatter) => Some(scatter),
        Sides::Both => None,
    };
    if let Some(loss) = loss(&document, scatter).filter(|_| !keeps_matrices) {
        say(format_args!("{}: {loss}", args.file.display()));
    }
    let source = Source::new(&args.file, &document, target, channel);
    let surface = MaterialSurface { material, scatter };
    let job = Job {
        surface: &surface,
        sides,
        is_from_file: true,
        output: &args.output,
        source: source.as_ref(),
        bound: args.error,
    };
    let Resampled { nodes, note, stated } = measure::write(&job)?;
    let stated = stated.unwrap_or(Err(Incomparable::Aspects.into()));
    Ok(answer(Some(nodes), note, Some(stated)))
}

/// A file with the values and nodes of the source.
struct Kept {
    /// How the channels were changed; `None` if they were not.
    note: Option<String>,
    /// The error, if the values between the nodes differ.
    stated: Option<Stated>,
}

/// Writes the values and nodes of the file unchanged; `None` if the format cannot hold them. If the error is larger
/// than the bound, no file is written.
fn kept(document: &Document, target: Target, args: &Args) -> Result<Option<Kept>, Failure> {
    let (out, format, channel) = (args.output.out.as_path(), target.format, args.output.channel.as_deref());
    let written = || -> Result<Option<Kept>, Failure> {
        let Some(written) = convert(document, format, channel, out)? else { return Ok(None) };
        let mut kept = Kept { note: written.note, stated: None };
        if let Some(source) = Source::new(&args.file, document, target, channel) {
            kept.stated = source.certify_kept(format, out)?;
        }
        Ok(Some(kept))
    };
    if let Some(bound) = args.error {
        let (tried, _) = in_memory(Files::new(), written);
        match tried?.and_then(|kept| kept.stated) {
            Some(Ok(certificate)) if certificate.worst() > bound => {
                let (out, error) = (out.display(), certificate.worst());
                return Err(Failure::Check(format!(
                    "{out}: the error is {error:.3e}, more than {bound}; `lobe resample` makes a table with more nodes. No \
                     file was written"
                )));
            }
            Some(Err(why)) => return Err(measure::no_bound(out, &why)),
            _ => {}
        }
    }
    let Some(kept) = written()? else { return Ok(None) };
    let note = kept.note.as_ref().map(|note| format!("; {note}")).unwrap_or_default();
    say(format_args!("{}: {format}, with the values and nodes of the file{note}", out.display()));
    if let Some(stated) = &kept.stated {
        say("  between the nodes, the file is interpolated differently");
        report(stated);
    }
    Ok(Some(kept))
}

/// The parts of a document that a table for one side leaves out.
fn loss(document: &Document, written: Option<Scatter>) -> Option<String> {
    let data = || document.parts.iter().map(|part| part.data.representation());
    if data().any(|data| data.is_polarised()) {
        return Some(
            "polarised; only the intensity of unpolarised light is written (--to mueller-csv writes matrices)".into(),
        );
    }
    if !data().all(|data| data.has_known_unit()) {
        return Some("the unit of the values is not documented; they are written as they are stored".into());
    }
    let is_sheet = document.is_sheet() || data().any(|data| data.is_two_sided());
    let written = written.filter(|_| is_sheet)?;
    Some(format!("a sheet with two sides; the {} of light from the front is written", side(written)))
}

/// `true` if trees of a WINDOW file should be written as matrices, or matrices on other patches.
fn asks_for_matrices(document: &Document, args: &Args) -> bool {
    let Some(Data::Window(window)) = document.only() else { return false };
    let mut components =
        window.bands.iter().flat_map(|band| Block::ALL.into_iter().filter_map(|block| band.window.block(block)));
    let is_asked = args.output.to == Some(Format::WindowXml) || args.output.basis.is_some();
    let wanted = args.output.basis;
    let has = |basis: &AngleBasis, wanted: &AngleBasis| basis.rings() == wanted.rings();
    is_asked
        && components.any(|component| match (component, wanted.map(|wanted| (wanted.patches(), wanted.rank()))) {
            (Component::Tree(tree), Some((None, rank))) => rank != Some(tree.rank()),
            (Component::Tree(_), _) => true,
            (Component::Klems(_), None) => false,
            (Component::Klems(matrix), Some((Some(patches), _))) => {
                !has(matrix.incident(), &patches) || !has(matrix.exit(), &patches)
            }
            (Component::Klems(_), Some((None, _))) => true,
        })
}

/// The scatter of a sheet that is written, for light from the front.
fn one_of_both(material: &Material, target: Target, asked: Option<Scatter>, args: &Args) -> Result<Scatter, Failure> {
    let held = [Scatter::Reflection, Scatter::Transmission].map(Aspect::front);
    let held: Vec<Scatter> =
        held.into_iter().filter(|&aspect| material.holds(aspect)).map(|aspect| aspect.scatter).collect();
    let wanted = asked.or((target.writer.scatter)(&args.output.out)).or(held.first().copied());
    match wanted {
        Some(wanted) if held.contains(&wanted) => Ok(wanted),
        wanted => {
            let found: Vec<&str> = held.iter().map(|&scatter| side(scatter)).collect();
            let found = if found.is_empty() { "no light from the front".into() } else { found.join(" and ") };
            let expected = wanted.map_or("reflection or transmission", side);
            let message =
                format!("{}: found {found}; expected {expected} of light from the front", args.file.display());
            Err(Failure::Usage(message))
        }
    }
}

/// The one measurement of a sheet to write, if the target holds only one or one is requested.
fn choose(document: Document, target: Target, asked: Option<Scatter>, args: &Args) -> Result<Document, Failure> {
    if let Some(data) = document.only() {
        return match (data, asked) {
            (Data::Window(window), Some(asked)) => {
                let kept = blocks_of(window, asked);
                if kept.bands.is_empty() {
                    let message = format!("{}: found no {}; expected it in the file", args.file.display(), side(asked));
                    return Err(Failure::Usage(message));
                }
                Ok(Document { parts: vec![Part::new("", kept)], ..document.clone() })
            }
            (data, Some(asked)) if data.representation().scatter() != asked => {
                let found = side(data.representation().scatter());
                let message = format!("{}: found {found} only; expected {}", args.file.display(), side(asked));
                Err(Failure::Usage(message))
            }
            _ => Ok(document),
        };
    }
    if asked.is_none() && target.writer.holds_sheets {
        return Ok(document);
    }
    let wanted = asked.or((target.writer.scatter)(&args.output.out));
    let is_delta = target.format == Format::Sdr;
    let fits = |data: &&Data| {
        let data = data.representation();
        data.is_delta() == is_delta && wanted.is_none_or(|wanted| data.scatter() == wanted)
    };
    let front = document.parts.iter().filter(|part| part.side != Some(Side::Back));
    let candidates: Vec<&Data> = front.map(|part| &part.data).filter(fits).collect();
    match candidates[..] {
        [data] => {
            if document.parts.len() > 1 {
                let parts = document.parts.len();
                say(format_args!("{}: one of {parts} measurements of a sheet", args.file.display()));
            }
            Ok(Document::new(data.clone()))
        }
        [] => Err(Failure::Usage(format!(
            "{}: found no such measurement; expected one that {} holds",
            args.file.display(),
            target.format
        ))),
        _ => Err(Failure::Usage(format!(
            "{}: found {} measurements; expected --scatter to choose one",
            args.file.display(),
            candidates.len()
        ))),
    }
}

/// The blocks with one scatter, in the bands that have any.
fn blocks_of(window: &window::Data, scatter: Scatter) -> window::Data {
    let mut kept = window::Data::default();
    for band in &window.bands {
        let mut blocks = Blocks::default();
        let mut is_empty = true;
        for block in Block::ALL.into_iter().filter(|block| block.aspect().scatter == scatter) {
            if let Some(component) = band.window.block(block) {
                blocks.set(block, component.clone());
                is_empty = false;
            }
        }
        if !is_empty {
            kept.bands.push(Band { wavelength: band.wavelength.clone(), window: blocks });
        }
    }
    kept
}
