//! Writes tables with named columns as CSV.

use std::fmt::Write as _;
use std::path::Path;

use lobe_table::{Channels, Data, Scatter};

use super::{SPECULAR, SPHERICAL, TRANSMISSION};
use crate::{FormatError, Place};
use lobe_files::write_whole;

/// Writes `path` whole or not at all: a line a node or sample, angles in degrees, then the channels. Angles have nine
/// digits after the point; values come back the same when the file is read again.
///
/// A grid comes back as the same grid, with two exceptions: a table in specular coordinates that is constant in phi is
/// written with phi 0 and 360, and a spherical grid of less than a whole turn comes back as scattered samples.
///
/// # Errors
/// [`FormatError`] if the file cannot be written, and for what the format cannot say: several bands that have names
/// only, refraction offsets, and mirror reflectances.
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
            header(&mut out, &SPECULAR, &channels);
            let texel = |[s, p, t, h]: [usize; 4]| samples.texel([s, p, t, if is_constant { 0 } else { h }]);
            grid(&mut out, &knots, texel);
        }
        Data::Spherical(grid_data) => {
            let knots = grid_data.knots().each_ref().map(|knots| degrees(knots));
            let (sizes, count) = (knots.each_ref().map(Vec::len), channels.count());
            header(&mut out, &SPHERICAL, &channels);
            grid(&mut out, &knots, |node| {
                let at = (0..4).fold(0, |at, axis| at * sizes[axis] + node[axis]);
                &grid_data.values()[at * count..][..count]
            });
        }
        Data::Scattered(scattered) => {
            header(&mut out, &SPHERICAL, &channels);
            for (angles, values) in scattered.samples() {
                line(&mut out, degrees(&angles).into_iter(), values);
            }
        }
        other => {
            let found = other.representation().kind().name();
            return refuse(found, "values on a grid of specular or spherical coordinates, or scattered samples");
        }
    }
    write_whole(path, out.as_bytes())
}

/// 15 degrees are to be written as 15, though they are 14.999999999999998 after a way through radians.
fn degrees(angles: &[f64]) -> Vec<f64> {
    angles.iter().map(|angle| (angle.to_degrees() * 1e9).round() / 1e9).collect()
}

fn header(out: &mut String, axes: &[&str; 4], channels: &Channels) {
    let angles: Vec<String> = axes.iter().map(|axis| format!("{axis}_deg")).collect();
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
