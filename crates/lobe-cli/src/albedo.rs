//! `lobe albedo`: the share of the light that is reflected or transmitted.

use std::io::Write;
use std::path::PathBuf;

use lobe::Options;
use lobe_ops::albedo::{Albedo, albedo_of};
use lobe_ops::hemisphere::Effort;
use serde::Serialize;

use crate::angles::{Angles, ScatterRule, SideRule, choose_aspects, parse_angles, progress, table};
use crate::failure::Failure;
use crate::guesses::warn_of_guesses;
use crate::measure::{fits, integrates};
use crate::message::{self, say};
use crate::reading::Reading;

/// Compute the albedo (directional-hemispherical reflectance, or transmittance) by incident direction and channel.
#[derive(clap::Args)]
#[command(
    after_help = "The integral of f cos(theta_o) over the hemisphere of viewers. Without --sigma, the angles of incidence are the measured ones of the file, or else 0 to 80 degrees. Grids are integrated between their knots, Klems matrices summed over their patches.

Examples:
  lobe albedo paint.ddr
  lobe albedo paint.ddr --sigma 0:80:10
  lobe albedo blinds.xml --scatter transmission --side front --json | jq '.[0].albedos[].values'"
)]
pub struct Args {
    /// The file of a measured BRDF or BTDF.
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Polar angles of the light in degrees: 0,30,60 or first:last:step.
    #[arg(long, value_name = "LIST", value_parser = parse_angles)]
    sigma: Option<Angles>,
    /// Azimuths of the light in degrees.
    #[arg(long, value_name = "LIST", value_parser = parse_angles, requires = "sigma")]
    psi: Option<Angles>,
    /// Reflection or transmission only, if the file has both.
    #[arg(long, value_enum)]
    scatter: Option<ScatterRule>,
    /// Light from one side only, if the file has both.
    #[arg(long, value_enum)]
    side: Option<SideRule>,
    /// The absolute error to aim for.
    #[arg(long, default_value_t = 1e-4)]
    tolerance: f64,
    /// Print JSON, with angles in radians.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Answer {
    aspect: String,
    channels: Vec<String>,
    albedos: Vec<Albedo>,
}

/// For files with more channels than this, only the extremes are shown; JSON has all channels.
const WIDE: usize = 6;

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    if args.tolerance.is_nan() || args.tolerance <= 0.0 {
        return Err(Failure::Usage(format!("found a tolerance of {}; expected one above 0", args.tolerance)));
    }
    let subject = args.reading.subject(&args.file, &Options::default())?;
    integrates(&args.file, subject.material.channel_count())?;
    let aspects = choose_aspects(&args.file, &subject, args.scatter, args.side)?;
    if let Some(aspect) = aspects.iter().find(|&&aspect| subject.is_in_plane(aspect)) {
        let message = format!(
            "{}: {aspect}: measured only in the plane of incidence, so there is no albedo",
            args.file.display()
        );
        return Err(Failure::Check(message));
    }
    warn_of_guesses(&args.file, &subject.document);
    let bar = progress("integrating");
    let effort = Effort { tolerance: args.tolerance, ..Effort::default() };
    let mut answers = Vec::new();
    for (index, &aspect) in aspects.iter().enumerate() {
        let incidences = match &args.sigma {
            Some(Angles(sigmas)) => {
                let psis = args.psi.as_ref().map_or(&[0.0][..], |Angles(psis)| psis);
                fits(&args.file, &[sigmas.len(), psis.len()], subject.material.channel_count())?;
                sigmas.iter().flat_map(|&sigma| psis.iter().map(move |&psi| [sigma, psi])).collect()
            }
            None => some(subject.incidences(aspect)),
        };
        if let Some([bad, _]) = incidences.iter().find(|[sigma, _]| !(0.0..std::f64::consts::FRAC_PI_2).contains(sigma))
        {
            return Err(Failure::Usage(format!("found light at {} degrees; expected 0 to below 90", bad.to_degrees())));
        }
        let mut albedos = Vec::new();
        for (done, &incidence) in incidences.iter().enumerate() {
            albedos.push(albedo_of(&subject, aspect, incidence, effort));
            bar((index as f64 + (done + 1) as f64 / incidences.len() as f64) / aspects.len() as f64);
        }
        answers.push(Answer { aspect: aspect.to_string(), channels: subject.material.channels().names(), albedos });
    }
    drop(bar);
    let mut out = message::out(args.json);
    if args.json {
        serde_json::to_writer_pretty(&mut out, &answers)?;
        writeln!(out)?;
    } else {
        for answer in &answers {
            answer.print(&mut out, answers.len() > 1)?;
        }
    }
    Ok(out.flush()?)
}

/// A readable number of directions, evenly chosen: a file may have been measured at a million.
fn some(all: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    const MOST: usize = 100;
    if all.len() <= MOST {
        return all;
    }
    say(format_args!(
        "note: {MOST} of {} measured directions of the light; --sigma and --psi choose others",
        all.len()
    ));
    (0..MOST).map(|index| all[index * (all.len() - 1) / (MOST - 1)]).collect()
}

impl Answer {
    fn print(&self, out: &mut impl Write, is_named: bool) -> std::io::Result<()> {
        if is_named {
            writeln!(out, "{}", self.aspect)?;
        }
        let is_wide = self.channels.len() > WIDE;
        let columns: Vec<String> =
            if is_wide { ["smallest", "mean", "largest"].map(String::from).into() } else { self.channels.clone() };
        let header = ["sigma", "psi"].map(String::from).into_iter().chain(columns).chain(["error".into()]).collect();
        let row = |albedo: &Albedo| {
            let mean = albedo.values.iter().sum::<f64>() / albedo.values.len() as f64;
            let values = if is_wide { vec![albedo.smallest(), mean, albedo.largest()] } else { albedo.values.clone() };
            let angles = [albedo.theta, albedo.phi].map(|angle| format!("{:.2}", angle.to_degrees()));
            let values = values.iter().map(|value| format!("{value:.5}"));
            angles.into_iter().chain(values).chain([format!("{:.0e}", albedo.error)]).collect()
        };
        writeln!(out, "{}", table(header, self.albedos.iter().map(row).collect(), 0).trim_fmt())
    }
}
