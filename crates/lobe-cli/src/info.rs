//! `lobe info`: what a file holds.

use std::io::Write;
use std::path::PathBuf;

use lobe_files::printable;
use serde::Serialize;

use crate::describe::{Part, describe, range};
use crate::failure::Failure;
use crate::message;
use crate::reading::Reading;

/// Show what a file holds: format, channels, angles, values, and what its header says.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe info paint.ddr
  lobe info --json sensor.bsdf | jq '.parts[0].axes'

The format is recognised by its content. Only whether Integra files are of reflection or transmission is decided by their extension: .ddt and .sdt are transmission.
Files packed with gzip are read as what is in them. A folder is read as the files in it that have one incident direction each (RPC Photonics, pab), which are one material.")]
pub struct Args {
    /// The file to show.
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Print JSON, for programs.
    #[arg(long)]
    json: bool,
}

/// Everything that is printed, in either form.
#[derive(Serialize)]
struct Info {
    file: String,
    format: &'static str,
    /// `None` for a folder.
    file_bytes: Option<u64>,
    /// One for each block of values; most files have one.
    parts: Vec<Part>,
    /// Total integrated scatter, as stated in the file.
    tis: Vec<f32>,
    source: Vec<(String, String)>,
    /// How a table without a format of its own was understood.
    notes: Vec<String>,
    /// What may be wrong with that.
    doubts: Vec<String>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let (format, document) = args.reading.open(&args.file)?;
    // The standard input has none.
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
