//! Writes SSDD.

use std::io::{self, Write};
use std::path::Path;

use lobe_table::{Channels, Scatter};

use super::{Block, Data};
use crate::replace::replace_file;

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Decimal numbers, with as many digits as an `f32` needs.
    Ascii,
    /// Little-endian `f32`.
    Binary,
}

/// Writes a file. Values come back exactly, angles to a billionth of a degree. The file appears whole or not at all.
///
/// # Errors
/// What the file system says; [`io::ErrorKind::InvalidInput`] without a block, and for two blocks of the same type.
pub fn write(blocks: &[Block], encoding: Encoding, path: &Path) -> io::Result<()> {
    let types: Vec<&str> = blocks.iter().map(|block| data_type(&block.data)).collect();
    let is_repeated = types.iter().enumerate().any(|(index, kind)| types[..index].contains(kind));
    if blocks.is_empty() || is_repeated {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "an SSDD file has one to four blocks of different types",
        ));
    }
    replace_file(path, |out| {
        writeln!(out, "VERSION 0.3")?;
        writeln!(out, "API lobe-{}", env!("CARGO_PKG_VERSION"))?;
        blocks.iter().try_for_each(|block| write_block(out, block, encoding))
    })
}

fn data_type(data: &Data) -> &'static str {
    let (scatter, is_delta) = match data {
        Data::Specular(samples) => (samples.scatter(), false),
        Data::Spherical(grid) => (grid.scatter(), false),
        Data::Delta(delta) => (delta.scatter, true),
    };
    match (scatter, is_delta) {
        (Scatter::Reflection, false) => "brdf",
        (Scatter::Transmission, false) => "btdf",
        (Scatter::Reflection, true) => "specular_reflectance",
        (Scatter::Transmission, true) => "specular_transmittance",
    }
}

fn write_block(out: &mut dyn Write, block: &Block, encoding: Encoding) -> io::Result<()> {
    let (params, offsets, channels, values, system): (Vec<&[f64]>, _, _, _, _) = match &block.data {
        Data::Specular(samples) => {
            let params = samples.knots().iter().map(Vec::as_slice).collect();
            (params, samples.refraction(), samples.channels(), samples.values(), Some("specular_coordinate_system"))
        }
        Data::Spherical(grid) => {
            let params = grid.knots().iter().map(Vec::as_slice).collect();
            (params, None, grid.channels(), grid.values(), Some("spherical_coordinate_system"))
        }
        Data::Delta(delta) => (vec![&delta.thetas, &delta.phis], None, &delta.channels, &delta.values, None),
    };
    writeln!(out, "\nDATA_TYPE {}", data_type(&block.data))?;
    match channels {
        Channels::Mono => writeln!(out, "COLOR_MODEL monochrome")?,
        Channels::Rgb => writeln!(out, "COLOR_MODEL rgb")?,
        Channels::Xyz => writeln!(out, "COLOR_MODEL xyz")?,
        Channels::Spectral(wavelengths) => {
            write!(out, "COLOR_MODEL spectrum\nWAVELENGTH_LIST")?;
            wavelengths.iter().try_for_each(|nm| write!(out, " {nm}"))?;
            writeln!(out)?;
        }
    }
    if let Some(system) = system {
        writeln!(out, "PARAM_TYPE {system}")?;
    }
    for (index, knots) in params.iter().enumerate() {
        list(out, index, knots)?;
    }
    if let Some(offsets) = offsets {
        list(out, 4, offsets)?;
    }
    // A line end would end the name early and start another key.
    let name = block.name.split_whitespace().collect::<Vec<_>>().join(" ");
    if !name.is_empty() {
        writeln!(out, "NAME {name}")?;
    }
    let keyword = if encoding == Encoding::Ascii { "ascii" } else { "binary" };
    writeln!(out, "DATA {keyword}")?;
    let size = |axis: usize| params.get(axis).map_or(1, |knots| knots.len());
    for p3 in 0..size(3) {
        for p2 in 0..size(2) {
            for p1 in 0..size(1) {
                for p0 in 0..size(0) {
                    let at = ((p0 * size(1) + p1) * size(2) + p2) * size(3) + p3;
                    colour(out, &values[at * channels.count()..][..channels.count()], encoding)?;
                }
            }
        }
    }
    Ok(())
}

fn list(out: &mut dyn Write, index: usize, angles: &[f64]) -> io::Result<()> {
    write!(out, "PARAM{index}_LIST")?;
    // 15 degrees are to be written as 15, though they are 14.999999999999998 after a way through radians.
    angles.iter().try_for_each(|angle| write!(out, " {}", (angle.to_degrees() * 1e9).round() / 1e9))?;
    writeln!(out)
}

fn colour(out: &mut dyn Write, values: &[f32], encoding: Encoding) -> io::Result<()> {
    match encoding {
        Encoding::Binary => values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes())),
        Encoding::Ascii => {
            let words: Vec<String> = values.iter().map(f32::to_string).collect();
            writeln!(out, "{}", words.join(" "))
        }
    }
}
