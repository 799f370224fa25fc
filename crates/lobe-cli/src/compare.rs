//! `lobe compare`: the difference between two materials.

use std::io::Write;
use std::path::{Path, PathBuf};

use lobe::Options;
use lobe_ops::certify::{Channel, LIMIT, PAIRS};
use lobe_ops::compare::{Difference, Visible, difference, visible};
use lobe_ops::{OnBackend, Subject};
use serde::Serialize;

use crate::angles::{ScatterRule, SideRule, choose_aspects, progress, show_direction};
use crate::failure::Failure;
use crate::measure::fits;
use crate::message;

/// Compare two materials: their values over many directions, and the appearance of two spheres.
#[derive(clap::Args)]
#[command(
    after_help = "Both files are evaluated at the same pairs of directions, half of them near the mirror direction. If their channels differ they are compared in CIE XYZ under D65. Delta E is CIE 2000, between the pixels of two spheres under one light; about 1 is just noticeable side by side.

Examples:
  lobe compare paint.ddr paint-resampled.ddr
  lobe compare --within 0.01 old.bsdf new.bsdf      exit code 3 if they differ more
  lobe compare --json a.ddr b.brdf | jq '.[0].difference.rms'"
)]
pub struct Args {
    /// The first material.
    first: PathBuf,
    /// The material to compare with it.
    second: PathBuf,
    /// Reflection or transmission only, if the files have both.
    #[arg(long, value_enum)]
    scatter: Option<ScatterRule>,
    /// Light from one side only, if the files have both.
    #[arg(long, value_enum)]
    side: Option<SideRule>,
    /// Compare this channel of the first material with that of the same name, or the only one, of the second. Equal
    /// values at 360 and 830 nm are one channel.
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// The number of pairs of directions.
    #[arg(long, default_value_t = PAIRS as u32, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pairs: u32,
    /// The largest polar angle of both directions, in degrees.
    #[arg(long, default_value_t = LIMIT)]
    limit: f64,
    /// The width of the spheres in pixels.
    #[arg(long, default_value_t = 128, value_parser = clap::value_parser!(u16).range(8..=4096))]
    pixels: u16,
    /// The largest relative difference (root mean square) that is not a failure.
    #[arg(long, value_name = "SHARE")]
    within: Option<f64>,
    /// Print JSON: an array with one object per measurement that both files have.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Answer {
    aspect: String,
    difference: Difference,
    /// `None` if the channels have no colour.
    delta_e: Option<Visible>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let is_sound = args.limit > 0.0 && args.limit < 90.0;
    if !is_sound {
        return Err(Failure::Usage(format!("found a limit of {} degrees; expected one between 0 and 90", args.limit)));
    }
    let open = |file| Subject::open(file, &Options::default());
    let (first, second) = (open(&args.first)?, open(&args.second)?);
    let theirs = second.aspects();
    let mut aspects = choose_aspects(&args.first, &first, args.scatter, args.side)?;
    aspects.retain(|aspect| theirs.contains(aspect));
    if aspects.is_empty() {
        let there: Vec<String> = theirs.iter().map(ToString::to_string).collect();
        return Err(Failure::Usage(format!(
            "{}: found {}; expected a measurement that {} has too",
            args.second.display(),
            there.join(", "),
            args.first.display()
        )));
    }
    let channels = first.material.channels().count().max(second.material.channels().count());
    fits(&args.first, &[args.pairs as usize], channels + 4)?;
    let bar = progress("comparing");
    let picked = args.channel.as_deref().map(|name| picked(args, name, [&first, &second])).transpose()?;
    let [a, b] = match &picked {
        Some(channels) => channels.each_ref().map(OnBackend::from),
        None => [&first, &second].map(|subject| OnBackend::from(&subject.material)),
    };
    let mut answers = Vec::new();
    for (index, &aspect) in aspects.iter().enumerate() {
        let difference = difference(a, b, aspect, args.limit.to_radians(), args.pairs as usize)
            .map_err(|error| Failure::Usage(error.to_string()))?;
        bar((index as f64 + 0.8) / aspects.len() as f64);
        let delta_e = visible(a, b, aspect, usize::from(args.pixels)).ok();
        bar((index + 1) as f64 / aspects.len() as f64);
        answers.push(Answer { aspect: aspect.to_string(), difference, delta_e });
    }
    drop(bar);
    let mut out = message::out(args.json);
    if args.json {
        serde_json::to_writer_pretty(&mut out, &answers)?;
        writeln!(out)?;
    } else {
        for answer in &answers {
            answer.print(&mut out)?;
        }
    }
    out.flush()?;
    let worst = answers.iter().map(|answer| answer.difference.relative_rms).fold(0.0, f64::max);
    match args.within {
        Some(within) if worst > within || within.is_nan() => {
            Err(Failure::Check(format!("they differ by {worst:.3e}, more than {within}")))
        }
        _ => Ok(()),
    }
}

/// The channel of this name of both files.
fn picked<'a>(args: &Args, name: &str, subjects: [&'a Subject; 2]) -> Result<[Channel<'a>; 2], Failure> {
    let pick = |file: &Path, subject: &'a Subject| {
        Channel::of(&subject.material, name).ok_or_else(|| {
            let names = subject.material.channels().names().join(", ");
            Failure::Usage(format!("{}: found no channel {name}; expected one of {names}", file.display()))
        })
    };
    let [first, second] = subjects;
    Ok([pick(&args.first, first)?, pick(&args.second, second)?])
}

impl Answer {
    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        let found = &self.difference;
        let [wi, wo] = found.worst.map(show_direction);
        writeln!(out, "{}", self.aspect)?;
        writeln!(out, "channels  {}", found.channels.join(" "))?;
        writeln!(out, "pairs     {}, values up to {:.5} 1/sr", found.pairs, found.peak)?;
        writeln!(out, "max       {:.6} 1/sr, for light at ({wi}) and viewer at ({wo}) degrees", found.max)?;
        writeln!(out, "rms       {:.6} 1/sr, {:.3} % of the first", found.rms, 100.0 * found.relative_rms)?;
        writeln!(out, "bias      {:+.6} 1/sr, the second minus the first", found.bias)?;
        match &self.delta_e {
            Some(visible) => writeln!(
                out,
                "delta E   {:.3} on average over {} pixels, 95 % below {:.3}, at most {:.3}",
                visible.mean, visible.pixels, visible.percentile_95, visible.max
            ),
            None => writeln!(out, "delta E   none, because these channels have no colour"),
        }
    }
}
