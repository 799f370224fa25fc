//! Writes LightTools tables.

use std::fmt::Write as _;
use std::path::Path;

use lobe_files::write_whole;
use lobe_table::{Channels, Data, Scatter, Side, spherical};

use crate::angle::{degrees, exact_degrees};
use crate::spec::{resampled, unfit};
use crate::text::push_row;
use crate::totals::integrals;
use crate::{Document, FormatError, Place};

/// A measurement, and the side from which its light comes.
type Measured<'a> = (Side, &'a spherical::Data);

/// The parts, if they are grids that fit into one file, each with a different side or kind of scatter. A part without a
/// side belongs to the front.
pub(super) fn grids(document: &Document) -> Option<Vec<Measured<'_>>> {
    let mut grids: Vec<Measured<'_>> = Vec::new();
    for part in &document.parts {
        let Data::Spherical(grid) = &part.data else { return None };
        let side = part.side.unwrap_or(Side::Front);
        if grids.iter().any(|(other, held)| *other == side && held.scatter() == grid.scatter()) {
            return None;
        }
        grids.push((side, grid));
    }
    let first = grids.first()?.1;
    let is_alike = |grid: &spherical::Data| {
        let [[.., theta, phi], [.., first_theta, first_phi]] = [grid, first].map(spherical::Data::knots);
        (theta, phi) == (first_theta, first_phi)
            && grid.is_mirrored() == first.is_mirrored()
            && grid.channels() == first.channels()
    };
    grids.iter().all(|(_, grid)| is_alike(grid)).then_some(grids)
}

/// A column of the tables: its azimuth in the file, in degrees, and its index in the grid.
struct Column {
    azimuth: f64,
    index: usize,
}

/// Writes `path` completely or not at all. Values are read back bit for bit, angles to a billionth of a degree. The
/// total integrated scatter of each table is the integral of its interpolated values.
///
/// # Errors
/// [`FormatError`] if the file cannot be written; if the parts are not grids with the same outgoing directions and
/// channels; if the channels are not a single one, X Y Z or wavelengths of at least 50 nm; or if neighbouring azimuths
/// are half a turn or more apart.
pub(super) fn write(document: &Document, path: &Path) -> Result<(), FormatError> {
    let refuse = |found: String, expected: &str| Err(FormatError::new(path, Place::File, found, expected));
    let Some(grids) = grids(document) else {
        return Err(unfit(document, path, "grids of spherical coordinates, all with the same outgoing directions"));
    };
    let first = grids[0].1;
    let content = match first.channels() {
        Channels::Mono => "Monochrome",
        Channels::Spectral(nm) if nm.iter().all(|nm| *nm >= super::grid::SHORTEST) => "Monochrome",
        Channels::Xyz => "XYZ",
        other => {
            let expected = "one channel, X Y Z, or wavelengths of 50 nm and more in this format";
            return refuse(format!("the channels {}", other.names().join(" ")), expected);
        }
    };
    let columns = columns(&grids, path)?;
    let mut out = String::new();
    if let Some(resampled) = resampled(document) {
        let _ = writeln!(out, "# {resampled}");
    }
    let symmetry = if first.is_mirrored() { "PlaneSymmetrical" } else { "Asymmetric" };
    let _ = writeln!(out, "Symmetry {symmetry}\nSpectralContent {content}");
    let _ = writeln!(out, "ScatterAzimuth {}", columns.len());
    push_degrees(&mut out, columns.iter().map(|column| column.azimuth));
    let radials = &first.knots()[2];
    let _ = writeln!(out, "ScatterRadial {}", radials.len());
    push_degrees(&mut out, radials.iter().map(|theta| restored(*theta)));
    out.push_str("DataBegin\n");
    for (side, grid) in grids {
        tables(&mut out, document, side, grid, &columns);
    }
    out.push_str("DataEnd\n");
    write_whole(path, out.as_bytes())
}

fn push_degrees(out: &mut String, angles: impl Iterator<Item = f64>) {
    angles.for_each(|angle| {
        let _ = write!(out, " {angle}");
    });
    out.push('\n');
}

