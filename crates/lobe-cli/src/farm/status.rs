//! The progress of a job, from its parts.

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use lobe_render::picture::{inspect, read_partial};
use serde::Serialize;

use super::files::{part, read};
use crate::failure::Failure;
use crate::message;

/// Show the progress of a job written by `lobe farm slurm` or `lobe farm openjd`: its parts, and the time left.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe farm status look.exr.farm
  lobe farm status --json look.exr.farm | jq .share

Parts that are being rendered save their samples every 30 seconds.")]
pub struct Args {
    /// The folder of the job.
    folder: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Serialize)]
struct Status {
    parts: u32,
    finished: u32,
    /// Started and not finished.
    running: u32,
    /// The share of the samples of all pixels.
    share: f64,
    /// In seconds, at the average speed since the first part; `None` if there is nothing to estimate it from.
    left: Option<f64>,
    /// Files that are not parts of one picture.
    damaged: Vec<String>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let plan = read(&args.folder)?;
    let mut status = Status { parts: plan.parts, finished: 0, running: 0, share: 0.0, left: None, damaged: Vec::new() };
    let (mut done, mut total) = (0, 0);
    let mut times: Vec<SystemTime> = Vec::new();
    for number in 1..=plan.parts {
        let file = part(&args.folder, number);
        total += plan.work(number);
        let Ok(metadata) = file.metadata() else { continue };
        let samples = match inspect(&file) {
            Ok(found) if found.has_sums => read_partial(&file)
                .map(|(film, _)| film.pixels().iter().map(|pixel| u64::from(pixel.samples)).sum::<u64>()),
            Ok(_) => Ok(0),
            Err(error) => Err(error),
        };
        match samples {
            Ok(samples) => {
                done += samples.min(plan.work(number));
                status.finished += u32::from(samples >= plan.work(number));
                status.running += u32::from(samples < plan.work(number));
                times.extend(metadata.modified());
            }
            Err(error) => status.damaged.push(error.to_string()),
        }
    }
    status.share = done as f64 / total.max(1) as f64;
    let begun = args.folder.join(super::files::PLAN).metadata().and_then(|metadata| metadata.modified());
    if let (Ok(begun), Some(last)) = (begun, times.iter().max())
        && let Ok(taken) = last.duration_since(begun)
        && done > 0
    {
        status.left = Some(taken.as_secs_f64() * (total - done) as f64 / done as f64);
    }
    let mut out = message::out(args.json);
    if args.json {
        serde_json::to_writer_pretty(&mut out, &status)?;
        writeln!(out)?;
    } else {
        let Status { parts, finished, running, share, .. } = status;
        let left = status.left.filter(|_| finished < parts).map(|left| {
            let left = Duration::from_secs(left.round() as u64);
            format!(", {} left", humantime::format_duration(left))
        });
        let percent = (1000.0 * share).floor() / 10.0;
        writeln!(
            out,
            "{finished} of {parts} parts finished, {running} begun, {percent:.1} %{}",
            left.unwrap_or_default()
        )?;
        status.damaged.iter().try_for_each(|error| writeln!(out, "{error}"))?;
    }
    out.flush()?;
    match status.damaged.is_empty() {
        true => Ok(()),
        false => Err(Failure::File(format!("{} of {} parts cannot be read", status.damaged.len(), plan.parts))),
    }
}
