//! Writes tables with named columns as CSV.

use std::fmt::Write as _;
use std::path::Path;

use lobe_table::{Channels, Data, Scatter};

use super::{ROWS, Rows, SPECULAR, SPHERICAL, TRANSMISSION};
use crate::angle::Unit;
use crate::listed::samples_of;
use crate::{FormatError, Place};
use lobe_files::write_whole;

/// Writes `path` completely or not at all: one line per node or sample, with angles in degrees and then the channels;
/// all values are the same when the file is read again.
///
/// A grid is restored as the same grid, its angles to a billionth of a degree, except that a table in specular
/// coordinates that is constant in phi is written with phi 0 and 360. If the rows do not show it, a comment says that
/// they are the nodes of a grid, or samples. Samples are restored bit for bit, so that they are interpolated as before;
/// they are written in radians if degrees would not restore one of them.
///
/// # Errors
/// [`FormatError`] if the file cannot be written, or the format cannot express the data: several bands with only names,
/// refraction offsets, and mirror reflectances.
pub fn write(data: &Data, path: &Path) -> Result<(), FormatError> {
    let refuse = |found: &str, expected: &str| Err(FormatError::new(path, Place::File, found, expected));
    let (channels, scatter) = (data.representation().channels(), data.representation().scatter());
    if let Channels::Named(names) = &channels
        && names.len() > 1
    {
        return refuse(&format!("the channels {}", names.join(" ")), "one channel, R G B, X Y Z or wavelengths");
    }
    let mut out = String::new();
    if scatter == Scatter::Transmission {
        let _ = writeln!(out, "# {TRANSMISSION}");
    }
    match data {
        Data::Specular(samples) if samples.refraction().is_some() => {
            return refuse("refraction offsets", "none in this format");
        }
        Data::Specular(samples) => {
            let mut knots = samples.knots().each_ref().map(|knots| degrees(knots));
            let is_constant = knots[3].len() == 1;
            if is_constant {
                knots[3] = vec![0.0, 360.0];
            }
            rows(&mut out, Rows::of_grid(&knots, false));
            header(&mut out, &SPECULAR, "deg", &channels);
            let texel = |[s, p, t, h]: [usize; 4]| samples.texel([s, p, t, if is_constant { 0 } else { h }]);
            grid(&mut out, &knots, texel);
        }
        Data::Spherical(grid_data) => {
            let knots = grid_data.knots().each_ref().map(|knots| degrees(knots));
            let (sizes, count) = (knots.each_ref().map(Vec::len), channels.count());
            rows(&mut out, Rows::of_grid(&knots, grid_data.is_mirrored()));
            header(&mut out, &SPHERICAL, "deg", &channels);
            grid(&mut out, &knots, |node| {
                let at = (0..4).fold(0, |at, axis| at * sizes[axis] + node[axis]);
                &grid_data.values()[at * count..][..count]
            });
        }
        Data::Scattered(scattered) => {
            rows(&mut out, Some(Rows::Samples));
            let (samples, unit) = samples_of(scattered, 0.0);
            header(&mut out, &SPHERICAL, if unit == Unit::Deg { "deg" } else { "rad" }, &channels);
            samples.iter().for_each(|sample| line(&mut out, sample.angles.into_iter(), sample.values));
        }
        other => {
            let found = other.representation().kind().name();
            return refuse(found, "values on a grid of specular or spherical coordinates, or scattered samples");
        }
    }
    write_whole(path, out.as_bytes())
}

impl Rows {
    /// The comment that the nodes of a grid need; `None` if they need none.
    fn of_grid(knots: &[Vec<f64>; 4], is_mirrored: bool) -> Option<Rows> {
        let (first, last) = (knots[3].first()?, knots[3].last()?);
        let shows = last - first > 180.0 + 1e-4 && knots[2].len() > 1;
        match (is_mirrored, shows) {
            (true, _) => Some(Rows::MirroredGrid),
            (false, false) => Some(Rows::Grid),
            (false, true) => None,
        }
    }
}

fn rows(out: &mut String, rows: Option<Rows>) {
    if let Some(rows) = rows {
        let _ = writeln!(out, "# {ROWS}: {}", rows.word());
    }
}

/// Writes 15 degrees as 15, although a conversion through radians gives 14.999999999999998.
fn degrees(angles: &[f64]) -> Vec<f64> {
    angles.iter().map(|angle| (angle.to_degrees() * 1e9).round() / 1e9).collect()
}

fn header(out: &mut String, axes: &[&str; 4], unit: &str, channels: &Channels) {
    let angles: Vec<String> = axes.iter().map(|axis| format!("{axis}_{unit}")).collect();
    let _ = writeln!(out, "{},{}", angles.join(","), channels.names().join(","));
}

fn grid<'a>(out: &mut String, knots: &[Vec<f64>; 4], texel: impl Fn([usize; 4]) -> &'a [f32]) {
    let [a, b, c, d] = knots.each_ref().map(Vec::len);
    for node in 0..a * b * c * d {
        let node = [node / (b * c * d), node / (c * d) % b, node / d % c, node % d];
        line(out, (0..4).map(|axis| knots[axis][node[axis]]), texel(node));
    }
}

fn line(out: &mut String, angles: impl Iterator<Item = f64>, values: &[f32]) {
    let mut separator = "";
    for angle in angles {
        let _ = write!(out, "{separator}{angle}");
        separator = ",";
    }
    for value in values {
        let _ = write!(out, ",{value}");
    }
    out.push('\n');
}
