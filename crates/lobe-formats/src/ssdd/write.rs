//! Writes SSDD.

use std::io::{self, Write};
use std::path::Path;

use lobe_table::{Channels, Data, Scatter};

use crate::{FormatError, Part};
use lobe_files::{unwritable, write_whole};

/// The encoding of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Decimal numbers, with as many digits as an `f32` needs.
    Ascii,
    /// Little-endian `f32`.
    Binary,
}

/// Writes a file. Values are restored exactly, angles to a billionth of a degree. The file appears whole or not at all.
///
/// # Errors
/// [`FormatError`] if the file system refuses, or the format cannot express the document: no block, two of the same
/// type, scattered samples, halves of mirrored grids, bands with only names, and one side of a sheet.
pub fn write(blocks: &[Part], encoding: Encoding, path: &Path) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(blocks, encoding).map_err(|error| unwritable(path, &error))?)
}

fn to_bytes(blocks: &[Part], encoding: Encoding) -> io::Result<Vec<u8>> {
    let types = blocks.iter().map(|block| data_type(&block.data)).collect::<io::Result<Vec<_>>>()?;
    let is_repeated = types.iter().enumerate().any(|(index, kind)| types[..index].contains(kind));
    if blocks.is_empty() || is_repeated {
        return Err(unfit("no block, or two of the same type, in an SSDD file"));
    }
    if blocks.iter().any(|block| block.side.is_some()) {
        return Err(unfit("one side of a sheet, which an SSDD file cannot state"));
    }
    let mut out = Vec::new();
    writeln!(out, "VERSION 0.3")?;
    writeln!(out, "API lobe-{}", env!("CARGO_PKG_VERSION"))?;
    blocks.iter().zip(types).try_for_each(|(block, data_type)| write_block(&mut out, block, data_type, encoding))?;
    Ok(out)
}

fn unfit(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why)
}

fn data_type(data: &Data) -> io::Result<&'static str> {
    let is_delta = match data {
        Data::Spherical(grid) if grid.is_mirrored() => {
            return Err(unfit("half of a mirrored grid in spherical coordinates"));
        }
        Data::Specular(_) | Data::Spherical(_) => false,
        Data::Mirror(_) => true,
        other => {
            let kind = other.representation().kind();
            return Err(unfit(&format!("a {kind}, not a grid in specular or spherical coordinates")));
        }
    };
    Ok(match (data.representation().scatter(), is_delta) {
        (Scatter::Reflection, false) => "brdf",
        (Scatter::Transmission, false) => "btdf",
        (Scatter::Reflection, true) => "specular_reflectance",
        (Scatter::Transmission, true) => "specular_transmittance",
    })
}

fn write_block(out: &mut Vec<u8>, block: &Part, data_type: &str, encoding: Encoding) -> io::Result<()> {
    let (params, offsets, values, system) = match &block.data {
        Data::Specular(samples) => {
            (samples.knots().as_slice(), samples.refraction(), samples.values(), Some("specular_coordinate_system"))
        }
        Data::Spherical(grid) => (grid.knots().as_slice(), None, grid.values(), Some("spherical_coordinate_system")),
        Data::Mirror(mirror) => (mirror.knots().as_slice(), None, mirror.values(), None),
        other => return Err(unfit(other.representation().kind().name())),
    };
    let channels = block.data.representation().channels();
    writeln!(out, "\nDATA_TYPE {data_type}")?;
    match &channels {
        Channels::Mono => writeln!(out, "COLOR_MODEL monochrome")?,
        Channels::Rgb => writeln!(out, "COLOR_MODEL rgb")?,
        Channels::Xyz => writeln!(out, "COLOR_MODEL xyz")?,
        Channels::Spectral(wavelengths) => {
            write!(out, "COLOR_MODEL spectrum\nWAVELENGTH_LIST")?;
            wavelengths.iter().try_for_each(|nm| write!(out, " {nm}"))?;
            writeln!(out)?;
        }
        Channels::Named(_) => return Err(unfit("bands that have only names")),
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

fn list(out: &mut Vec<u8>, index: usize, angles: &[f64]) -> io::Result<()> {
    write!(out, "PARAM{index}_LIST")?;
    // Writes 15 degrees as 15, although a conversion through radians gives 14.999999999999998.
    angles.iter().try_for_each(|angle| write!(out, " {}", (angle.to_degrees() * 1e9).round() / 1e9))?;
    writeln!(out)
}

fn colour(out: &mut Vec<u8>, values: &[f32], encoding: Encoding) -> io::Result<()> {
    match encoding {
        Encoding::Binary => values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes())),
        Encoding::Ascii => {
            let words: Vec<String> = values.iter().map(f32::to_string).collect();
            writeln!(out, "{}", words.join(" "))
        }
    }
}
