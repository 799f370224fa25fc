//! `lobe fit`: the parameters of a model, from a measured material.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use lobe::{Channels, Lookup, Options};
use lobe_files::{check_output, write_whole};
use lobe_fit::output::{Report, gltf, json, materialx, table as optics_table, toml};
use lobe_fit::{Band, Fit, Measurement, Model, Request, Residuals, Weights, fit, residuals};
use lobe_ops::compare::visible;
use lobe_ops::{Aspect, Subject};

use crate::angles::{ScatterRule, SideRule, choose_aspects, show_direction, table};
use crate::failure::Failure;
use crate::measure::fits;
use crate::message;
use crate::reading::Reading;

/// Fit a model for renderers or optics programs: its parameters, their uncertainties, and where the model fails.
#[derive(clap::Args)]
#[command(
    after_help = "If the file lists pairs of directions, these are fitted; otherwise pairs are interpolated. A number after +- is a standard deviation. The relative error is the root mean square of the differences divided by that of the values; with --weights log or relative it is the root mean square of the differences of logarithms.

The extension of OUT determines what is written: .toml or .json (everything), .mtlx (MaterialX: openpbr, gltf, lambert, oren-nayar), .gltf (a material: gltf, gltf-clearcoat, gltf-sheen), .csv (a table for Zemax OpticStudio, TracePro and FRED: abg, harvey-shack, k-correlation).

Examples:
  lobe fit paint.ddr --model ggx
  lobe fit paint.bsdf --model openpbr -o paint.mtlx
  lobe fit cloth.ddr --model gltf-sheen -o cloth.gltf
  lobe fit paint.bsdf --model abg --channel G -o paint.csv
  lobe fit paint.ddr --model ward --limit 0.1         exit code 3 if the relative error is larger
  lobe fit --json paint.ddr --model ggx | jq .parameters.alpha"
)]
pub struct Args {
    /// The file of a measured material.
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// The model.
    #[arg(long, short, value_parser = model())]
    model: Model,
    /// The file to write; an existing one is replaced.
    #[arg(long, short, value_name = "OUT")]
    out: Option<PathBuf>,
    /// Print JSON: an object with the parameters, their uncertainties and the residuals.
    #[arg(long)]
    json: bool,
    /// The largest relative error that does not count as a failure.
    #[arg(long, value_name = "SHARE")]
    limit: Option<f64>,
    /// The weights of the differences; by default cosine, and relative for models of smooth optics.
    #[arg(long, value_enum)]
    weights: Option<WeightRule>,
    /// Let outliers count linearly instead of quadratically.
    #[arg(long)]
    robust: bool,
    /// Give each channel its own shape, instead of one shape for all.
    #[arg(long)]
    per_channel: bool,
    /// Fit only this channel, by the name that `lobe info` shows.
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// Fit linear sRGB instead of the channels of the file. OpenPBR and glTF are always fitted in it.
    #[arg(long, conflicts_with = "channel")]
    rgb: bool,
    /// The wavelength of channels that have none, which k-correlation needs, and tables of abg and harvey-shack state.
    #[arg(long, value_name = "NM")]
    wavelength: Option<f64>,
    /// Reflection or transmission, if the file has both.
    #[arg(long, value_enum)]
    scatter: Option<ScatterRule>,
    /// The side that the light comes from, if the file has both.
    #[arg(long, value_enum)]
    side: Option<SideRule>,
    /// The largest polar angle of both directions, in degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = 80.0)]
    up_to: f64,
    /// The most pairs of directions to fit.
    #[arg(long, default_value_t = 8192, value_parser = clap::value_parser!(u32).range(64..=1_000_000))]
    pairs: u32,
    /// The number of starting points of the search.
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u16).range(1..=1000))]
    starts: u16,
}

/// The weights of differences between measured and modelled values.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum WeightRule {
    /// The square root of the product of both cosines.
    Cosine,
    /// The differences themselves.
    Value,
    /// Differences of logarithms.
    Log,
    /// Relative to the model.
    Relative,
}

fn model() -> impl TypedValueParser<Value = Model> {
    let value = |model: Model| PossibleValue::new(model.name()).help(model.description());
    PossibleValuesParser::new(Model::ALL.map(value)).try_map(|name| Model::named(&name).ok_or("no model of this name"))
}

/// The output that the extension of the file selects.
#[derive(Clone, Copy)]
enum Kind {
    Toml,
    Json,
    MaterialX,
    Gltf,
    Table,
}

fn kind(out: &Path) -> Result<Kind, Failure> {
    let extension = out.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    match extension.as_str() {
        "toml" => Ok(Kind::Toml),
        "json" => Ok(Kind::Json),
        "mtlx" => Ok(Kind::MaterialX),
        "gltf" => Ok(Kind::Gltf),
        "csv" => Ok(Kind::Table),
        _ => {
            let out = out.display();
            Err(Failure::Usage(format!("{out}: found no known extension; expected .toml, .json, .mtlx, .gltf or .csv")))
        }
    }
}

