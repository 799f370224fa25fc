//! LightTools `.bsdf`: tables on a grid of ordinary spherical coordinates.
//!
//! `#` comments and words. The head has `Symmetry` (`PlaneSymmetrical` or `Asymmetric`), `SpectralContent` (`Monochrome`
//! or `XYZ`), `ScatterAzimuth n ...` and `ScatterRadial n ...` in degrees, and `DataBegin`. Then, in any order, a table for
//! each incident angle: `AOI`, `POI`, `Side`, `Wavelength`, `ScatterType`, `TristimulusValue`, and `TIS t`, after which the
//! values in 1/sr follow, radial angle fastest; `DataEnd`. The light is at azimuth 90 in these files; here it is at 0.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::path::Path;

use lobe_table::{Channels, Data, Scatter, Side, spherical};

use crate::spec::FormatSpec;
use crate::text::{Text, has_words};
use crate::{Document, FormatError, Part};

/// This format in the registry.
pub(crate) static FORMAT: FormatSpec = FormatSpec {
    name: "LightTools BSDF",
    word: "lighttools",
    extensions: &["bsdf"],
    matches,
    read: Some(|bytes, path| Ok(Document::of_parts(read(bytes, path)?))),
    writer: None,
};

/// `true` for a text with the words `ScatterRadial` and `AOI`.
pub fn matches(bytes: &[u8]) -> bool {
    has_words(bytes, "#", &["ScatterRadial", "AOI"])
}

/// What precedes `TIS` and stays in force until it is given again.
struct State {
    aoi: Option<f64>,
    side: Side,
    is_btdf: bool,
    channel: usize,
}

/// Incident angle and channel of a table. Angles that are not negative are in the order of their bits.
type Tables = BTreeMap<(Side, bool), BTreeMap<u64, [Option<Vec<f64>>; 3]>>;

/// Reads a file: up to four parts. `file` only names it in errors.
///
/// # Errors
/// [`FormatError`] with the line: unknown words, counts that the rest of the file has no room for, a second table of the
/// same kind (several `POI` or wavelengths), an incident angle without all of its channels, or azimuths that leave half a
/// turn without a value.
pub fn read(bytes: &[u8], file: &Path) -> Result<Vec<Part>, FormatError> {
    let mut text = Text::new(file, bytes, "#");
    let (mut azimuths, mut radials, mut channels, mut is_symmetric) = (Vec::new(), Vec::new(), Channels::Mono, false);
    loop {
        let key = text.expect("`DataBegin`")?;
        if key.is("Symmetry") {
            let value = text.expect("a symmetry")?;
            is_symmetric = value.is("PlaneSymmetrical");
            if !(is_symmetric || value.is("Asymmetric") || value.is("Asymmetrical")) {
                return Err(text.unexpected(value, "PlaneSymmetrical or Asymmetric"));
            }
        } else if key.is("SpectralContent") {
            let value = text.expect("a spectral content")?;
            channels = match () {
                () if value.is("Monochrome") => Channels::Mono,
                () if value.is("XYZ") => Channels::Xyz,
                () => return Err(text.unexpected(value, "Monochrome or XYZ")),
            };
        } else if key.is("ScatterAzimuth") {
            azimuths = angles(&mut text, "azimuths", 360.0)?;
        } else if key.is("ScatterRadial") {
            radials = angles(&mut text, "radial angles", 90.0)?;
        } else if key.is("DataBegin") {
            break;
        } else {
            return Err(text.unexpected(key, "a keyword of the head, or `DataBegin`"));
        }
    }
    if azimuths.is_empty() || radials.is_empty() {
        return Err(text.error(text.line(), "`DataBegin`", "ScatterAzimuth and ScatterRadial first"));
    }
    let tables = tables(&mut text, azimuths.len().saturating_mul(radials.len()), &channels)?;
    if tables.is_empty() {
        return Err(text.error(text.line(), "no table", "at least one"));
    }
    let mut parts = Vec::new();
    for ((side, is_btdf), by_angle) in tables {
        let scatter = if is_btdf { Scatter::Transmission } else { Scatter::Reflection };
        let grid = part(&text, &azimuths, &radials, is_symmetric, &channels, scatter, &by_angle)?;
        parts.push(Part { name: String::new(), side: Some(side), data: Data::Spherical(grid) });
    }
    Ok(parts)
}

fn angles(text: &mut Text<'_>, what: &str, limit: f64) -> Result<Vec<f64>, FormatError> {
    let count = text.count(what)?;
    let mut angles = Vec::with_capacity(count);
    for _ in 0..count {
        let angle = text.number("an angle in degrees")?;
        if !(0.0..=limit).contains(&angle) {
            return Err(text.error(text.line(), format!("{angle} of the {what}"), format!("0 to {limit} degrees")));
        }
        angles.push(angle);
    }
    Ok(angles)
}

