//! `lobe info`: the contents of a file.

pub mod picture;

use std::io::Write;
use std::path::PathBuf;

use lobe_files::printable;
use lobe_ops::describe::{Part, describe, range};
use serde::Serialize;

use crate::failure::Failure;
use crate::message;
use crate::reading::Reading;

/// Show the contents of a file: format, channels, angles, values, and header facts; or those of a picture.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe info paint.ddr
  lobe info --json sensor.bsdf | jq '.parts[0].axes'
  lobe info glass.exr                                       wavelengths, Stokes components, samples

The format is recognised by the content of the file. The extension only decides whether Integra files are of reflection or transmission: .ddt and .sdt are transmission.
Files compressed with gzip are unpacked. In a folder, the files with one incident direction each (RPC Photonics, pab) are read as one material.
An OpenEXR picture may be of spectra or of polarised light, by lobe render or by another program.")]
pub struct Args {
    /// The file to show.
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Print JSON, for programs.
    #[arg(long)]
    json: bool,
}

/// Everything that is printed, in both forms.
#[derive(Serialize)]
struct Info {
    file: String,
    format: &'static str,
    /// `None` for a folder.
    file_bytes: Option<u64>,
    /// One per block of values; most files have one block.
    parts: Vec<Part>,
    /// Total integrated scatter, as stated in the file.
    tis: Vec<f32>,
    source: Vec<(String, String)>,
    /// How a table in no particular format was understood.
    notes: Vec<String>,
    /// Possible misunderstandings.
    doubts: Vec<String>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    if picture::is_picture(&args.file) {
        args.reading.refuse(&args.file, "a picture")?;
        return picture::run(&args.file, args.json);
    }
    let (format, document) = args.reading.open(&args.file)?;
    // Standard input has no size.
    let metadata = std::fs::metadata(&args.file).ok();
    let info = Info {
        file: args.file.display().to_string(),
        format: format.name(),
        file_bytes: metadata.filter(std::fs::Metadata::is_file).map(|metadata| metadata.len()),
        parts: describe(&document),
        tis: document.tis,
        source: document.source,
        notes: document.notes,
        doubts: document.doubts,
    };
    let mut out = message::out(args.json);
    if args.json {
        serde_json::to_writer_pretty(&mut out, &info)?;
        writeln!(out)?;
    } else {
        info.print(&mut out)?;
    }
    Ok(out.flush()?)
}

impl Info {
    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        writeln!(out, "{}", printable(&self.file))?;
        writeln!(out, "format    {}", self.format)?;
        if let Some(bytes) = self.file_bytes {
            writeln!(out, "file      {bytes} bytes")?;
        }
        for part in &self.parts {
            if self.parts.len() > 1 {
                writeln!(out, "\n{}", part.name)?;
            }
            for (name, value) in part.rows() {
                writeln!(out, "{name:<9} {value}")?;
            }
        }
        if !self.tis.is_empty() {
            let (low, high) = range(self.tis.iter().copied());
            writeln!(out, "TIS       stated for {} blocks, {low} to {high}", self.tis.len())?;
        }
        for note in &self.notes {
            writeln!(out, "read as   {note}")?;
        }
        for doubt in &self.doubts {
            writeln!(out, "doubtful  {doubt}")?;
        }
        for (name, value) in &self.source {
            writeln!(out, "  {name}: {value}")?;
        }
        Ok(())
    }
}
