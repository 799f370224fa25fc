//! Recognition of grids among samples, and the choice of the representation.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

use libm::{atan2, hypot, sincos};
use lobe_table::{Channels, Data, Scatter, specular, spherical};

use super::Rows;
use crate::records::Records;
use crate::{FormatError, Place};

/// The properties of the samples.
pub(super) struct Of {
    pub scatter: Scatter,
    pub channels: Channels,
    pub is_specular: bool,
}

/// A grid if all of its nodes are present, otherwise scattered samples, without those in specular coordinates that are
/// below the horizon.
pub(super) fn data(records: Records, of: Of, rows: Option<Rows>, file: &Path) -> Result<Data, FormatError> {
    let Of { scatter, channels, is_specular } = of;
    let is_stated = matches!(rows, Some(Rows::Grid | Rows::MirroredGrid));
    let found = if rows == Some(Rows::Samples) { None } else { grid(&records, channels.count(), is_stated) };
    if is_stated && found.is_none() {
        let found = "rows that are not each node of a grid once";
        return Err(FormatError::new(file, Place::File, found, "rows of the kind that the comment states"));
    }
    if let Some((knots, values)) = found {
        let refused = |e: lobe_table::GridError| FormatError::new(file, Place::File, e.to_string(), "a grid");
        return match is_specular {
            true => specular::Data::new(scatter, knots, channels, values).map(Data::Specular).map_err(refused),
            false => {
                let grid = spherical::Data::new(scatter, knots, channels, values);
                let grid =
                    if rows == Some(Rows::MirroredGrid) { grid.and_then(spherical::Data::mirrored) } else { grid };
                grid.map(Data::Spherical).map_err(refused)
            }
        };
    }
    let records = if is_specular { from_specular(&records, &channels) } else { records };
    records.scattered(file, scatter, channels).map(Data::Scattered)
}

/// Knots and values, if the samples are each node of a grid once. A line of directions is not a grid, unless it is
/// stated.
fn grid(records: &Records, channels: usize, is_stated: bool) -> Option<([Vec<f64>; 4], Vec<f32>)> {
    // Angles that agree to six digits of radians are the same knot.
    let key = |angle: f64| (angle * 1e6).round() as i64;
    let mut knots: [BTreeMap<i64, f64>; 4] = Default::default();
    for angles in &records.angles {
        for (knots, &angle) in knots.iter_mut().zip(angles) {
            knots.insert(key(angle), angle);
        }
    }
    let nodes = knots.iter().try_fold(1_usize, |nodes, knots| nodes.checked_mul(knots.len()))?;
    let (first, last) = (knots[3].values().next()?, knots[3].values().next_back()?);
    // Half a turn is also left to scattered samples, for which the other half is the mirror image.
    let is_whole_turn = last - first > PI + 1e-6;
    let shows = knots[2].len() > 1 && is_whole_turn;
    if nodes != records.angles.len() || !(shows || is_stated) {
        return None;
    }
    let positions: [BTreeMap<i64, usize>; 4] =
        std::array::from_fn(|axis| knots[axis].keys().enumerate().map(|(position, &key)| (key, position)).collect());
    let mut values = vec![None; nodes];
    for (angles, colour) in records.angles.iter().zip(records.values.chunks_exact(channels)) {
        let node = (0..4).fold(0, |at, axis| at * knots[axis].len() + positions[axis][&key(angles[axis])]);
        if values[node].replace(colour).is_some() {
            return None;
        }
    }
    let values = values.into_iter().flatten().flatten().copied().collect();
    Some((knots.map(|knots| knots.into_values().collect()), values))
}

/// The directions of samples in specular coordinates, without those below the horizon.
fn from_specular(records: &Records, channels: &Channels) -> Records {
    let mut out = Records::default();
    for (&[sigma, psi, theta, phi], colour) in records.angles.iter().zip(records.values.chunks_exact(channels.count()))
    {
        let ((sin, cos), (sin_t, cos_t), (sin_p, cos_p)) = (sincos(sigma), sincos(theta), sincos(phi));
        let (x, y, z) = (cos * sin_t * cos_p - sin * cos_t, sin_t * sin_p, sin * sin_t * cos_p + cos * cos_t);
        if z > 0.0 {
            let angles = [sigma, psi, atan2(hypot(x, y), z), atan2(y, x) + psi];
            out.push(angles, colour.iter().map(|value| f64::from(*value)));
        }
    }
    out
}
