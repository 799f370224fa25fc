//! `lobe resample`: resamples any material into a table in specular coordinates, and repairs such tables.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use lobe::table::{Scatter, specular};
use lobe::{Data, Options};
use lobe_colour::Space;
use lobe_files::check_output;
use lobe_formats::{Part, ddr, ssdd, write_whole};
use lobe_ops::colour::convert;
use lobe_ops::fill::{Beyond, fill, negatives, zeros};
use lobe_ops::hemisphere::Effort;
use lobe_ops::resample::{Bound, Knots, PROBES, Resampling, candidates, choose, error};
use lobe_ops::{Aspect, Subject, energy, symmetrise};
use serde::Serialize;

use crate::angles::{
    Angles, ScatterRule, SideRule, check_knots, choose_aspects, parse_angles, progress, show_direction,
};
use crate::failure::Failure;
use crate::guesses::warn_of_guesses;
use crate::measure::fits;
use crate::message::{self, say};

/// Resample any material into a table in specular coordinates, repair it, and report its error.
#[derive(clap::Args)]
#[command(
    after_help = "Axes that are not given get knots that keep the interpolation error below --error, relative to the largest value (or, with --per-value, to each value above a thousandth of that). A specular table keeps its knots unless an axis or --error is given; then its knots are chosen from among them. Errors count up to polar angles of --limit. Without --error, the command aims at 0.01; a material that cannot be resampled so accurately gets knots that bring the error near the smallest possible one, which is reported.

Repairs follow, in this order: colour, fill, mirror, reciprocal, conserve.

Examples:
  lobe resample vinyl.bsdf vinyl.ddr --error 0.01
  lobe resample paint.brdf paint.ssdd --sigma 0:85:5 --theta 0,1,2,5,10:180:10 --phi 0:360:15
  lobe resample sensor.bsdf sensor.ddr --fill zeros --beyond linear --mask filled.csv --conserve
  lobe resample paint.brdf paint.ddr --colour rgb

