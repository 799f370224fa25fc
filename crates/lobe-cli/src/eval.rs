//! `lobe eval`: values of a material at given directions.

use std::io::Write;
use std::path::PathBuf;

use clap::{ArgGroup, ValueEnum};
use lobe::formats::Document;
use lobe::{Data, Edges, Given, Lookup, Material, Options};
use lobe_files::is_standard_input;
use lobe_table::specular::coords::angles_to_directions;
use lobe_table::specular::reference::zenith;
use serde::Serialize;

use crate::failure::Failure;
use crate::guesses::warn_of_guesses;
use crate::message::{self, say};
use crate::pairs::{Pair, Pairs, parse_direction, parse_numbers};
use crate::reading::Reading;

/// Evaluate a material: f in 1/sr, without the cosine, for one pair of directions or for many.
#[derive(clap::Args)]
#[command(
    group(ArgGroup::new("query").required(true).args(["wi", "angles", "pairs"])),
    after_help = "Directions point away from the surface, with the normal on +z: wi to the light, wo to the viewer. They are normalised. Below the horizon, f is 0; transmission tables accept either sign of z, and in files with both sides of a sheet the sign selects the side.

Examples:
  lobe eval paint.ddr --wi -0.5,0,0.8 --wo 0.4,0.1,0.9
  lobe eval paint.ddr --angles 30,0,5,180          sigma, psi, theta, phi in degrees
  lobe eval paint.ddr --pairs pairs.csv > f.csv    one line wi.x,wi.y,wi.z,wo.x,wo.y,wo.z per pair
  echo 0,0,1,0.6,0,0.8 | lobe eval paint.ddr --edge zero --pairs -
  lobe eval blinds.xml --wi 0,0.5,0.8 --wo 0,-0.5,-0.8 --channel Visible --cosine

LOBE_BACKEND=scalar|sse2|sse4.1|avx2|avx512 chooses the instructions; the default is the best set that this machine has."
)]
pub struct Args {
    /// The file of a measured BRDF or BTDF.
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// The direction to the light.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "wo", value_parser = parse_direction)]
    wi: Option<[f64; 3]>,
    /// The direction to the viewer.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "wi", conflicts_with_all = ["angles", "pairs"], value_parser = parse_direction)]
    wo: Option<[f64; 3]>,
    /// Specular coordinates in degrees instead of two directions.
    #[arg(long, value_name = "SIGMA,PSI,THETA,PHI", allow_hyphen_values = true, value_parser = parse_specular)]
    angles: Option<[f64; 4]>,
    /// A CSV file with six columns, wi then wo, or with their names in the first line; `-` is standard input. Prints
    /// one line of channels per pair.
    #[arg(long, value_name = "FILE")]
    pairs: Option<PathBuf>,
    /// The values beyond the outermost angles of a table in specular coordinates [default: clamp].
    #[arg(long, value_enum)]
    edge: Option<EdgeRule>,
    /// The lookup in grids of half and difference angles (MERL) [default: nearest].
    #[arg(long, value_enum)]
    lookup: Option<LookupRule>,
    /// The direction that indexes tables of the EPFL database (RGL) [default: light].
    #[arg(long, value_enum)]
    indexed_by: Option<IndexRule>,
    /// Print only this channel, by the name that `lobe info` shows: Y, R, 550nm. May be repeated.
    #[arg(long = "channel", value_name = "NAME")]
    channels: Vec<String>,
    /// Print f times the cosine between wo and the normal.
    #[arg(long)]
    cosine: bool,
    /// Round the same way on all machines and instructions, which is a little slower.
    #[arg(long)]
    strict: bool,
    /// Print JSON: an object, or with --pairs one object per line.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum EdgeRule {
    /// The value at the nearest measured angle; psi and phi are full circles; never negative.
    Clamp,
    /// Linear extrapolation beyond the ends of all four axes; negative values are kept.
    Extrapolate,
    /// 0 outside sigma and theta; psi and phi are full circles; never negative.
    Zero,
}