/// The number of pairs for which residuals are computed.
const CHECKED: usize = 50_000;
/// The width of the spheres that are compared, in pixels.
const PIXELS: usize = 128;

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let target = args.out.as_deref().map(|out| kind(out).map(|kind| (out, kind))).transpose()?;
    if let Some((out, _)) = target {
        check_output(out, &[&args.file])?;
    }
    let angle = |name: &str, value: f64, most: f64| match value > 0.0 && value <= most {
        true => Ok(()),
        false => Err(Failure::Usage(format!("found {name} {value}; expected a number above 0, up to {most}"))),
    };
    angle("--up-to", args.up_to, 89.0)?;
    angle("--wavelength", args.wavelength.unwrap_or(1.0), 1e9)?;
    if let Some(limit) = args.limit.filter(|limit| !(limit.is_finite() && *limit >= 0.0)) {
        return Err(Failure::Usage(format!("found --limit {limit}; expected a number of at least 0")));
    }
    let uses_wavelength = matches!(args.model, Model::Abg | Model::HarveyShack | Model::KCorrelation);
    if args.wavelength.is_some() && !uses_wavelength {
        return Err(Failure::Usage(format!(
            "found --wavelength with {}; expected abg, harvey-shack or k-correlation, which need one or write it",
            args.model.name()
        )));
    }
    let subject = args.reading.subject(&args.file, &Options { lookup: Lookup::Linear, ..Options::default() })?;
    let aspect = aspect(args, &subject)?;
    let limit = args.up_to.to_radians();
    let channels = subject.material.channel_count();
    fits(&args.file, &[CHECKED.max(args.pairs as usize)], 4 * channels + 40)?;
    let measured = |count| chosen(args, Measurement::of_subject(&subject, aspect, limit, count));
    let measurement = measured(args.pairs as usize)?;
    if args.wavelength.is_some() && matches!(measurement.channels(), Channels::Spectral(_)) {
        let message =
            "found --wavelength, but the channels have wavelengths; expected only options that have an effect";
        return Err(Failure::Usage(format!("{}: {message}", args.file.display())));
    }
    let usual = Request::new(args.model);
    let request = Request {
        weights: args.weights.map_or(usual.weights, weights),
        robust: args.robust,
        per_channel: args.per_channel,
        starts: usize::from(args.starts),
        wavelength: args.wavelength,
        ..usual
    };
    let mut fit = fit(&measurement, &request).map_err(|error| refused(args, &error))?;
    fit.fitted = fit.fitted.on(aspect);
    let residuals = residuals(&fit.fitted, &measured(CHECKED)?);
    let is_whole = !subject.is_in_plane(aspect) && args.channel.is_none();
    let delta_e = is_whole.then(|| visible(&subject.material, &fit.fitted, aspect, PIXELS).ok()).flatten();
    let report = Report { aspect: aspect.to_string(), fit: &fit, residuals: &residuals, delta_e };
    if let Some((out, kind)) = target {
        let name = args.file.file_stem().unwrap_or_default().to_string_lossy();
        let content = match kind {
            Kind::Toml => Ok(toml(&report)),
            Kind::Json => Ok(json(&report)),
            Kind::MaterialX => materialx(&fit, &name),
            Kind::Gltf => gltf(&fit, &name),
            Kind::Table => optics_table(&fit),
        };
        let content = content.map_err(|error| Failure::Usage(format!("{}: {error}", out.display())))?;
        write_whole(out, content.as_bytes())?;
    }
    let mut out = message::out(args.json);
    if args.json {
        out.write_all(json(&report).as_bytes())?;
    } else {
        print(&report, &mut out)?;
    }
    out.flush()?;
    let error = error(&fit, &residuals);
    match args.limit {
        Some(limit) if error > limit || error.is_nan() => {
            Err(Failure::Check(format!("{}: the relative error is {error:.4}, more than {limit}", args.model.name())))
        }
        _ => Ok(()),
    }
}

fn refused(args: &Args, error: &lobe_fit::FitError) -> Failure {
    let advice = match error {
        lobe_fit::FitError::TooMany(_) => " (--rgb, --channel or --per-channel may fit)",
        lobe_fit::FitError::NoWavelength(_) => " (--wavelength gives it)",
        _ => "",
    };
    Failure::Usage(format!("{}: {error}{advice}", args.file.display()))
}

/// The error that the limit applies to.
fn error(fit: &Fit, residuals: &Residuals) -> f64 {
    match fit.request.weights {
        Weights::Cosine | Weights::Value => residuals.relative_rms,
        Weights::Log | Weights::Relative => residuals.log_rms,
    }
}

fn weights(rule: WeightRule) -> Weights {
    match rule {
        WeightRule::Cosine => Weights::Cosine,
        WeightRule::Value => Weights::Value,
        WeightRule::Log => Weights::Log,
        WeightRule::Relative => Weights::Relative,
    }
}

