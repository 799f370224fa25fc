//! Writing the contents of a file unchanged, if the format has its representation: no value is recomputed.

use std::path::Path;

use lobe::{Channels, Data};
use lobe_formats::ssdd::Encoding;
use lobe_formats::{Document, Part, ddr, goniometer, merl, npz, rgl, sdr, ssdd, window_xml, zemax};
use lobe_table::{mirror, scattered, specular, spherical};

use crate::channels::ChannelMap;
use crate::failure::Failure;
use crate::target::Target;

/// Writes the document, if the target has its representation; `false` if it must be resampled.
pub fn write(document: &Document, target: Target, chosen: Option<&str>, out: &Path) -> Result<Option<String>, Failure> {
    match (target, document.only()) {
        (Target::Npz, _) if chosen.is_none() => npz::write(document, out)?,
        (Target::Rgl, Some(Data::Rgl(data))) if chosen.is_none() => rgl::write(data, out)?,
        (Target::Merl, Some(Data::HalfDiff(data))) if chosen.is_none() => merl::write(data, out)?,
        (Target::Klems, Some(Data::Window(data))) if chosen.is_none() => {
            window_xml::write(data, &document.source, out)?
        }
        (Target::Ssdd, None) if chosen.is_none() => ssdd::write(&document.parts, Encoding::Ascii, out)?,
        (_, Some(data)) if is_native(data, target) => {
            let map = ChannelMap::new(&data.representation().channels(), chosen, target)?;
            let data = mapped(data, &map)?;
            write_data(&data, target, out)?;
            let note = map.note.map(|note| format!("; {note}"));
            return Ok(Some(format!("the values and nodes of the file{}", note.unwrap_or_default())));
        }
        _ => return Ok(None),
    }
    Ok(Some("the values and nodes of the file".into()))
}

/// Writes a table in specular coordinates that the target can hold.
pub fn write_table(samples: specular::Data, target: Target, out: &Path) -> Result<(), Failure> {
    write_data(&Data::Specular(samples), target, out)
}

fn is_native(data: &Data, target: Target) -> bool {
    match (target, data) {
        (Target::Npz, Data::Specular(_) | Data::Spherical(_) | Data::Scattered(_) | Data::Mirror(_)) => true,
        (Target::Csv, Data::Specular(_) | Data::Spherical(_) | Data::Scattered(_)) => true,
        (Target::Ddr, Data::Specular(_)) | (Target::Sdr, Data::Mirror(_)) => true,
        (Target::Zemax, Data::Specular(samples)) => samples.refraction().is_none(),
        (Target::Ssdd, Data::Spherical(grid)) => !grid.is_mirrored(),
        (Target::Ssdd, Data::Specular(_) | Data::Mirror(_)) => true,
        _ => false,
    }
}

fn write_data(data: &Data, target: Target, out: &Path) -> Result<(), Failure> {
    match (target, data) {
        (Target::Ddr, Data::Specular(samples)) => ddr::write(samples, out)?,
        (Target::Zemax, Data::Specular(samples)) => zemax::write(samples, out)?,
        (Target::Sdr, Data::Mirror(mirror)) => sdr::write(mirror, out)?,
        (Target::Csv, data) => goniometer::write(data, out)?,
        (Target::Ssdd, data) => ssdd::write(&[Part::new("", data.clone())], Encoding::Ascii, out)?,
        (Target::Npz, data) => npz::write(&Document::new(data.clone()), out)?,
        _ => return Err(Failure::Usage(format!("{target}: such a table cannot be written"))),
    }
    Ok(())
}

/// The same nodes with other channels.
fn mapped(data: &Data, map: &ChannelMap) -> Result<Data, Failure> {
    if map.is_identity() && data.representation().channels() == map.channels {
        return Ok(data.clone());
    }
    let (channels, scatter): (Channels, _) = (map.channels.clone(), data.representation().scatter());
    let failed = |error: &dyn std::fmt::Display| Failure::File(error.to_string());
    Ok(match data {
        Data::Specular(samples) => {
            let mapped = specular::Data::new(scatter, samples.knots().clone(), channels, map.apply(samples.values()));
            let mapped = mapped.map_err(|error| failed(&error))?;
            Data::Specular(match samples.refraction() {
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
        Data::Mirror(mirror) => {
            let mapped = mirror::Data::new(scatter, mirror.knots().clone(), channels, map.apply(mirror.values()));
            Data::Mirror(mapped.ok_or_else(|| failed(&"values that are not finite after their channels were mapped"))?)
        }
        other => return Err(failed(&format!("the channels of {} cannot be mapped", other.representation().kind()))),
    })
}
