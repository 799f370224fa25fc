//! `lobe info`: what a file holds.

use std::io::{Write, stdout};
use std::path::PathBuf;

use lobe_formats::{Document, Format, Measured, open};
use lobe_table::{AXIS_NAMES, Channels, Scatter};
use serde::Serialize;

use crate::failure::Failure;

/// Show what a file holds: format, channels, angles, values, and what its header says.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe info paint.ddr
  lobe info --json sensor.bsdf | jq .axes

The format is told from the content. Only .ddt and .sdt files are known by their extension to be transmission.")]
pub struct Args {
    /// The file to look at.
    file: PathBuf,
    /// Print JSON, for programs.
    #[arg(long)]
    json: bool,
}

/// Everything that is printed, in either form.
#[derive(Serialize)]
struct Info {
    file: String,
    format: &'static str,
    /// `table`: values over specular coordinates; `specular`: mirror reflectance by angle of incidence.
    kind: &'static str,
    scatter: &'static str,
    channels: Vec<String>,
    axes: Vec<Axis>,
    /// Polar angle of the refracted light at each sigma knot; empty without refraction.
    refracted_degrees: Vec<f32>,
    values: Values,
    file_bytes: u64,
    tis: Vec<f32>,
    source: Vec<(String, String)>,
}

#[derive(Serialize)]
struct Axis {
    name: &'static str,
    count: usize,
    first_degrees: f32,
    last_degrees: f32,
    knots_degrees: Vec<f32>,
}

#[derive(Serialize)]
struct Values {
    count: usize,
    bytes: usize,
    smallest: f32,
    largest: f32,
    negative: usize,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let (format, document) = open(&args.file)?;
    let file_bytes = std::fs::metadata(&args.file)
        .map_err(|error| Failure::File(format!("{}: {error}", args.file.display())))?
        .len();
    let info = Info::new(args.file.display().to_string(), format, document, file_bytes)?;
    let mut out = stdout().lock();
    if args.json {
        serde_json::to_writer_pretty(&mut out, &info)?;
        writeln!(out)?;
    } else {
        info.print(&mut out)?;
    }
    Ok(out.flush()?)
}

impl Info {
    fn new(file: String, format: Format, document: Document, file_bytes: u64) -> Result<Self, Failure> {
        let common = |kind, scatter, channels: &Channels, axes, values: &[f32], source, tis| Info {
            file: file.clone(),
            format: format.name(),
            kind,
            scatter: match scatter {
                Scatter::Reflection => "reflection",
                Scatter::Transmission => "transmission",
            },
            channels: channels.names(),
            axes,
            refracted_degrees: Vec::new(),
            values: Values::new(values),
            file_bytes,
            tis,
            source,
        };
        match document {
            Document::Table(Measured { data, source, tis }) => {
                let axes = (0..4).map(|axis| Axis::new(AXIS_NAMES[axis], &data.knots()[axis])).collect();
                let info = common("table", data.scatter(), data.channels(), axes, data.values(), source, tis);
                let offsets = data.refraction().unwrap_or(&[]);
                let refracted: Vec<f64> =
                    data.knots()[0].iter().zip(offsets).map(|(sigma, offset)| sigma + offset).collect();
                Ok(Info { refracted_degrees: degrees(&refracted), ..info })
            }
            Document::Specular(Measured { data, source, tis }) => {
                let axes = vec![Axis::new(AXIS_NAMES[0], data.sigma())];
                Ok(common("specular", data.scatter(), data.channels(), axes, data.values(), source, tis))
            }
            _ => Err(Failure::File(format!("{file}: found {format}; expected a format that this command knows"))),
        }
    }

    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        let what = if self.kind == "specular" { "mirror reflectance by angle of incidence" } else { "f in 1/sr" };
        writeln!(out, "{}", self.file)?;
        writeln!(out, "format    {}", self.format)?;
        writeln!(out, "scatter   {}", self.scatter)?;
        writeln!(out, "channels  {}: {}", self.channels.len(), self.channels.join(" "))?;
        for axis in &self.axes {
            let Axis { name, count, first_degrees, last_degrees, knots_degrees } = axis;
            match count {
                1 => writeln!(out, "{name:<9} 1 knot: {first_degrees} degrees")?,
                _ => {
                    let knots = list(knots_degrees);
                    writeln!(out, "{name:<9} {count} knots, {first_degrees} to {last_degrees} degrees: {knots}")?;
                }
            }
        }
        if !self.refracted_degrees.is_empty() {
            writeln!(out, "refracted at {} degrees for the knots of sigma", list(&self.refracted_degrees))?;
        }
        let Values { count, bytes, smallest, largest, negative } = &self.values;
        writeln!(
            out,
            "values    {count} of {what}, {smallest} to {largest}, {negative} negative, {bytes} bytes as f32"
        )?;
        writeln!(out, "file      {} bytes", self.file_bytes)?;
        if !self.tis.is_empty() {
            let (low, high) = range(&self.tis);
            writeln!(out, "TIS       stated for {} blocks, {low} to {high}", self.tis.len())?;
        }
        for (name, value) in &self.source {
            writeln!(out, "  {name}: {value}")?;
        }
        Ok(())
    }
}

impl Axis {
    fn new(name: &'static str, knots: &[f64]) -> Self {
        let knots_degrees = degrees(knots);
        let (first_degrees, last_degrees) = (knots_degrees[0], knots_degrees[knots_degrees.len() - 1]);
        Axis { name, count: knots.len(), first_degrees, last_degrees, knots_degrees }
    }
}

impl Values {
    fn new(values: &[f32]) -> Self {
        let (smallest, largest) = range(values);
        let negative = values.iter().filter(|&&value| value < 0.0).count();
        Values { count: values.len(), bytes: size_of_val(values), smallest, largest, negative }
    }
}

fn range(values: &[f32]) -> (f32, f32) {
    values.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
}

/// Files hold degrees that `f32` can hold, so rounding to that shows what the file says.
fn degrees(radians: &[f64]) -> Vec<f32> {
    radians.iter().map(|angle| angle.to_degrees() as f32).collect()
}

fn list(numbers: &[f32]) -> String {
    numbers.iter().map(f32::to_string).collect::<Vec<_>>().join(" ")
}
