//! Writing what a file holds as it is, where the format has its representation: no value is computed anew.

use std::path::Path;

use lobe::{Channels, specular};
use lobe_formats::sheet::{Data, Part};
use lobe_formats::ssdd::Encoding;
use lobe_formats::window_xml;
use lobe_formats::{Document, Measured, Specular, ddr, goniometer, merl, npz, rgl, sdr, ssdd, zemax};
use lobe_table::{scattered, spherical};

use crate::channels::ChannelMap;
use crate::failure::Failure;
use crate::target::Target;

/// Writes the document, if the target has its representation; `false` where it has to be resampled.
pub fn write(document: &Document, target: Target, chosen: Option<&str>, out: &Path) -> Result<Option<String>, Failure> {
    match (target, document) {
        (Target::Npz, _) if chosen.is_none() => npz::write(document, out)?,
        (Target::Rgl, Document::Rgl(measured)) if chosen.is_none() => rgl::write(&measured.data, out)?,
        (Target::Merl, Document::HalfDiff(measured)) if chosen.is_none() => merl::write(&measured.data, out)?,
        (Target::Klems, Document::Window(measured)) if chosen.is_none() => window_xml::write(&measured.data, out)?,
        (Target::Ssdd, Document::Sheet(measured)) if chosen.is_none() => {
            ssdd::write(&measured.data, Encoding::Ascii, out)?;
        }
        _ => {
            let Some(data) = data(document).filter(|data| is_native(data, target)) else { return Ok(None) };
            let map = ChannelMap::new(data.channels(), chosen, target)?;
            let data = mapped(data, &map)?;
            write_data(&data, target, out)?;
            let note = map.note.map(|note| format!("; {note}"));
            return Ok(Some(format!("the values and nodes of the file{}", note.unwrap_or_default())));
        }
    }
    Ok(Some("the values and nodes of the file".into()))
}

/// Writes a table in specular coordinates that the target can hold.
pub fn write_table(samples: specular::Data, target: Target, out: &Path) -> Result<(), Failure> {
    write_data(&Data::Table(samples), target, out)
}

fn is_native(data: &Data, target: Target) -> bool {
    match (target, data) {
        (Target::Npz | Target::Csv, _) => !matches!((target, data), (Target::Csv, Data::Specular(_))),
        (Target::Ddr, Data::Table(_)) | (Target::Sdr, Data::Specular(_)) => true,
        (Target::Zemax, Data::Table(samples)) => samples.refraction().is_none(),
        (Target::Ssdd, Data::Spherical(grid)) => !grid.is_mirrored(),
        (Target::Ssdd, Data::Table(_) | Data::Specular(_)) => true,
        _ => false,
    }
}

fn write_data(data: &Data, target: Target, out: &Path) -> Result<(), Failure> {
    match (target, data) {
        (Target::Ddr, Data::Table(samples)) => ddr::write(samples, out)?,
        (Target::Zemax, Data::Table(samples)) => zemax::write(samples, out)?,
        (Target::Sdr, Data::Specular(specular)) => sdr::write(specular, out)?,
        (Target::Csv, data) => goniometer::write(data, out)?,
        (Target::Ssdd, data) => ssdd::write(&[Part::new("", data.clone())], Encoding::Ascii, out)?,
        (Target::Npz, data) => npz::write(&document(data.clone()), out)?,
        _ => return Err(Failure::Usage(format!("{target}: no such table can be written"))),
    }
    Ok(())
}

/// The data of a document that may stand in a sheet.
pub fn data(document: &Document) -> Option<Data> {
    match document {
        Document::Table(measured) => Some(Data::Table(measured.data.clone())),
        Document::Specular(measured) => Some(Data::Specular(measured.data.clone())),
        Document::Spherical(measured) => Some(Data::Spherical(measured.data.clone())),
        Document::Scattered(measured) => Some(Data::Scattered(measured.data.clone())),
        _ => None,
    }
}

/// The document of one measurement.
pub fn document(data: Data) -> Document {
    fn bare<T>(data: T) -> Measured<T> {
        Measured { data, source: Vec::new(), tis: Vec::new() }
    }
    match data {
        Data::Table(data) => Document::Table(bare(data)),
        Data::Spherical(data) => Document::Spherical(bare(data)),
        Data::Scattered(data) => Document::Scattered(bare(data)),
        Data::Specular(data) => Document::Specular(bare(data)),
    }
}

/// The same nodes with other channels.
fn mapped(data: Data, map: &ChannelMap) -> Result<Data, Failure> {
    if map.is_identity() && *data.channels() == map.channels {
        return Ok(data);
    }
    let (channels, scatter): (Channels, _) = (map.channels.clone(), data.scatter());
    let failed = |error: &dyn std::fmt::Display| Failure::File(error.to_string());
    Ok(match data {
        Data::Table(samples) => {
            let mapped = specular::Data::new(scatter, samples.knots().clone(), channels, map.apply(samples.values()));
            let mapped = mapped.map_err(|error| failed(&error))?;
            Data::Table(match samples.refraction() {
                Some(offsets) => mapped.with_refraction(offsets.to_vec()).map_err(|error| failed(&error))?,
                None => mapped,
            })
        }
        Data::Spherical(grid) => {
            let mapped = spherical::Data::new(scatter, grid.knots().clone(), channels, map.apply(grid.values()));
            let mapped = mapped.and_then(|mapped| if grid.is_mirrored() { mapped.mirrored() } else { Ok(mapped) });
            Data::Spherical(mapped.map_err(|error| failed(&error))?)
        }
        Data::Scattered(samples) => {
            let (angles, values): (Vec<_>, Vec<_>) = samples.samples().unzip();
            let mapped = scattered::Data::new(scatter, channels, &angles, &map.apply(&values.concat()));
            Data::Scattered(mapped.map_err(|error| failed(&error))?)
        }
        Data::Specular(specular) => {
            let mapped = Specular::new(scatter, specular.knots().clone(), channels, map.apply(specular.values()));
            Data::Specular(
                mapped.ok_or_else(|| failed(&"values that are not finite after their channels were mapped"))?,
            )
        }
    })
}
