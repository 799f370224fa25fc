//! Mueller matrices, generated for rough surfaces.

use lobe::Data;
use lobe_formats::{Document, Format};
use lobe_model::{Ggx, RoughCoat, RoughMirrors};
use lobe_spectrum::{Glass, Metal};

use crate::failure::Failure;
use crate::measure::fits;
use crate::message::say;
use crate::output::{Output, Purpose};
use crate::progress::Progress;
use crate::target::Target;

fn write(matrices: Data, target: Target, output: &Output, how: &str) -> Result<(), Failure> {
    (target.writer.write)(&Document::new(matrices), &output.out)?;
    say(format_args!("{}: {}, {how}", output.out.display(), target.format));
    Ok(())
}

/// A rough surface of microfacets that polarises light.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe generate mueller gold.mueller --metal gold --alpha 0.2
  lobe generate mueller lacquer.mueller --glass BK7 --alpha 0.05 --wavelengths 450,550,650
  lobe generate mueller rough.mueller --index 1.5 --alpha 0.1,0.3
  lobe generate mueller standard.mueller --index 1.35 --alpha 0.5 --albedo 0.95
  lobe generate mueller gold.csv --to mueller-csv --metal gold --sigma 0,30,60 --theta 0,5,10,30

A dielectric only reflects, unless --albedo puts a base under it: light that passes through its surface is left out.")]
pub struct Args {
    /// Roughness, or that along x and y.
    #[arg(long, default_value = "0.2", value_delimiter = ',', num_args = 1..=2)]
    alpha: Vec<f64>,
    /// A metal with a known index.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["glass", "index"])]
    metal: Option<String>,
    /// A glass with a known index.
    #[arg(long, value_name = "NAME", conflicts_with = "index")]
    glass: Option<String>,
    /// The refractive index n, or n,k, at all wavelengths [default: 1.5].
    #[arg(long, value_delimiter = ',', num_args = 1..=2)]
    index: Vec<f64>,
    /// The share of light that a base under a dielectric surface reflects evenly and without polarisation.
    #[arg(long, value_name = "SHARE", conflicts_with = "metal")]
    albedo: Option<f64>,
    /// Wavelengths in nm, ascending.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "400,450,500,550,600,650,700")]
    wavelengths: Vec<f64>,
    #[command(flatten)]
    output: Output,
}

/// Runs `lobe generate mueller`.
pub fn generate(args: &Args) -> Result<(), Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let (output, target) = (&args.output, args.output.target()?);
    if !matches!(target.format, Format::Polarised | Format::MuellerCsv) {
        let expected = "a .mueller file, or --to mueller or mueller-csv";
        return usage(format!("{}: found {}; expected {expected}", output.out.display(), target.format));
    }
    lobe_files::check_output::<&std::path::Path>(&output.out, &[])?;
    output.refuse_others(&[Purpose::Knots])?;
    output.check_knots()?;
    let alpha = match args.alpha[..] {
        [both] => [both; 2],
        [x, y] => [x, y],
        _ => [f64::NAN; 2],
    };
    if alpha.iter().any(|alpha| !(1e-3..=10.0).contains(alpha)) {
        return usage(format!("--alpha: found {:?}; expected one or two numbers from 0.001 to 10", args.alpha));
    }
    let known = |names: Vec<&str>, found: &str| {
        Err(Failure::Usage(format!("found `{found}`; expected one of {}", names.join(", "))))
    };
    let index: Vec<[f64; 2]> = match (&args.metal, &args.glass, &args.index[..]) {
        (Some(name), ..) => match Metal::named(name) {
            Some(metal) => args.wavelengths.iter().map(|nm| [metal.n.at(*nm), metal.k.at(*nm)]).collect(),
            None => return known(Metal::names().collect(), name),
        },
        (_, Some(name), _) => match Glass::named(name) {
            Some(glass) => args.wavelengths.iter().map(|nm| [glass.index(*nm), 0.0]).collect(),
            None => return known(Glass::names().collect(), name),
        },
        (.., []) => vec![[1.5, 0.0]; args.wavelengths.len()],
        (.., [n]) => vec![[*n, 0.0]; args.wavelengths.len()],
        (.., [n, k, ..]) => vec![[*n, *k]; args.wavelengths.len()],
    };
    if let Some([n, k]) = index.iter().find(|[n, k]| !(*n > 0.0 && *n <= 100.0 && *k >= 0.0 && *k <= 100.0)) {
        return usage(format!("found the refractive index {n}, {k}; expected n above 0 and k not negative, up to 100"));
    }
    if let Some(albedo) = args.albedo.filter(|albedo| !(0.0..=1.0).contains(albedo)) {
        return usage(format!("--albedo: found {albedo}; expected a share from 0 to 1"));
    }
    if args.albedo.is_some() && index.iter().any(|[_, k]| *k > 0.0) {
        return usage("--albedo: found a surface that absorbs; expected a dielectric, whose k is 0".into());
    }
    let knots = output.knots(alpha[0] == alpha[1]);
    let counts = knots.each_ref().map(Vec::len);
    fits(&output.out, &counts, 16 * index.len())?;
    let progress = Progress::new(counts[0] * counts[1], "directions of the light");
    let mirrors = RoughMirrors { ggx: Ggx { alpha }, index };
    let (wavelengths, step) = (args.wavelengths.clone(), || progress.step());
    let data = match args.albedo {
        Some(share) => {
            let albedo = vec![share; wavelengths.len()];
            RoughCoat { mirrors, albedo }.measure(knots, wavelengths, step)
        }
        None => mirrors.measure(knots, wavelengths, step),
    };
    let data = data.map_err(|error| Failure::Usage(format!("{}: {error}", output.out.display())))?;
    let [sigma, psi, theta, phi] = counts;
    write(data.into(), target, output, &format!("{sigma} sigma x {psi} psi x {theta} theta x {phi} phi"))
}
