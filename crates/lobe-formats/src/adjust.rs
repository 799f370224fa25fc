//! Conversion of values that are not yet `f`: other quantities, a factor, stated totals.

use std::f64::consts::PI;
use std::path::Path;

use lobe_table::{Data, scattered, specular, spherical};

use crate::integra::units::{divide_nodes_by_cosine, scale_slices};
use crate::reading::{Quantity, ReadOptions, Scale};
use crate::{Document, FormatError, Place, totals};

/// The smallest cosine by which a value is divided: that of 89.9 degrees.
const HORIZON: f64 = 1.745e-3;

/// Converts the values to `f` as the options say. `is_table`: the reader has already converted the quantity.
pub(crate) fn adjust(
    mut document: Document,
    options: &ReadOptions,
    is_table: bool,
    file: &Path,
) -> Result<Document, FormatError> {
    match options.values.filter(|_| !is_table) {
        None | Some(Quantity::F) => {}
        Some(Quantity::LuminanceFactor) => each(&mut document, |data| multiply(data, 1.0 / PI, file))?,
        Some(Quantity::FCos) => each(&mut document, |data| divide(data, file))?,
    }
    match options.scale {
        None => {}
        Some(Scale::By(factor)) => each(&mut document, |data| multiply(data, factor, file))?,
        Some(Scale::Tis) => to_totals(&mut document, file)?,
    }
    let note = |what: String| format!("{what}, as the options say");
    if let Some(quantity) = options.values.filter(|_| !is_table) {
        document.notes.push(note(format!("values are {quantity}")));
    }
    if let Some(scale) = options.scale {
        document.notes.push(match scale {
            Scale::By(factor) => note(format!("values multiplied by {factor}")),
            Scale::Tis => note("each block scaled to its total integrated scatter".into()),
        });
    }
    Ok(document)
}

fn each(document: &mut Document, change: impl Fn(&Data) -> Result<Data, FormatError>) -> Result<(), FormatError> {
    for part in &mut document.parts {
        part.data = change(&part.data)?;
    }
    Ok(())
}

fn multiply(data: &Data, factor: f64, file: &Path) -> Result<Data, FormatError> {
    let scaled = |values: &[f32]| values.iter().map(|value| (f64::from(*value) * factor) as f32).collect();
    let (channels, kind) = (data.representation().channels(), data.representation().kind());
    let mut data = data.clone();
    match data.representation_mut().map_channels(channels, &scaled) {
        Ok(true) => Ok(data),
        Ok(false) => {
            let found = format!("{} data", kind.name());
            Err(FormatError::new(file, Place::File, found, "data whose values can be scaled"))
        }
        Err(error) => Err(FormatError::new(file, Place::File, error.found, error.expected)),
    }
}

fn divide(data: &Data, file: &Path) -> Result<Data, FormatError> {
    let invalid =
        |error: String| FormatError::new(file, Place::File, error, "values that can be divided by the cosine");
    match data {
        Data::Specular(samples) => divide_nodes_by_cosine(file, samples).map(Data::Specular),
        Data::Spherical(grid) => {
            let (knots, count) = (grid.knots(), grid.channels().count());
            let [_, _, thetas, phis] = knots.each_ref().map(Vec::len);
            let mut values = grid.values().to_vec();
            for slice in values.chunks_exact_mut(thetas * phis * count) {
                for (row, theta) in slice.chunks_exact_mut(phis * count).zip(&knots[2]) {
                    let cosine = theta.cos().max(HORIZON);
                    row.iter_mut().for_each(|value| *value = (f64::from(*value) / cosine) as f32);
                }
            }
            let divided = spherical::Data::new(grid.scatter(), knots.clone(), grid.channels().clone(), values);
            let divided = divided.and_then(|divided| if grid.is_mirrored() { divided.mirrored() } else { Ok(divided) });
            divided.map(Data::Spherical).map_err(|error| invalid(error.to_string()))
        }
        Data::Scattered(samples) => {
            let count = samples.channels().count();
            let above = samples.samples().filter(|(angles, _)| angles[2].cos() > HORIZON);
            let (angles, values): (Vec<[f64; 4]>, Vec<&[f32]>) = above.unzip();
            let mut values = values.concat();
            for (texel, angles) in values.chunks_exact_mut(count).zip(&angles) {
                texel.iter_mut().for_each(|value| *value = (f64::from(*value) / angles[2].cos()) as f32);
            }
            let divided = scattered::Data::new(samples.scatter(), samples.channels().clone(), &angles, &values);
            divided.map(Data::Scattered).map_err(|error| invalid(error.to_string()))
        }
        other => Err(invalid(format!("{} data", other.representation().kind().name()))),
    }
}

/// Scales each block so that its integral is the total that the file states for it.
fn to_totals(document: &mut Document, file: &Path) -> Result<(), FormatError> {
    let refused = |found: String| {
        let expected = "scale = tis for a file that states the total integrated scatter of each of its blocks";
        FormatError::new(file, Place::File, found, expected)
    };
    let mut blocks = Vec::new();
    for part in &document.parts {
        let (Data::Specular(_) | Data::Spherical(_)) = &part.data else {
            return Err(refused(format!("{} data", part.data.representation().kind().name())));
        };
        blocks.push(part.data.representation().channels().count() * incidences(&part.data));
    }
    if document.tis.is_empty() || document.tis.len() != blocks.iter().sum::<usize>() {
        let found =
            format!("{} stated totals for {} blocks of values", document.tis.len(), blocks.iter().sum::<usize>());
        return Err(refused(found));
    }
    let mut left = document.tis.as_slice();
    for (part, blocks) in document.parts.iter_mut().zip(blocks) {
        let (of_part, rest) = left.split_at(blocks);
        left = rest;
        part.data = match &part.data {
            Data::Specular(samples) => {
                let of_channels = of_part.chunks_exact(incidences(&part.data));
                let of_channels =
                    of_channels.map(|of| of.iter().map(|&tis| f64::from(tis)).collect()).collect::<Vec<_>>();
                Data::Specular(scaled(file, samples, &of_channels)?)
            }
            Data::Spherical(grid) => Data::Spherical(totals::scale(file, grid, of_part)?),
            other => other.clone(),
        };
    }
    Ok(())
}

/// The number of incident directions of a grid.
fn incidences(data: &Data) -> usize {
    let count = |knots: &[Vec<f64>; 4]| knots[0].len() * knots[1].len();
    match data {
        Data::Specular(samples) => count(samples.knots()),
        Data::Spherical(grid) => count(grid.knots()),
        _ => 0,
    }
}

fn scaled(file: &Path, samples: &specular::Data, totals: &[Vec<f64>]) -> Result<specular::Data, FormatError> {
    scale_slices(file, samples, totals, "the stated total integrated scatter")
}