If --error is given and no choice of knots meets it, the exit code is 3, the message names an achievable error, and no file is written. A table is always written if the knots of all axes are given."
)]
pub struct Args {
    /// The material.
    input: PathBuf,
    /// The file to write: .ddr for reflection, .ddt for transmission, .ssdd for either.
    output: PathBuf,
    /// The largest acceptable interpolation error; by default, the command aims at 0.01.
    #[arg(long, value_name = "SHARE")]
    error: Option<f64>,
    /// The error is relative to each value, not to the largest.
    #[arg(long)]
    per_value: bool,
    /// The polar angle of both directions, in degrees, up to which errors count, because values grow toward the horizon
    /// [default: 80].
    #[arg(long, value_name = "DEGREES")]
    limit: Option<f64>,
    /// Knots of the angle of incidence in degrees: 0,30,60 or first:last:step.
    #[arg(long, value_name = "LIST", value_parser = parse_angles)]
    sigma: Option<Angles>,
    /// Knots of the rotation of the sample in degrees.
    #[arg(long, value_name = "LIST", value_parser = parse_angles)]
    psi: Option<Angles>,
    /// Knots of the angle to the mirror direction in degrees.
    #[arg(long, value_name = "LIST", value_parser = parse_angles)]
    theta: Option<Angles>,
    /// Knots of the azimuth about the mirror direction in degrees.
    #[arg(long, value_name = "LIST", value_parser = parse_angles)]
    phi: Option<Angles>,
    /// Reflection or transmission, if the file has both; by default the first.
    #[arg(long, value_enum)]
    scatter: Option<ScatterRule>,
    /// The side that the light comes from, if the file has both; by default the first.
    #[arg(long, value_enum)]
    side: Option<SideRule>,
    /// Convert spectra and other channels to colours.
    #[arg(long, value_enum)]
    colour: Option<ColourRule>,
    /// Fill unmeasured values.
    #[arg(long, value_enum)]
    fill: Option<FillRule>,
    /// The extrapolation beyond the last measured value.
    #[arg(long, value_enum, default_value = "nearest", requires = "fill")]
    beyond: BeyondRule,
    /// Write the nodes that were filled: CSV of sigma, psi, theta, phi in degrees.
    #[arg(long, value_name = "FILE", requires = "fill")]
    mask: Option<PathBuf>,
    /// Average both sides of the plane of incidence (of psi 0 in an anisotropic table).
    #[arg(long)]
    mirror: bool,
    /// Average each value with that for exchanged light and viewer.
    #[arg(long)]
    reciprocal: bool,
    /// Scale slices whose albedo is above 1 to an albedo of 1.
    #[arg(long)]
    conserve: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum ColourRule {
    /// Linear RGB with the primaries of sRGB.
    Rgb,
    /// CIE 1931 XYZ under D65.
    Xyz,
}

#[derive(Clone, Copy, ValueEnum)]
enum FillRule {
    /// Values whose channels are all exactly 0.
    Zeros,
    /// Values with a negative channel.
    Negatives,
}

#[derive(Clone, Copy, ValueEnum)]
enum BeyondRule {
    /// The nearest measured value.
    Nearest,
    /// The line through the two nearest values, not below 0.
    Linear,
}

#[derive(Serialize)]
struct Answer {
    output: String,
    aspect: String,
    /// Knots of sigma, psi, theta and phi.
    knots: [usize; 4],
    channels: Vec<String>,
    /// `None` if the table kept its knots.
    resampling: Option<Resampling>,
    repairs: Vec<String>,
}

const DEFAULT_ERROR: f64 = 0.01;
/// In degrees.
const DEFAULT_LIMIT: f64 = 80.0;

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    check_output(&args.output, &[&args.input])?;
    if let Some(mask) = &args.mask {
        check_output(mask, &[&args.input, &args.output])?;
    }
    let subject = Subject::open(&args.input, &Options::default())?;
    let aspect = choose_aspects(&args.input, &subject, args.scatter, args.side)?[0];
    check_extension(&args.output, aspect.scatter)?;
    warn_of_guesses(&args.input, &subject.document);
    let (samples, resampling) = table(args, &subject, aspect)?;
    let mut repairs = Vec::new();
    let samples = repair(args, samples, &mut repairs)?;
    write(&samples, &args.output)?;
    let answer = Answer {
        output: args.output.display().to_string(),
        aspect: aspect.to_string(),
        knots: samples.knots().each_ref().map(Vec::len),
        channels: samples.channels().names(),
        resampling,
        repairs,
    };
    let mut out = message::out(args.json);
    if args.json {
        serde_json::to_writer_pretty(&mut out, &answer)?;
        writeln!(out)?;
    } else {
        answer.print(&mut out)?;
    }
    Ok(out.flush()?)
}