fn tables(text: &mut Text<'_>, size: usize, channels: &Channels) -> Result<Tables, FormatError> {
    let mut tables = Tables::new();
    let mut state = State { aoi: None, side: Side::Front, is_btdf: false, channel: 0 };
    loop {
        let key = text.expect("`DataEnd`")?;
        if key.is("DataEnd") {
            return Ok(tables);
        } else if key.is("AOI") {
            let angle = text.number("an angle of incidence")?;
            if !(0.0..=90.0).contains(&angle) {
                return Err(text.error(text.line(), format!("AOI {angle}"), "0 to 90 degrees"));
            }
            state.aoi = Some(angle + 0.0);
        } else if key.is("POI") || key.is("Wavelength") {
            text.number("a number")?;
        } else if key.is("Side") {
            let value = text.expect("a side")?;
            state.side = match () {
                () if value.is("Front") => Side::Front,
                () if value.is("Back") => Side::Back,
                () => return Err(text.unexpected(value, "Front or Back")),
            };
        } else if key.is("ScatterType") {
            let value = text.expect("a kind of scatter")?;
            state.is_btdf = value.is("BTDF");
            if !(state.is_btdf || value.is("BRDF")) {
                return Err(text.unexpected(value, "BRDF or BTDF"));
            }
        } else if key.is("TristimulusValue") {
            let value = text.expect("a tristimulus value")?;
            let index = ["TrisX", "TrisY", "TrisZ"].iter().position(|name| value.is(name));
            state.channel = index.ok_or_else(|| text.unexpected(value, "TrisX, TrisY or TrisZ"))?;
        } else if key.is("TIS") {
            text.number("a total integrated scatter")?;
            let Some(aoi) = state.aoi else {
                return Err(text.unexpected(key, "AOI first"));
            };
            text.room(Some(size), "values", key.line)?;
            let mut values = Vec::with_capacity(size);
            for _ in 0..size {
                values.push(text.number("a value")?);
            }
            let channel = if channels.count() == 1 { 0 } else { state.channel };
            let by_angle = tables.entry((state.side, state.is_btdf)).or_default();
            if by_angle.entry(aoi.to_bits()).or_default()[channel].replace(values).is_some() {
                let found = format!("a second table of AOI {aoi}");
                return Err(text.error(key.line, found, "one POI and one wavelength for each incident angle"));
            }
        } else {
            return Err(text.unexpected(key, "a keyword of a table, or `DataEnd`"));
        }
    }
}

/// Turns the light to azimuth 0, completes symmetric azimuths, and sorts both angles.
fn part(
    text: &Text<'_>,
    azimuths: &[f64],
    radials: &[f64],
    is_symmetric: bool,
    channels: &Channels,
    scatter: Scatter,
    by_angle: &BTreeMap<u64, [Option<Vec<f64>>; 3]>,
) -> Result<spherical::Data, FormatError> {
    let error = |found: String, expected: &str| text.error(text.line(), found, expected);
    let turned: Vec<f64> = azimuths.iter().map(|azimuth| (azimuth - 90.0).rem_euclid(360.0)).collect();
    let is_right = turned.iter().all(|&azimuth| azimuth <= 180.0);
    let is_left = turned.iter().all(|&azimuth| azimuth >= 180.0 || azimuth == 0.0);
    let is_one_sided = is_symmetric && azimuths.len() > 1 && (is_right || is_left);
    // Azimuth and column, ascending; 0 and 360 are the same, and so are a column and its mirror image in the plane.
    let mirrored = |&(azimuth, column): &(f64, usize)| ((360.0 - azimuth).rem_euclid(360.0), column);
    let mut columns: Vec<(f64, usize)> = turned.iter().copied().zip(0..).collect();
    if is_one_sided {
        columns.extend(columns.clone().iter().map(mirrored));
    }
    columns.sort_by(|a, b| a.0.total_cmp(&b.0));
    columns.dedup_by(|a, b| (a.0 - b.0).abs() < 1e-4);
    let wrapped = columns.first().map(|first| (first.0 + 360.0, first.1));
    let nexts = columns.iter().copied().skip(1).chain(wrapped);
    if columns.len() > 1 && columns.iter().zip(nexts).any(|(a, b)| b.0 - a.0 >= 180.0) {
        return Err(error(format!("azimuths {azimuths:?}"), "no half turn without a value"));
    }
    let mut rows: Vec<(f64, usize)> = radials.iter().copied().zip(0..).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.dedup_by(|a, b| (a.0 - b.0).abs() < 1e-4);

    let mut values = Vec::new();
    for (aoi, tables) in by_angle {
        let tables: Option<Vec<&Vec<f64>>> = tables[..channels.count()].iter().map(Option::as_ref).collect();
        let Some(tables) = tables else {
            return Err(error(format!("AOI {} without them", f64::from_bits(*aoi)), "tables of all channels"));
        };
        for &(_, row) in &rows {
            for &(_, column) in &columns {
                values.extend(tables.iter().map(|table| table[column * radials.len() + row] as f32));
            }
        }
    }
    let radians = |angles: &[(f64, usize)]| angles.iter().map(|(angle, _)| angle.to_radians().min(TAU)).collect();
    let incident = by_angle.keys().map(|bits| f64::from_bits(*bits).to_radians().min(PI / 2.0)).collect();
    let knots = [incident, vec![0.0], radians(&rows), radians(&columns)];
    spherical::Data::new(scatter, knots, channels.clone(), values).map_err(|e| error(e.to_string(), "a grid of angles"))
}
