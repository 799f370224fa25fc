//! From the tables of a measurement to a grid.

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, TAU};

use lobe_table::{Channels, Scatter, spherical};

use super::head::Head;
use super::tables::{ByIncidence, Incidence};
use crate::FormatError;
use crate::text::Text;

/// Wavelengths below this, in nm, mean that the file uses other units.
pub(super) const SHORTEST: f64 = 50.0;

/// An angle in degrees, and the row or column of the tables that it belongs to.
#[derive(Clone, Copy)]
struct Place {
    angle: f64,
    index: usize,
}

/// Moves the light from azimuth 90 + POI to POI, completes symmetric azimuths, and sorts all angles.
pub(super) fn part(
    text: &Text<'_>,
    head: &Head,
    scatter: Scatter,
    tables: &ByIncidence,
) -> Result<spherical::Data, FormatError> {
    let error = |found: String, expected: &str| text.error(text.line(), found, expected);
    let axes = Axes::of(tables);
    let channels = axes.channels(text, &head.channels)?;
    axes.check(text, tables)?;
    if head.is_symmetric && axes.pois.len() > 1 {
        return Err(error(format!("PlaneSymmetrical tables of {} POI", axes.pois.len()), "one, or Asymmetric tables"));
    }
    let columns = columns(text, head)?;
    let rows = rows(head);
    let mut values = Vec::with_capacity(axes.len() * rows.len() * columns.len());
    for &aoi in &axes.aois {
        for &poi in &axes.pois {
            let of_channel = |&channel: &u64| axes.table(tables, Incidence { aoi, poi, channel });
            let Some(tables) = axes.channels.iter().map(of_channel).collect::<Option<Vec<&Vec<f32>>>>() else {
                let found = format!("AOI {}, POI {} without them", f64::from_bits(aoi), f64::from_bits(poi));
                return Err(error(found, "tables of all channels"));
            };
            for row in &rows {
                for column in &columns {
                    values.extend(tables.iter().map(|table| table[column.index * head.radials.len() + row.index]));
                }
            }
        }
    }
    let radians = |places: &[Place]| places.iter().map(|place| place.angle.to_radians().min(TAU)).collect();
    let of_bits = |angles: &BTreeSet<u64>, limit: f64| {
        angles.iter().map(|bits| f64::from_bits(*bits).to_radians().min(limit)).collect::<Vec<f64>>()
    };
    let knots = [of_bits(&axes.aois, FRAC_PI_2), of_bits(&axes.pois, TAU), radians(&rows), radians(&columns)];
    spherical::Data::new(scatter, knots, channels, values).map_err(|e| error(e.to_string(), "a grid of angles"))
}

/// The values in which the tables differ.
struct Axes {
    aois: BTreeSet<u64>,
    pois: BTreeSet<u64>,
    channels: BTreeSet<u64>,
}

impl Axes {
    fn of(tables: &ByIncidence) -> Self {
        Axes {
            aois: tables.keys().map(|incidence| incidence.aoi).collect(),
            pois: tables.keys().map(|incidence| incidence.poi).collect(),
            channels: tables.keys().map(|incidence| incidence.channel).collect(),
        }
    }

    /// The number of tables of the grid.
    fn len(&self) -> usize {
        self.aois.len().saturating_mul(self.pois.len()).saturating_mul(self.channels.len())
    }

    /// The meaning of the channels of the values.
    fn channels(&self, text: &Text<'_>, content: &Channels) -> Result<Channels, FormatError> {
        let error = |found: String, expected: &str| Err(text.error(text.line(), found, expected));
        let wavelengths: Vec<f64> = self.channels.iter().map(|bits| f64::from_bits(*bits)).collect();
        match content {
            Channels::Mono if wavelengths.len() == 1 => Ok(Channels::Mono),
            Channels::Mono if wavelengths[0] == 0.0 => {
                error("tables without a wavelength".into(), "one for each table")
            }
            Channels::Mono if wavelengths[0] < SHORTEST => {
                error(format!("a wavelength of {} nm", wavelengths[0]), "wavelengths in nm")
            }
            Channels::Mono => Ok(Channels::Spectral(wavelengths)),
            _ if self.channels.len() < 3 => {
                let name =
                    ["TrisX", "TrisY", "TrisZ"][(0..).find(|at| !self.channels.contains(at)).unwrap_or(0) as usize];
                error(format!("no table of {name}"), "tables of all channels")
            }
            _ => Ok(Channels::Xyz),
        }
    }