/// The table before repairs, and its error unless it is the table of the file.
fn table(args: &Args, subject: &Subject, aspect: Aspect) -> Result<(specular::Data, Option<Resampling>), Failure> {
    let given = [&args.sigma, &args.psi, &args.theta, &args.phi];
    let own = if let Some(Data::Specular(samples)) = subject.data(aspect) { Some(samples) } else { None };
    let is_all_given = given.iter().all(|axis| axis.is_some());
    let idle = |name: &str, why: &str| {
        let message =
            format!("{}: found {name}, but {why}; expected only options that have an effect", args.input.display());
        Err(Failure::Usage(message))
    };
    if let Some(samples) = own.filter(|_| args.error.is_none() && given.iter().all(|axis| axis.is_none())) {
        const KEPT: &str = "the table keeps its knots, because neither an axis nor --error is given";
        return match (args.per_value, args.limit) {
            (true, _) => idle("--per-value", KEPT),
            (_, Some(_)) => idle("--limit", KEPT),
            _ => Ok((samples.clone(), None)),
        };
    }
    if args.per_value && args.error.is_none() && is_all_given {
        return idle("--per-value", "all axes are given, so there is no bound to meet");
    }
    let limit = args.limit.unwrap_or(DEFAULT_LIMIT);
    let bound = Bound {
        error: args.error.unwrap_or(DEFAULT_ERROR),
        per_value: args.per_value,
        limit: limit.to_radians(),
        is_aim: args.error.is_none(),
    };
    let is_sound = limit > 0.0 && limit <= 90.0;
    if !is_sound {
        return Err(Failure::Usage(format!("found a limit of {limit} degrees; expected one above 0, up to 90")));
    }
    if bound.error.is_nan() || bound.error <= 0.0 {
        return Err(Failure::Usage(format!("found an error of {}; expected one above 0", bound.error)));
    }
    let degrees = given.map(|axis| axis.as_ref().map_or_else(Vec::new, Angles::degrees));
    check_knots(&args.output, degrees.each_ref().map(Vec::as_slice))?;
    let candidates = own.map_or_else(|| candidates(subject.is_isotropic()), |samples| samples.knots().clone());
    let mut axes = candidates.map(Knots::Choose);
    for (axis, Angles(knots)) in axes.iter_mut().zip(given).filter_map(|(axis, list)| Some((axis, list.as_ref()?))) {
        *axis = Knots::Keep(knots.clone());
    }
    let counts = axes.each_ref().map(|axis| match axis {
        Knots::Keep(knots) | Knots::Choose(knots) => knots.len(),
    });
    fits(&args.output, &counts, subject.material.channel_count())?;
    let bar = progress("resampling");
    let chosen = choose(&subject.material, aspect, &axes, bound, &bar)
        .map_err(|error| Failure::Usage(format!("{}: {error}", args.output.display())))?;
    drop(bar);
    if chosen.error > bound.error && is_all_given && args.error.is_some() {
        say(format_args!(
            "{}: the error of these knots is {:.4}, more than {}",
            args.output.display(),
            chosen.error,
            bound.error
        ));
    }
    // If the knots of all axes are given, they are what the user wants, whatever the error.
    if chosen.error > bound.error && !is_all_given {
        let (output, least) = (args.output.display(), rounded_up(chosen.least));
        if args.error.is_some() {
            return Err(Failure::Check(format!(
                "{output}: the smallest error reached is {:.4}; expected {} or less. --error {least} would succeed{}",
                chosen.least,
                bound.error,
                if limit > 60.0 { ", and a smaller --limit may allow less" } else { "" }
            )));
        }
        say(format_args!(
            "{output}: the error is {:.1} %, more than the intended {:.0} %; an --error below {least} may not be achievable",
            100.0 * chosen.error,
            100.0 * bound.error
        ));
    }
    let found = error(&subject.material, aspect, &chosen.samples, bound.limit, PROBES)?;
    Ok((chosen.samples, Some(found)))
}

/// An error rounded up to two digits.
fn rounded_up(error: f64) -> f64 {
    let unit = 10_f64.powf(error.max(f64::MIN_POSITIVE).log10().floor() - 1.0);
    let digits = (-unit.log10()).round().clamp(0.0, 17.0) as usize;
    let rounded = (error / unit - 1e-9).ceil() * unit;
    // The printed number has no rounding digits.
    format!("{rounded:.digits$}").parse().map_or(rounded, |short: f64| if short < error { short + unit } else { short })
}