/// The one requested measurement.
fn aspect(args: &Args, subject: &Subject) -> Result<Aspect, Failure> {
    let aspects = choose_aspects(&args.file, subject, args.scatter, args.side)?;
    let file = args.file.display();
    let found = |list: &[Aspect]| list.iter().map(Aspect::to_string).collect::<Vec<_>>().join(", ");
    let described: Vec<Aspect> =
        aspects.iter().copied().filter(|aspect| args.model.describes(aspect.scatter)).collect();
    match described.as_slice() {
        [aspect] => Ok(*aspect),
        [] => Err(Failure::Usage(format!(
            "{file}: found {}; expected reflection, which the {} model describes",
            found(&aspects),
            args.model.name()
        ))),
        several => Err(Failure::Usage(format!(
            "{file}: found {}; expected --scatter and --side to choose one of them",
            found(several)
        ))),
    }
}

/// The channels that are fitted.
fn chosen(args: &Args, measurement: Measurement) -> Result<Measurement, Failure> {
    let file = args.file.display();
    if let Some(name) = &args.channel {
        let names = measurement.channels().names();
        let index = names.iter().position(|other| other == name);
        let index = index.ok_or_else(|| {
            Failure::Usage(format!("{file}: found no channel {name}; expected one of {}", names.join(" ")))
        })?;
        return Ok(measurement.channel(index));
    }
    let is_of_renderers = matches!(
        args.model,
        Model::OpenPbr | Model::OpenPbrAnisotropic | Model::Gltf | Model::GltfClearcoat | Model::GltfSheen
    );
    let is_colour = matches!(measurement.channels(), Channels::Rgb | Channels::Mono);
    if args.rgb || is_of_renderers && !is_colour {
        return measurement.in_rgb().map_err(|error| Failure::Usage(format!("{file}: {error}")));
    }
    Ok(measurement)
}

fn print(report: &Report<'_>, out: &mut impl Write) -> std::io::Result<()> {
    let (fit, found) = (report.fit, report.residuals);
    let request = &fit.request;
    let robust = if request.robust { ", robust" } else { "" };
    writeln!(out, "{}: {}, {} weights{robust}", report.aspect, request.model.name(), request.weights.name())?;
    let names = fit.channels.names();
    let mut rows = Vec::new();
    for estimate in &fit.estimates {
        let channel = estimate.channel.filter(|_| names.len() > 1).map(|channel| names[channel].clone());
        let sure = match (estimate.is_at_bound, estimate.uncertainty) {
            (true, _) => "at its bound".to_owned(),
            (false, Some(uncertainty)) => format!("+- {}", short(uncertainty)),
            (false, None) => "not determined".to_owned(),
        };
        let name =
            [Some(estimate.parameter.name.to_owned()), channel].into_iter().flatten().collect::<Vec<_>>().join(" ");
        rows.push(vec![name, short(estimate.value), sure, estimate.parameter.meaning.to_owned()]);
    }
    let widths = [0, 1, 2].map(|column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    for row in &rows {
        let [first, second, third] = widths;
        writeln!(out, "  {:first$}  {:>second$}  {:third$}  {}", row[0], row[1], row[2], row[3])?;
    }
    if !fit.has_converged {
        writeln!(out, "  the search ended before it converged")?;
    }
    let zero =
        if fit.left_out > 0 { format!("; {} more are 0 and were left out", fit.left_out) } else { String::new() };
    writeln!(
        out,
        "pairs     {} fitted, {} compared, values up to {:.5} 1/sr{zero}",
        fit.pairs, found.pairs, found.peak
    )?;
    let [wi, wo] = found.worst.map(show_direction);
    writeln!(out, "max       {:.6} 1/sr, for light at ({wi}) and viewer at ({wo}) degrees", found.max)?;
    writeln!(
        out,
        "rms       {:.6} 1/sr, {:.3} % of the measurement; {:.4} of logarithms",
        found.rms,
        100.0 * found.relative_rms,
        found.log_rms
    )?;
    writeln!(out, "bias      {:+.6} 1/sr, the model minus the measurement", found.bias)?;
    if let Some(visible) = &report.delta_e {
        writeln!(
            out,
            "delta E   {:.3} on average over {} pixels, 95 % below {:.3}, at most {:.3}",
            visible.mean, visible.pixels, visible.percentile_95, visible.max
        )?;
    }
    for (title, bands) in [("light at", &found.by_light), ("off mirror", &found.by_distance)] {
        writeln!(out, "{}", bands_table(title, bands))?;
    }
    Ok(())
}

fn bands_table(title: &str, bands: &[Band]) -> comfy_table::Table {
    let header = [title, "pairs", "rms 1/sr", "rms %", "bias 1/sr"].map(String::from).to_vec();
    let row = |band: &Band| {
        let [from, to] = band.degrees;
        let percent = format!("{:.2}", 100.0 * band.relative_rms);
        vec![format!("{from}-{to}"), band.pairs.to_string(), short(band.rms), percent, short(band.bias)]
    };
    table(header, bands.iter().map(row).collect(), 1)
}

/// A number with five digits.
fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-3..1e5).contains(&size) {
        let digits = if size == 0.0 { 0 } else { (4 - size.log10().floor() as i32).max(0) as usize };
        format!("{value:.digits$}")
    } else {
        format!("{value:.4e}")
    }
}