impl EdgeRule {
    fn edges(self) -> Edges {
        match self {
            EdgeRule::Clamp => Edges::default(),
            EdgeRule::Extrapolate => Edges::extrapolate(),
            EdgeRule::Zero => Edges::zero(),
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum LookupRule {
    /// The value of the bin.
    Nearest,
    /// Linear between the centres of bins.
    Linear,
}

#[derive(Clone, Copy, ValueEnum)]
enum IndexRule {
    /// The light, as in the measurement.
    Light,
    /// The viewer, as in renderers that trace from the camera.
    Viewer,
}

#[derive(Serialize)]
struct Answer<'a> {
    wi: [f64; 3],
    wo: [f64; 3],
    channels: &'a [&'a str],
    values: &'a [f32],
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let lookup = match args.lookup {
        None | Some(LookupRule::Nearest) => Lookup::Nearest,
        Some(LookupRule::Linear) => Lookup::Linear,
    };
    let indexed_by = match args.indexed_by {
        None | Some(IndexRule::Light) => Given::Light,
        Some(IndexRule::Viewer) => Given::Viewer,
    };
    let options =
        Options { edges: args.edge.map(EdgeRule::edges).unwrap_or_default(), lookup, indexed_by, ..Options::default() };
    if is_standard_input(&args.file) && args.pairs.as_deref().is_some_and(is_standard_input) {
        let message = "-: found the standard input for both the material and --pairs; expected a file for one of them";
        return Err(Failure::Usage(message.into()));
    }
    let (_, document) = args.reading.open(&args.file)?;
    args.check_options(&document)?;
    warn_of_guesses(&args.file, &document);
    let mut source = match (args.wi, args.wo, args.angles, &args.pairs) {
        (Some(wi), Some(wo), ..) => Source::One(Some(Pair { wi, wo })),
        (_, _, Some(angles), _) => {
            // A table with refraction measures theta from the refracted ray.
            let zenith = |sigma| {
                let Some(Data::Specular(samples)) = document.only() else { return sigma };
                zenith(samples, &options.edges, sigma)
            };
            let (wi, wo) = angles_to_directions(angles.map(f64::to_radians), zenith);
            Source::One(Some(Pair { wi, wo }))
        }
        (.., Some(file)) => Source::Many(Pairs::open(file)?),
        _ => return Err(Failure::Usage("found no directions; expected --wi and --wo, --angles or --pairs".into())),
    };
    let mut material = Material::from_document(&document, &options).map_err(|error| error.in_file(&args.file))?;
    if args.strict {
        let backend = material.backend().strict();
        material = material.with_backend(backend);
    }
    let all = material.channels().names();
    let chosen = choose(&all, &args.channels)?;
    let names: Vec<&str> = chosen.iter().map(|&channel| all[channel].as_str()).collect();

    let narrow = |direction: [f64; 3]| direction.map(|c| c as f32);
    let mut out = message::out(args.json);
    let mut count = 0;
    loop {
        let pairs = source.read()?;
        if pairs.is_empty() {
            break;
        }
        count += pairs.len();
        let (wi, wo): (Vec<_>, Vec<_>) = pairs.iter().map(|pair| (narrow(pair.wi), narrow(pair.wo))).unzip();
        // A spectrum may have a million channels, so the number of pairs at a time is limited by memory.
        let at_once = (AT_ONCE / all.len()).max(1);
        let mut values = vec![0.0; at_once.min(pairs.len()) * all.len()];
        for ((pairs, wi), wo) in pairs.chunks(at_once).zip(wi.chunks(at_once)).zip(wo.chunks(at_once)) {
            let values = &mut values[..pairs.len() * all.len()];
            material.eval_batch(wi, wo, values);
            for (pair, texel) in pairs.iter().zip(values.chunks_exact(all.len())) {
                let factor = if args.cosine { pair.wo[2].abs() } else { 1.0 };
                let texel: Vec<f32> =
                    chosen.iter().map(|&channel| (f64::from(texel[channel]) * factor) as f32).collect();
                args.print(&mut out, pair, &names, &texel)?;
            }
        }
        // A program that sends pairs one by one waits for the answers.
        out.flush()?;
    }
    if count == 0 {
        say("warning: found no pairs of directions");
    }
    Ok(())
}

/// The number of values that are evaluated before they are printed.
const AT_ONCE: usize = 1 << 24;

/// The source of pairs.
enum Source {
    One(Option<Pair>),
    Many(Pairs),
}

impl Source {
    /// The next pairs; none at the end.
    fn read(&mut self) -> Result<Vec<Pair>, Failure> {
        match self {
            Source::One(pair) => Ok(pair.take().into_iter().collect()),
            Source::Many(pairs) => pairs.read(),
        }
    }
}

impl Args {
    fn print(&self, out: &mut impl Write, pair: &Pair, names: &[&str], texel: &[f32]) -> Result<(), Failure> {
        if self.json {
            let answer = Answer { wi: pair.wi, wo: pair.wo, channels: names, values: texel };
            serde_json::to_writer(&mut *out, &answer)?;
            writeln!(out)?;
        } else if self.pairs.is_some() {
            let digits: Vec<String> = texel.iter().copied().map(shortest).collect();
            writeln!(out, "{}", digits.join(","))?;
        } else {
            for (name, &value) in names.iter().zip(texel) {
                writeln!(out, "{name} {}", shortest(value))?;
            }
        }
        Ok(())
    }

    /// Refuses options that would make no difference, because users who give one expect an effect.
    fn check_options(&self, document: &Document) -> Result<(), Failure> {
        let uses = document.uses();
        let check = |option: &str, is_given: bool, applies: bool, expected: &str| match is_given && !applies {
            true => Err(Failure::Usage(format!(
                "{option}: found {} in {}; expected {expected}",
                document.kinds(),
                self.file.display()
            ))),
            false => Ok(()),
        };
        check("--edge", self.edge.is_some(), uses.edges, "a table in specular coordinates")?;
        check("--lookup", self.lookup.is_some(), uses.lookup, "a grid of half and difference angles")?;
        check("--indexed-by", self.indexed_by.is_some(), uses.indexed_by, "a material of the EPFL database")
    }
}

/// Specular coordinates in degrees: the polar angle of the light, the angle to the mirror direction, and two azimuths.
fn parse_specular(text: &str) -> Result<[f64; 4], String> {
    let angles: [f64; 4] = parse_numbers(text)?;
    match angles {
        [sigma, ..] if !(0.0..=90.0).contains(&sigma) => Err(format!("found sigma {sigma}; expected 0 to 90 degrees")),
        [_, _, theta, _] if !(0.0..=180.0).contains(&theta) => {
            Err(format!("found theta {theta}; expected 0 to 180 degrees"))
        }
        _ => Ok(angles),
    }
}

/// The positions of the requested channels, or of all.
fn choose(all: &[String], asked: &[String]) -> Result<Vec<usize>, Failure> {
    if asked.is_empty() {
        return Ok((0..all.len()).collect());
    }
    let find = |name: &String| all.iter().position(|channel| channel.eq_ignore_ascii_case(name));
    let position = |name| {
        let unknown = || Failure::Usage(format!("found no channel {name}; expected one of {}", all.join(", ")));
        find(name).ok_or_else(unknown)
    };
    asked.iter().map(position).collect()
}

/// The shortest decimal that reads back as this `f32`.
fn shortest(value: f32) -> String {
    let digits = format!("{value:?}");
    digits.strip_suffix(".0").map_or(digits.clone(), String::from)
}
