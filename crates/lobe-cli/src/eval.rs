//! `lobe eval`: values of a table at given directions.

use std::io::{BufWriter, Write, stdout};
use std::path::PathBuf;

use clap::{ArgGroup, ValueEnum};
use lobe_formats::{Document, nine_digits, open};
use lobe_table::coords::angles_to_directions;
use lobe_table::reference::zenith;
use lobe_table::{Edges, Samples};
use serde::Serialize;

use crate::evaluate::evaluate;
use crate::failure::Failure;
use crate::pairs::{Pair, parse_direction, parse_numbers, read_pairs};

/// Evaluate a table: f in 1/sr, without the cosine, for one pair of directions or for many.
#[derive(clap::Args)]
#[command(
    group(ArgGroup::new("query").required(true).args(["wi", "angles", "pairs"])),
    after_help = "Directions point away from the surface, with the normal on +z: wi to the light, wo to the viewer. They are normalised. Below the horizon f is 0; tables of transmission take either sign of z.

Examples:
  lobe eval paint.ddr --wi -0.5,0,0.8 --wo 0.4,0.1,0.9
  lobe eval paint.ddr --angles 30,0,5,180          sigma, psi, theta, phi in degrees
  lobe eval paint.ddr --pairs pairs.csv > f.csv    a line `wi.x,wi.y,wi.z,wo.x,wo.y,wo.z` a pair
  generate | lobe eval paint.ddr --edge zero --pairs -"
)]
pub struct Args {
    /// The file of a measured BRDF or BTDF.
    file: PathBuf,
    /// The direction to the light.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "wo", value_parser = parse_direction)]
    wi: Option<[f64; 3]>,
    /// The direction to the viewer.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "wi", value_parser = parse_direction)]
    wo: Option<[f64; 3]>,
    /// Specular coordinates in degrees in place of two directions.
    #[arg(long, value_name = "SIGMA,PSI,THETA,PHI", allow_hyphen_values = true, value_parser = parse_numbers::<4>)]
    angles: Option<[f64; 4]>,
    /// A CSV file with six columns, wi then wo; `-` is the standard input. Prints a line of channels for each pair.
    #[arg(long, value_name = "FILE")]
    pairs: Option<PathBuf>,
    /// What happens beyond the outermost angles of the table.
    #[arg(long, value_enum, default_value = "clamp")]
    edge: EdgeRule,
    /// Print JSON: an object, or with --pairs an object a line.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum EdgeRule {
    /// The value at the nearest angle that was measured; psi and phi are full circles; never negative.
    Clamp,
    /// Straight lines beyond the ends of all four axes; negative values are kept.
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

#[derive(Serialize)]
struct Answer<'a> {
    wi: [f64; 3],
    wo: [f64; 3],
    channels: &'a [String],
    values: &'a [f32],
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let samples = read_table(args)?;
    let edges = args.edge.edges();
    let pairs = match (args.wi, args.wo, args.angles, &args.pairs) {
        (Some(wi), Some(wo), ..) => vec![Pair { wi, wo }],
        (_, _, Some(angles), _) => {
            let radians = angles.map(f64::to_radians);
            let (wi, wo) = angles_to_directions(radians, |sigma| zenith(&samples, &edges, sigma));
            vec![Pair { wi, wo }]
        }
        (.., Some(file)) => read_pairs(file)?,
        _ => return Err(Failure::Usage("found no directions; expected --wi and --wo, --angles or --pairs".into())),
    };
    let values = evaluate(&samples, &edges, &pairs);

    let names = samples.channels().names();
    let mut out = BufWriter::new(stdout().lock());
    for (pair, texel) in pairs.iter().zip(values.chunks_exact(names.len())) {
        let digits = texel.iter().map(|&value| nine_digits(f64::from(value)));
        if args.json {
            let answer = Answer { wi: pair.wi, wo: pair.wo, channels: &names, values: texel };
            serde_json::to_writer(&mut out, &answer)?;
            writeln!(out)?;
        } else if args.pairs.is_some() {
            writeln!(out, "{}", digits.collect::<Vec<_>>().join(","))?;
        } else {
            for (name, value) in names.iter().zip(digits) {
                writeln!(out, "{name} {value}")?;
            }
        }
    }
    Ok(out.flush()?)
}

fn read_table(args: &Args) -> Result<Samples, Failure> {
    match open(&args.file)? {
        (_, Document::Table(measured)) => Ok(measured.data),
        (format, _) => {
            let file = args.file.display();
            Err(Failure::File(format!("{file}: found {format}, which is no table; expected that of a BRDF or BTDF")))
        }
    }
}