/// The columns by ascending azimuth in the file, in which the light at POI 0 is at 90 degrees.
fn columns(grids: &[Measured<'_>], path: &Path) -> Result<Vec<Column>, FormatError> {
    const SAME: f64 = 1e-4;
    let first = grids[0].1;
    let knots: Vec<f64> = first.knots()[3].iter().map(|phi| degrees(*phi)).collect();
    let refuse = |found: String, expected: &str| Err(FormatError::new(path, Place::File, found, expected));
    let mut kept = knots.len();
    if !first.is_mirrored() && kept > 1 && knots[kept - 1] - knots[0] > 360.0 - SAME {
        if !grids.iter().all(|(_, grid)| is_closed(grid)) {
            let found = "different values at the ends of a whole turn".into();
            return refuse(found, "the same value at both in this format");
        }
        kept -= 1;
    }
    let knots = &knots[..kept];
    let nexts = knots.iter().skip(1).copied().chain([knots[0] + 360.0]);
    if !first.is_mirrored() && kept > 1 && knots.iter().zip(nexts).any(|(knot, next)| next - knot >= 180.0 - SAME) {
        return refuse(format!("azimuths {knots:?}"), "steps of less than half a turn in this format");
    }
    let azimuth = |index: usize| turned(first.knots()[3][index]);
    let mut columns: Vec<Column> = (0..kept).map(|index| Column { azimuth: azimuth(index), index }).collect();
    columns.sort_by(|a, b| a.azimuth.total_cmp(&b.azimuth));
    Ok(columns)
}

/// Degrees from which readers restore an angle, or the nearest with few digits if there are none.
fn restored(angle: f64) -> f64 {
    exact_degrees(angle).unwrap_or_else(|| degrees(angle))
}

/// The azimuth in the file, in degrees, from which readers restore an azimuth, or the nearest with few digits.
fn turned(phi: f64) -> f64 {
    let few = degrees((degrees(phi) + 90.0).rem_euclid(360.0).to_radians());
    let near = (restored(phi) + 90.0).rem_euclid(360.0);
    let candidates = [few, near, near.next_up(), near.next_down()];
    let read = |azimuth: f64| (azimuth - 90.0).rem_euclid(360.0).to_radians();
    candidates.into_iter().find(|azimuth| read(*azimuth) == phi).unwrap_or(few)
}

/// `true` if the first and the last azimuth have the same values.
fn is_closed(grid: &spherical::Data) -> bool {
    let phis = grid.knots()[3].len();
    let mut rows = grid.values().chunks_exact(phis * grid.channels().count());
    let count = grid.channels().count();
    rows.all(|row| row[..count] == row[(phis - 1) * count..])
}

/// Writes a table for each incident direction and channel.
fn tables(out: &mut String, document: &Document, side: Side, grid: &spherical::Data, columns: &[Column]) {
    let [aois, pois, radials, phis] = grid.knots();
    let side = if side == Side::Front { "Front" } else { "Back" };
    let scatter = if grid.scatter() == Scatter::Reflection { "BRDF" } else { "BTDF" };
    let stated = document.source.iter().find(|(name, _)| name == "Wavelength").map(|(_, value)| value.as_str());
    let states: Vec<String> = match grid.channels() {
        Channels::Spectral(nm) => nm.iter().map(|nm| format!("Wavelength {nm}")).collect(),
        Channels::Xyz => ["TrisX", "TrisY", "TrisZ"].map(|name| format!("TristimulusValue {name}")).into(),
        _ => vec![stated.filter(|nm| is_wavelength(nm)).map_or(String::new(), |nm| format!("Wavelength {nm}"))],
    };
    let totals = integrals(grid);
    let count = states.len();
    let slices = aois.iter().flat_map(|aoi| pois.iter().map(move |poi| (*aoi, *poi)));
    for (slice, (aoi, poi)) in slices.enumerate() {
        let _ = writeln!(out, "AOI {}\nPOI {}\nSide {side}\nScatterType {scatter}", restored(aoi), restored(poi));
        for (channel, state) in states.iter().enumerate() {
            if !state.is_empty() {
                let _ = writeln!(out, "{state}");
            }
            out.push_str("TIS");
            push_row(out, std::iter::once(totals[slice * count + channel]));
            for column in columns {
                let node = |row: usize| (slice * radials.len() + row) * phis.len() + column.index;
                let value = |row: usize| f64::from(grid.values()[node(row) * count + channel]);
                push_row(out, (0..radials.len()).map(value));
            }
        }
    }
}

/// `true` if a fact is a wavelength that the format can hold.
fn is_wavelength(fact: &str) -> bool {
    let number = fact.strip_suffix("nm").unwrap_or(fact).trim().parse::<f64>();
    number.is_ok_and(|nm| nm.is_finite() && nm > 0.0)
}
