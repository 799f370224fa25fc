//! The azimuth of the viewer: tables in the plane of incidence, and the origin of azimuths.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use super::layout::Layout;
use super::samples::Samples;
use super::source::Source;
use crate::reading::{AzimuthFrom, InPlane, ReadOptions};
use crate::{FormatError, Place};

/// Gives each row the azimuth of its viewer, if no column does.
pub(super) fn place(
    samples: &mut Samples,
    layout: &Layout,
    options: &ReadOptions,
    file: &Path,
    notes: &mut Vec<String>,
) -> Result<(), FormatError> {
    let refused = |found: &str, expected: &str| Err(FormatError::new(file, Place::File, found, expected));
    let is_missing = |axis: usize| layout.angles[axis] == Source::Missing;
    if !is_missing(3) {
        if options.in_plane.is_some() {
            return refused("azimuths of the viewer, and in-plane", "one of them");
        }
        match options.azimuth_from {
            Some(_) if !is_missing(1) => return refused("azimuths of the light, and azimuth-from", "one of them"),
            Some(AzimuthFrom::Mirror) => {
                notes.push("azimuths counted from the side of the mirror direction, as the options say".into());
                samples.angles.iter_mut().for_each(|angles| angles[3] += PI);
            }
            _ if is_missing(1) => {
                notes.push("azimuths counted from the side of the light: the mirror direction is at 180 degrees".into())
            }
            _ => {}
        }
        return Ok(());
    }
    if options.azimuth_from.is_some() {
        return refused("no azimuths of the viewer, and azimuth-from", "a column of phi_o, or in-plane");
    }
    let has = |sign: fn(f64) -> bool| samples.angles.iter().any(|angles| sign(angles[0]));
    let (negative, positive) = (has(|theta| theta < 0.0), has(|theta| theta > 0.0));
    let (how, why) = match (options.in_plane, negative, positive) {
        (Some(how), ..) => (how, "as the options say"),
        (None, true, true) => {
            let expected = "--in-plane same-sign if the mirror direction of theta_i is theta_o = theta_i, or --in-plane opposite-sign if it is -theta_i";
            return refused("theta_i of both signs, and no azimuths", expected);
        }
        (None, true, false) => (InPlane::OppositeSign, "because there is no azimuth"),
        (None, false, _) => (InPlane::SameSign, "because there is no azimuth"),
    };
    let mirror = match how {
        InPlane::SameSign => "theta_o = theta_i",
        InPlane::OppositeSign => "theta_o = -theta_i",
    };
    notes.push(format!("in the plane of incidence, {why}: the mirror direction is at {mirror}"));
    for angles in &mut samples.angles {
        angles[3] = angles[1] + if how == InPlane::SameSign { PI } else { 0.0 };
    }
    Ok(())
}

/// The distance from the plane of incidence and from the polar angle of the light up to which samples are compared, in
/// radians.
const NEAR: [f64; 2] = [0.36, 0.14];
/// The ratio by which the side of the light has to be brighter.
const BRIGHTER: f32 = 1.25;

/// Adds a doubt if a table looks as if the mirror direction were on the other side.
pub(super) fn doubt(samples: &Samples, layout: &Layout, options: &ReadOptions) -> Option<String> {
    let is_open = match layout.angles[3] {
        Source::Missing => options.in_plane.is_none(),
        _ => layout.angles[1] == Source::Missing && options.azimuth_from.is_none(),
    };
    if !is_open {
        return None;
    }
    // For each incidence: the brightest values near the mirror direction and near the light.
    let mut brightest: BTreeMap<i64, [f32; 2]> = BTreeMap::new();
    let count = samples.channels.count();
    for (angles, texel) in samples.angles.iter().zip(samples.values.chunks_exact(count)) {
        let [theta_i, phi_i, theta_o, phi_o] = *angles;
        let turn = |theta: f64| if theta < 0.0 { PI } else { 0.0 };
        let relative = (phi_o + turn(theta_o) - phi_i - turn(theta_i)).cos();
        let is_near = relative.abs() > NEAR[0].cos() && (theta_o.abs() - theta_i.abs()).abs() < NEAR[1];
        if !is_near || theta_i.abs() < 0.2 || theta_o.abs() > FRAC_PI_2 {
            continue;
        }
        let sides = brightest.entry((theta_i * 1e4).round() as i64).or_insert([f32::MIN; 2]);
        let side = &mut sides[usize::from(relative > 0.0)];
        *side = side.max(texel.iter().sum());
    }
    let both: Vec<[f32; 2]> =
        brightest.into_values().filter(|sides| sides.iter().all(|value| *value > f32::MIN)).collect();
    let doubtful = both.iter().filter(|[mirror, light]| *light > BRIGHTER * mirror.max(0.0)).count();
    let how = if layout.angles[3] == Source::Missing { "in-plane opposite-sign" } else { "azimuth-from mirror" };
    let doubt = || {
        format!(
            "at {doubtful} of {} incidences it is brighter toward the light than in the mirror direction; if that is wrong, use {how}",
            both.len()
        )
    };
    (2 * doubtful > both.len()).then(doubt)
}
