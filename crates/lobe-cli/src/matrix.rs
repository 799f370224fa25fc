//! `lobe matrix`: products of matrices of views, transmission, daylight and skies.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use lobe_files::check_output;
use lobe_formats::window_xml;
use lobe_ops::daylight::{self, Format, Matrix, Shapes, product, transmission};

use crate::failure::Failure;
use crate::message::{self, say};

/// Multiply matrices of a view, transmission and daylight for a sky, as Radiance's dctimestep does.
#[derive(clap::Args)]
#[command(
    after_help = "Each matrix is a Radiance matrix file (NROWS, NCOLS and NCOMP in its header; ascii, float or double). The transmission may also be a WINDOW XML file with Klems matrices. A sky without a header has one row per patch. Each component is multiplied separately.

Of a WINDOW file, the Visible band is used for light that arrives at its front, with CIE-X and CIE-Z for colour if it has them. Convert tensor trees with `lobe convert --to klems --basis full` first.

Examples:
  lobe matrix v.mtx t.xml d.mtx s.mtx                   three-phase method, for each hour
  lobe matrix d.mtx s.mtx -o lit.mtx --format float     two-phase method
  lobe matrix v.mtx t.xml d.mtx s.mtx --minus vd.mtx,t.xml,dd.mtx,s.mtx --plus c.mtx,sun.mtx

The last example is the five-phase method."
)]
pub struct Args {
    /// The factors, from left to right.
    #[arg(required = true)]
    factors: Vec<PathBuf>,
    /// The file to write; by default the product is printed as text.
    #[arg(long, short, value_name = "OUT")]
    out: Option<PathBuf>,
    /// How numbers are written.
    #[arg(long, value_enum, default_value = "ascii", requires = "out")]
    format: NumberFormat,
    /// Add another product, of files separated by commas.
    #[arg(long, value_name = "LIST")]
    plus: Vec<String>,
    /// Subtract another product.
    #[arg(long, value_name = "LIST")]
    minus: Vec<String>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum NumberFormat {
    /// Text.
    Ascii,
    /// 32-bit floats.
    Float,
    /// 64-bit floats.
    Double,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let split = |list: &String| list.split(',').map(PathBuf::from).collect::<Vec<_>>();
    let others: Vec<(f64, Vec<PathBuf>)> = [(1.0, &args.plus), (-1.0, &args.minus)]
        .into_iter()
        .flat_map(|(sign, lists)| lists.iter().map(move |list| (sign, split(list))))
        .collect();
    if let Some(out) = &args.out {
        let inputs: Vec<&PathBuf> = args.factors.iter().chain(others.iter().flat_map(|(_, files)| files)).collect();
        check_output(out, &inputs)?;
    }
    let mut result = multiplied(&args.factors)?;
    for (sign, files) in &others {
        let other = multiplied(files)?;
        let [a, b] = [&result, &other].map(shape);
        result = result.plus(&other, *sign).ok_or_else(|| {
            let (first, second) = (names(&args.factors), names(files));
            Failure::Usage(format!("{second}: found {b}; expected {a}, like the product of {first}"))
        })?;
    }
    let format = match args.format {
        NumberFormat::Ascii => Format::Ascii,
        NumberFormat::Float => Format::Float,
        NumberFormat::Double => Format::Double,
    };
    let made_by = format!("lobe matrix {}", names(&args.factors));
    match &args.out {
        Some(out) => {
            daylight::write(&result, format, &made_by, out)?;
            say(format_args!("{}: {}", out.display(), shape(&result)));
        }
        None => {
            let mut out = message::out(false);
            out.write_all(&daylight::to_bytes(&result, format, &made_by))?;
            out.flush()?;
        }
    }
    Ok(())
}

fn names(files: &[PathBuf]) -> String {
    files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(" ")
}

fn shape(matrix: &Matrix) -> String {
    let [rows, columns, components] = matrix.shape();
    let words = if components == 1 { "component" } else { "components" };
    format!("{rows} rows x {columns} columns of {components} {words}")
}

fn multiplied(files: &[PathBuf]) -> Result<Matrix, Failure> {
    let matrices = files.iter().map(|file| matrix(file)).collect::<Result<Vec<_>, _>>()?;
    product(&matrices).map_err(|error| {
        let shown = |index: usize| format!("{} ({})", files[index].display(), shape(&matrices[index]));
        Failure::Usage(match error {
            Shapes::Inner { index, columns, rows } => {
                format!("{}, after {}: found {rows} rows; expected {columns}", shown(index + 1), shown(index))
            }
            Shapes::Components { index, found, expected } => {
                format!("{}: found {found} components; expected 1 or {expected}, as before", shown(index))
            }
            Shapes::Empty => error.to_string(),
        })
    })
}

/// Reads a Radiance matrix, or the transmission of a WINDOW file.
fn matrix(file: &Path) -> Result<Matrix, Failure> {
    let bytes = lobe_files::read(file)?;
    if !window_xml::matches(&bytes) {
        return Ok(daylight::read(&bytes, file)?);
    }
    let measured = window_xml::read(&bytes, file)?;
    transmission(&measured.data).map_err(|error| Failure::Usage(format!("{}: found {error}", file.display())))
}
