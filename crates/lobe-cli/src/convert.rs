//! `lobe convert`: a measured material in another format.

use std::path::PathBuf;

use clap::ValueEnum;
use lobe::{Data, Lookup, Material, Options, Scatter, Side};
use lobe_files::check_output;
use lobe_formats::{Document, Format, convert};
use lobe_table::window::klems;

use crate::failure::Failure;
use crate::measure::{self, Sides};
use crate::message::say;
use crate::output::Output;
use crate::surface::MaterialSurface;
use crate::target::Target;

/// Convert a material to another format.
#[derive(clap::Args)]
#[command(
    after_help = "The format to write follows from the extension of OUT or from --to. If it has the representation of the file, knots and values are written unchanged. Otherwise the material is resampled, which is reported together with the error at sample directions. What the format cannot hold is refused.

Examples:
  lobe convert paint.ddr paint.ssdd                        the same table in another format
  lobe convert paint.ddr paint.bsdf --to rgl               for Mitsuba and pbrt, parameterisation included
  lobe convert cloth.ddr cloth.bsdf --to rgl --azimuths 49 finer
  lobe convert gold.binary gold.xml --basis half           Klems matrices for Radiance
  lobe convert paint.bsdf paint.npz                        for numpy.load
  lobe convert film.ssdd film.bsdf --to zemax --channel Y --scatter transmission

Grids of half and difference angles (MERL) are interpolated between the centres of their bins."
)]
pub struct Args {
    /// The file of a measured material.
    file: PathBuf,
    #[command(flatten)]
    output: Output,
    /// Which measurement of a sheet to write, if the file has both and the format holds one.
    #[arg(long, value_enum)]
    scatter: Option<ScatterKind>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ScatterKind {
    /// Both directions on one side.
    Reflection,
    /// The directions on opposite sides.
    Transmission,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let (target, out) = (args.output.target()?, args.output.out.as_path());
    check_output(out, &[&args.file])?;
    let (_, document) = lobe_formats::open(&args.file)?;
    let document = choose(document, target, args)?;
    let format = target.format;
    if let Some(written) = convert(&document, format, args.output.channel.as_deref(), out)? {
        let note = written.note.map(|note| format!("; {note}")).unwrap_or_default();
        say(format_args!("{}: {format}, the values and nodes of the file{note}", out.display()));
        return Ok(());
    }
    let sides = match document.only() {
        Some(Data::Mirror(_)) => {
            let message = format!("{format}: found mirror reflectances; expected values for pairs of directions");
            return Err(Failure::Usage(message));
        }
        Some(data) if !data.representation().is_two_sided() => Sides::One(data.representation().scatter()),
        _ => Sides::Both,
    };
    let scatter = match sides {
        Sides::One(scatter) => Some(scatter),
        Sides::Both => None,
    };
    if let Some(loss) = loss(&document, target) {
        say(format_args!("{}: {loss}", args.file.display()));
    }
    let options = Options { lookup: Lookup::Linear, ..Options::default() };
    let material = Material::from_document(&document, &options).map_err(|error| error.in_file(&args.file))?;
    measure::write(&MaterialSurface { material, scatter }, sides, &args.output)
}

/// What a table for one side leaves out of a document.
fn loss(document: &Document, target: Target) -> Option<&'static str> {
    let data = || document.parts.iter().map(|part| part.data.representation());
    if data().any(|data| data.is_polarised()) {
        return Some("polarised; only the intensity of unpolarised light is written");
    }
    if !data().all(|data| data.has_known_unit()) {
        return Some("the unit of the values is not documented; they are written as they are stored");
    }
    let is_sheet = document.is_sheet() || data().any(|data| data.is_two_sided());
    (is_sheet && target.writer.resampled_as != Ok(klems::KIND))
        .then_some("a sheet with two sides; one kind of scatter of light from z > 0 is written")
}

/// The one measurement of a sheet to write, if the target holds one.
fn choose(document: Document, target: Target, args: &Args) -> Result<Document, Failure> {
    let asked = args.scatter.map(|kind| match kind {
        ScatterKind::Reflection => Scatter::Reflection,
        ScatterKind::Transmission => Scatter::Transmission,
    });
    if !document.is_sheet() {
        return Ok(document);
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
            "{}: found no such measurement; expected what {} holds",
            args.file.display(),
            target.format
        ))),
        _ => Err(Failure::Usage(format!(
            "{}: found {} measurements; expected --scatter with the one to write",
            args.file.display(),
            candidates.len()
        ))),
    }
}
