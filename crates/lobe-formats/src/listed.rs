//! Data as a list of samples, for formats that can hold only samples.

use std::f64::consts::TAU;

use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{Data, Scatter, scattered, specular, spherical};

use crate::Document;
use crate::angle::Unit;
use crate::restored::Written;

/// A pair of directions, `theta_i`, `phi_i`, `theta_o` and `phi_o`, and its channels.
pub(crate) struct Sample<'a> {
    pub angles: [f64; 4],
    pub values: &'a [f32],
}

/// `true` if a document is a reflectance whose samples, or nodes in specular or spherical coordinates, can be listed.
pub(crate) fn is_listed(document: &Document) -> bool {
    document.only().is_some_and(|data| match data {
        Data::Scattered(data) => data.scatter() == Scatter::Reflection,
        Data::Specular(data) => data.scatter() == Scatter::Reflection && data.refraction().is_none(),
        Data::Spherical(data) => data.scatter() == Scatter::Reflection,
        _ => false,
    })
}

/// The samples of a document that [`is_listed`], by incident direction, in radians; `None` for any other document.
pub(crate) fn samples(document: &Document) -> Option<Vec<Sample<'_>>> {
    match document.only().filter(|_| is_listed(document))? {
        Data::Scattered(data) => Some(samples_in(data, Written { unit: Unit::Rad, turn: 0.0 })),
        Data::Specular(data) => Some(of_specular(data)),
        Data::Spherical(data) => Some(of_spherical(data)),
        _ => None,
    }
}

/// Samples with the angles of a file, of which readers turn the light by `turn`, and the unit of the angles: degrees,
/// or radians if degrees would not restore one of the samples bit for bit.
pub(crate) fn samples_of(data: &scattered::Data, turn: f64) -> (Vec<Sample<'_>>, Unit) {
    let in_degrees = Written { unit: Unit::Deg, turn };
    let restored = data.relative_samples().map(|(angles, values)| {
        let angles = in_degrees.restoring(angles)?;
        Some(Sample { angles, values })
    });
    match restored.collect::<Option<Vec<_>>>() {
        Some(samples) => (samples, Unit::Deg),
        None => (samples_in(data, Written { unit: Unit::Rad, turn }), Unit::Rad),
    }
}

/// Samples with angles that readers restore, or restore except for rounding.
fn samples_in(data: &scattered::Data, written: Written) -> Vec<Sample<'_>> {
    let samples = data.relative_samples().map(|(angles, values)| {
        let [theta_i, phi_i, theta_o, relative] = angles;
        let near = [theta_i, phi_i - written.turn, theta_o, phi_i + relative];
        let angles = written.restoring(angles).unwrap_or_else(|| near.map(|angle| angle / written.unit.radians()));
        Sample { angles, values }
    });
    samples.collect()
}

/// The smallest z of the directions of listed nodes: the values of lower nodes are extrapolated from those above.
const LOWEST: f64 = 1e-3;
/// Angles closer than this, in radians, are the same.
const SAME: f64 = 1e-6;

/// `true` if a knot equals the first one after a full turn.
fn is_again(knots: &[f64], index: usize) -> bool {
    index > 0 && knots[index] - knots[0] > TAU - SAME
}

/// The nodes above the horizon, each direction once: a pole has no azimuth, and a full turn ends where it begins.
fn of_specular(data: &specular::Data) -> Vec<Sample<'_>> {
    let [sigmas, psis, thetas, phis] = data.knots();
    let mut samples = Vec::new();
    for (s, &sigma) in sigmas.iter().enumerate().filter(|(_, sigma)| sigma.cos() > LOWEST) {
        for (p, &psi) in psis.iter().enumerate().filter(|(p, _)| !is_again(psis, *p)) {
            for (t, &theta) in thetas.iter().enumerate() {
                for (h, &phi) in phis.iter().enumerate().filter(|(h, _)| !is_again(phis, *h)) {
                    let ([..], [x, y, z]) = angles_to_directions([sigma, psi, theta, phi], |sigma| sigma);
                    if z <= LOWEST || theta.sin() < SAME && h > 0 {
                        continue;
                    }
                    let across = x.hypot(y);
                    let phi_o = if across > SAME { y.atan2(x).rem_euclid(TAU) } else { 0.0 };
                    let angles = [sigma, psi, across.atan2(z), phi_o];
                    samples.push(Sample { angles, values: data.texel([s, p, t, h]) });
                }
            }
        }
    }
    samples
}

/// The nodes of a grid, each direction once; the nodes of half a grid are the samples on one side of the plane of
/// incidence.
fn of_spherical(data: &spherical::Data) -> Vec<Sample<'_>> {
    let [theta_i, phi_i, theta_o, phi_o] = data.knots();
    let count = data.channels().count();
    let mut samples = Vec::new();
    for (i, &theta) in theta_i.iter().enumerate() {
        for (p, &phi) in phi_i.iter().enumerate().filter(|(p, _)| !is_again(phi_i, *p)) {
            for (o, &exit) in theta_o.iter().enumerate() {
                for (a, &azimuth) in phi_o.iter().enumerate().filter(|(a, _)| !is_again(phi_o, *a)) {
                    // Perpendicular light has only one azimuth, and so has the pole.
                    if theta < SAME && p > 0 || exit < SAME && a > 0 {
                        continue;
                    }
                    let node = ((i * phi_i.len() + p) * theta_o.len() + o) * phi_o.len() + a;
                    let values = &data.values()[node * count..][..count];
                    samples.push(Sample { angles: [theta, phi, exit, azimuth], values });
                }
            }
        }
    }
    samples
}