fn repair(args: &Args, mut samples: specular::Data, repairs: &mut Vec<String>) -> Result<specular::Data, Failure> {
    let refuse = |error: &dyn std::fmt::Display| Failure::Usage(format!("{}: {error}", args.input.display()));
    if let Some(colour) = args.colour {
        let target = match colour {
            ColourRule::Rgb => Space::Rgb,
            ColourRule::Xyz => Space::Xyz,
        };
        samples = convert(&samples, target).map_err(|error| refuse(&error))?;
    }
    if let Some(rule) = args.fill {
        let mask = match rule {
            FillRule::Zeros => zeros(&samples),
            FillRule::Negatives => negatives(&samples),
        };
        let beyond = match args.beyond {
            BeyondRule::Nearest => Beyond::Nearest,
            BeyondRule::Linear => Beyond::Linear,
        };
        let filled = fill(&samples, &mask, beyond).map_err(|error| refuse(&error))?;
        let count = filled.mask.iter().filter(|filled| **filled).count();
        repairs.push(format!("{count} of {} nodes filled", filled.mask.len()));
        if let Some(file) = &args.mask {
            write_whole(file, mask_csv(&filled.samples, &filled.mask).as_bytes())?;
        }
        samples = filled.samples;
    }
    if args.mirror {
        samples = symmetrise::mirror(&samples).map_err(|error| refuse(&error))?;
        repairs.push("averaged with its mirror image".into());
    }
    if args.reciprocal {
        samples = symmetrise::reciprocal(&samples).map_err(|error| refuse(&error))?;
        repairs.push("averaged with light and viewer exchanged".into());
    }
    if args.conserve {
        let (repaired, scaled) =
            energy::conserve_energy(&samples, Effort::default()).map_err(|error| refuse(&error))?;
        let largest = scaled.iter().map(|repair| repair.albedo.largest()).fold(0.0, f64::max);
        repairs.push(match scaled.len() {
            0 => "no slice has an albedo above 1".into(),
            n => format!("{n} slices scaled to an albedo of 1, from {largest:.4} at most"),
        });
        samples = repaired;
    }
    Ok(samples)
}

/// The angles of the nodes that were filled.
fn mask_csv(samples: &specular::Data, mask: &[bool]) -> String {
    let knots = samples.knots().each_ref().map(|knots| knots.iter().map(|a| a.to_degrees() as f32).collect::<Vec<_>>());
    let mut csv = String::from("sigma,psi,theta,phi\n");
    let mut filled = mask.iter();
    for sigma in &knots[0] {
        for psi in &knots[1] {
            for theta in &knots[2] {
                for phi in &knots[3] {
                    if filled.next() == Some(&true) {
                        csv.push_str(&format!("{sigma},{psi},{theta},{phi}\n"));
                    }
                }
            }
        }
    }
    csv
}

fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}

/// Checked before any long computation.
fn check_extension(path: &Path, scatter: Scatter) -> Result<(), Failure> {
    let (wanted, what) = match scatter {
        Scatter::Reflection => ("ddr", "reflection"),
        Scatter::Transmission => ("ddt", "transmission"),
    };
    let found = extension(path);
    if found == "ssdd" || found == wanted {
        return Ok(());
    }
    let path = path.display();
    Err(Failure::Usage(format!("{path}: found the extension `{found}`; expected {wanted} or ssdd for {what}")))
}

fn write(samples: &specular::Data, path: &Path) -> Result<(), Failure> {
    if extension(path) == "ssdd" {
        let part = Part::new("", samples.clone());
        return Ok(ssdd::write(&[part], ssdd::Encoding::Ascii, path)?);
    }
    Ok(ddr::write(samples, path)?)
}

impl Answer {
    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        let [sigmas, psis, thetas, phis] = self.knots;
        writeln!(
            out,
            "{}: {}, {sigmas} x {psis} x {thetas} x {phis} knots, {}",
            self.output,
            self.aspect,
            self.channels.join(" ")
        )?;
        match &self.resampling {
            None => writeln!(out, "knots     those of the file")?,
            Some(found) => {
                let [wi, wo] = found.worst.map(show_direction);
                writeln!(
                    out,
                    "error     at most {:.6} 1/sr, {:.3} % of the largest value, {:.2} % of a value, rms {:.6}, at {} pairs",
                    found.max,
                    100.0 * found.relative_to_peak,
                    100.0 * found.relative_to_value,
                    found.rms,
                    found.probes
                )?;
                writeln!(out, "worst     for light at ({wi}) and viewer at ({wo}) degrees")?;
            }
        }
        self.repairs.iter().try_for_each(|repair| writeln!(out, "repair    {repair}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_rounded_up_to_two_digits() {
        for (error, expected) in
            [(0.0230, 0.023), (0.023_01, 0.024), (0.472_6, 0.48), (3.0, 3.0), (12.1, 13.0), (9.99e-5, 1e-4)]
        {
            let found = rounded_up(error);
            assert!(found >= error && (found - expected).abs() < 1e-12, "{error}: {found}");
            assert!(found.to_string().len() < 8, "{found}");
        }
    }
}