    /// Checks that no table of the grid is missing, before memory is allocated for it: only perpendicular light, which
    /// has no azimuth, may have been measured once for all POI.
    fn check(&self, text: &Text<'_>, tables: &ByIncidence) -> Result<(), FormatError> {
        let is_slanted = |aoi: &u64| f64::from_bits(*aoi) > 0.0;
        let slanted = self.aois.iter().filter(|aoi| is_slanted(aoi)).count();
        let found = tables.keys().filter(|incidence| is_slanted(&incidence.aoi)).count();
        let expected = slanted.saturating_mul(self.pois.len()).saturating_mul(self.channels.len());
        let perpendicular = tables.len() - found;
        let is_whole = match (slanted, perpendicular) {
            (0, _) => perpendicular == self.len(),
            _ => found == expected,
        };
        if is_whole {
            return Ok(());
        }
        let each = || {
            let incidences = self.aois.iter().flat_map(|&aoi| self.pois.iter().map(move |&poi| (aoi, poi)));
            incidences.flat_map(|(aoi, poi)| self.channels.iter().map(move |&channel| Incidence { aoi, poi, channel }))
        };
        // A combination is missing among the first ones, of which there is one more than tables.
        let missing =
            each().find(|incidence| !tables.contains_key(incidence) && self.table(tables, *incidence).is_none());
        let found = missing.map_or("a missing table".into(), |Incidence { aoi, poi, channel }| {
            let channel = match self.channels.len() {
                1 => String::new(),
                _ if channel < 3 => format!(", {}", ["TrisX", "TrisY", "TrisZ"][channel as usize]),
                _ => format!(", {} nm", f64::from_bits(channel)),
            };
            format!("AOI {}, POI {}{channel} without a table", f64::from_bits(aoi), f64::from_bits(poi))
        });
        let [aois, pois, channels] = [&self.aois, &self.pois, &self.channels].map(BTreeSet::len);
        let expected = format!("one for each of {aois} AOI, {pois} POI and {channels} channels");
        Err(text.error(text.line(), found, expected))
    }

    /// The table of a combination; for perpendicular light, that of any POI.
    fn table<'a>(&self, tables: &'a ByIncidence, incidence: Incidence) -> Option<&'a Vec<f32>> {
        let of_any_poi = || {
            let of_poi = |&poi: &u64| tables.get(&Incidence { poi, ..incidence });
            self.pois.iter().find_map(of_poi).filter(|_| f64::from_bits(incidence.aoi) == 0.0)
        };
        tables.get(&incidence).or_else(of_any_poi)
    }
}

/// The columns by ascending azimuth from the plane of incidence at POI 0; 0 and 360 are the same, and so are a column
/// and its mirror image in the plane.
fn columns(text: &Text<'_>, head: &Head) -> Result<Vec<Place>, FormatError> {
    let turned = head.azimuths.iter().map(|azimuth| (azimuth - 90.0).rem_euclid(360.0));
    let mut columns: Vec<Place> = turned.zip(0..).map(|(angle, index)| Place { angle, index }).collect();
    let is_right = columns.iter().all(|column| column.angle <= 180.0);
    let is_left = columns.iter().all(|column| column.angle >= 180.0 || column.angle == 0.0);
    if head.is_symmetric && columns.len() > 1 && (is_right || is_left) {
        let mirrored = |column: &Place| Place { angle: (360.0 - column.angle).rem_euclid(360.0), ..*column };
        columns.extend(columns.clone().iter().map(mirrored));
    }
    sort(&mut columns);
    let wrapped = columns.first().map(|first| first.angle + 360.0);
    let nexts = columns.iter().skip(1).map(|column| column.angle).chain(wrapped);
    if columns.len() > 1 && columns.iter().zip(nexts).any(|(column, next)| next - column.angle >= 180.0) {
        let found = format!("azimuths {:?}", head.azimuths);
        return Err(text.error(text.line(), found, "no half turn without a value"));
    }
    Ok(columns)
}

/// The rows by ascending radial angle.
fn rows(head: &Head) -> Vec<Place> {
    let mut rows: Vec<Place> = head.radials.iter().zip(0..).map(|(&angle, index)| Place { angle, index }).collect();
    sort(&mut rows);
    rows
}

/// By ascending angle, each once.
fn sort(places: &mut Vec<Place>) {
    places.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    places.dedup_by(|a, b| (a.angle - b.angle).abs() < 1e-4);
}
