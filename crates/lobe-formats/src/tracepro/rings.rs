//! Tables over the abscissa of Harvey and Shack, as samples on rings about the specular direction.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;

use libm::hypot;
use lobe_table::Scatter;

use super::sections::Sheet;
use crate::records::Records;
use crate::{FormatError, Place};

/// Directions on a ring, and on the horizon.
const DIRECTIONS: usize = 36;
/// The largest difference, relative to the largest value, between values of a ring that depend on the abscissa alone.
const ROUNDING: f64 = 1e-5;

/// The values of one incident direction.
pub(super) struct Curve {
    /// In degrees.
    theta: f64,
    phi: f64,
    /// Ascending abscissas, each with a value per channel.
    knots: Vec<(f64, Vec<f64>)>,
}

/// The curves of all incident directions.
pub(super) fn curves(
    file: &Path,
    sheet: &Sheet,
    wavelengths: &[f64],
    scatter: Scatter,
) -> Result<Vec<Curve>, FormatError> {
    let error = |found: String, expected: &str| FormatError::new(file, Place::File, found, expected);
    let name = if scatter == Scatter::Reflection { "BRDF" } else { "BTDF" };
    let value = |row: &super::sections::TableRow| if scatter == Scatter::Reflection { row.brdf } else { row.btdf };
    let largest = sheet.table.iter().map(|row| value(row).abs()).fold(0.0, f64::max);
    // Incident direction, abscissa, wavelength: the sum and number of the values of a ring.
    let mut rings: BTreeMap<[u64; 4], (f64, u32, f64)> = BTreeMap::new();
    for row in &sheet.table {
        let key = [row.theta, row.phi.rem_euclid(360.0) + 0.0, row.beta + 0.0, row.nm].map(f64::to_bits);
        let value = value(row);
        let (sum, count, first) = rings.entry(key).or_insert((0.0, 0, value));
        if (value - *first).abs() > ROUNDING * largest {
            let found = format!(
                "a {name} that depends on ScatterAzimuth (IncAngle {}, ScatterBeta {}, ScatterAzimuth {})",
                row.theta, row.beta, row.azimuth
            );
            return Err(error(
                found,
                "one that depends on ScatterBeta alone: the place of azimuth 0 is not in the file but chosen with the \
                 surface",
            ));
        }
        (*sum, *count) = (*sum + value, *count + 1);
    }
    let mut curves: Vec<Curve> = Vec::new();
    let mut filled = 0;
    for ([theta, phi, beta, nm], (sum, count, _)) in rings {
        let [theta, phi, beta, nm] = [theta, phi, beta, nm].map(f64::from_bits);
        if curves.last().is_none_or(|curve| (curve.theta, curve.phi) != (theta, phi)) {
            curves.push(Curve { theta, phi, knots: Vec::new() });
        }
        let Some(Curve { knots, .. }) = curves.last_mut() else { continue };
        if knots.last().is_none_or(|(last, _)| *last != beta) {
            knots.push((beta, Vec::new()));
        }
        let Some((_, values)) = knots.last_mut() else { continue };
        if wavelengths.get(values.len()) != Some(&nm) {
            let found = format!("IncAngle {theta}, ScatterBeta {beta} without {} nm", wavelengths[values.len()]);
            return Err(error(found, "all wavelengths for each"));
        }
        values.push(sum / f64::from(count));
        filled += 1;
    }
    let knots: usize = curves.iter().map(|curve| curve.knots.len()).sum();
    if filled != knots * wavelengths.len() {
        return Err(error("abscissas without some wavelengths".into(), "all wavelengths for each"));
    }
    Ok(curves)
}

impl Curve {
    pub(super) fn is_dark(&self) -> bool {
        self.knots.iter().all(|(_, values)| values.iter().all(|value| *value == 0.0))
    }

    /// Adds samples on the rings of the abscissas and halfway between them if they are above the horizon, and on the
    /// horizon within the range of the abscissas.
    pub(super) fn samples(&self, records: &mut Records) {
        let (sin, phi) = (libm::sin(self.theta.to_radians()), self.phi.to_radians());
        // In the plane of the surface, with the light on +x. Transmitted light goes straight through.
        let center = [-sin, 0.0];
        let mut add = |[x, y]: [f64; 2], values: Vec<f64>| {
            let radius = hypot(x, y).min(1.0);
            records.push([self.theta.to_radians(), phi, libm::asin(radius), phi + libm::atan2(y, x)], values);
        };
        let halfway = self.knots.windows(2).map(|ends| (ends[0].0 + ends[1].0) / 2.0);
        for beta in self.knots.iter().map(|knot| knot.0).chain(halfway) {
            let count = if beta == 0.0 { 1 } else { DIRECTIONS };
            for at in 0..count {
                let angle = at as f64 / count as f64 * TAU;
                let (sin, cos) = libm::sincos(angle);
                let place = [center[0] + beta * cos, center[1] + beta * sin];
                if hypot(place[0], place[1]) < 1.0 {
                    add(place, self.at(beta));
                }
            }
        }
        let last = self.knots.last().map_or(0.0, |knot| knot.0);
        for at in 0..DIRECTIONS {
            let angle = at as f64 / DIRECTIONS as f64 * TAU;
            let (sin, cos) = libm::sincos(angle);
            let place = [cos, sin];
            let beta = hypot(place[0] - center[0], place[1] - center[1]);
            if beta <= last {
                add(place, self.at(beta));
            }
        }
    }

    /// The values at an abscissa: linear between the knots, constant beyond them.
    fn at(&self, beta: f64) -> Vec<f64> {
        let above = self.knots.partition_point(|knot| knot.0 < beta);
        let (low, high) = (&self.knots[above.saturating_sub(1)], &self.knots[above.min(self.knots.len() - 1)]);
        let width = high.0 - low.0;
        let weight = if width > 0.0 { ((beta - low.0) / width).clamp(0.0, 1.0) } else { 0.0 };
        low.1.iter().zip(&high.1).map(|(low, high)| low + weight * (high - low)).collect()
    }
}
