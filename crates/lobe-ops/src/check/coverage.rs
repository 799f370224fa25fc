//! Which parts of the hemisphere were measured.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use lobe_formats::Document;
use lobe_table::specular::AXIS_NAMES;
use lobe_table::window::{Band, Block};
use lobe_table::{Data, scattered, specular};

use super::finding::{Finding, Status, degrees, part_name, percent};
use crate::directions::spherical;
use crate::samples::{directions, nodes};

pub(super) fn check(document: &Document) -> Vec<Finding> {
    document.parts.iter().flat_map(|part| of_part(&part.data, &part_name(document, part))).collect()
}

fn of_part(data: &Data, name: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    if let Data::Specular(samples) = data {
        findings.extend(dark_nodes(samples, name));
    }
    if let Data::Scattered(scattered) = data {
        findings.extend(of_samples(scattered, name));
    }
    if let Data::Window(window) = data {
        findings.extend(window.bands.iter().map(of_band));
    }
    let extent = data.representation().extent();
    findings.extend(extent.map(|extent| Finding::new("coverage", name, Status::Note, extent.into())));
    findings
}

/// Which of the four measurements of a sheet a band has.
fn of_band(band: &Band) -> Finding {
    let missing: Vec<String> = Block::ALL
        .into_iter()
        .filter(|&block| band.window.block(block).is_none())
        .map(|block| block.aspect().to_string())
        .collect();
    let (status, text) = match missing.as_slice() {
        [] => (Status::Pass, "transmission and reflection of both sides".into()),
        [one] if one.starts_with("transmission") => {
            (Status::Note, format!("no {one}: the transmission of the other side is used for it"))
        }
        _ => (Status::Warn, format!("no {}: dark there", missing.join(", no "))),
    };
    Finding::new("coverage", &band.wavelength, status, text)
}

/// Nodes of a table above the horizon that are exactly 0, and their share of all.
fn dark_nodes(samples: &specular::Data, part: &str) -> Option<Finding> {
    let channels = samples.channels().count();
    let (mut dark, mut above) = (0_usize, 0_usize);
    for (node, texel) in nodes(samples).zip(samples.values().chunks_exact(channels)) {
        if directions(samples, node).1[2] > 1e-3 {
            above += 1;
            dark += usize::from(texel.iter().all(|&value| value == 0.0));
        }
    }
    if dark == 0 {
        return None;
    }
    let share = dark as f64 / above.max(1) as f64;
    let text = format!(
        "{dark} of {above} nodes above the horizon ({}) are exactly 0: the {} or {} there was probably not measured",
        percent(share),
        AXIS_NAMES[2],
        AXIS_NAMES[3]
    );
    let status = if share > 0.1 { Status::Warn } else { Status::Note };
    Some(Finding::new("coverage", part, status, text).number("dark", dark as f64).number("above", above as f64))
}

/// Whether only the plane of incidence was measured, so that no integral over the hemisphere is a measurement.
pub(super) fn is_in_plane(data: &scattered::Data) -> bool {
    data.samples().all(|([_, phi_i, theta, phi], _)| theta < 1e-3 || (phi - phi_i).sin().abs() < 1e-3)
}

/// The incidences at which the brightest sample is toward the light: such data are often read the wrong way round.
fn backward(data: &scattered::Data, part: &str) -> Option<Finding> {
    let mut brightest: Vec<([f64; 4], f64)> = Vec::new();
    for (angles, texel) in data.samples() {
        let value: f64 = texel.iter().map(|&value| f64::from(value)).sum();
        match brightest.last_mut() {
            Some((other, most)) if other[..2] == angles[..2] => {
                if value > *most {
                    (*other, *most) = (angles, value);
                }
            }
            _ => brightest.push((angles, value)),
        }
    }
    let is_backward = |[theta_i, phi_i, theta, phi]: [f64; 4]| {
        let (wi, wo) = (spherical(theta_i, phi_i), spherical(theta, phi));
        let cos = |w: [f64; 3]| wo.iter().zip(w).map(|(a, b)| a * b).sum::<f64>();
        cos(wi) > 0.97 && cos([-wi[0], -wi[1], wi[2]]) < 0.9
    };
    let thetas: Vec<String> =
        brightest.iter().filter(|(angles, _)| is_backward(*angles)).map(|(angles, _)| degrees(angles[0])).collect();
    (!thetas.is_empty()).then(|| {
        let list =
            if thetas.len() > 12 { format!("{} directions", thetas.len()) } else { thetas.join(" ") + " degrees" };
        Finding::new("peak", part, Status::Note, format!("brightest toward the light itself, for light at {list}"))
    })
}

/// The sectors of outgoing directions that are counted: 15 degrees of polar angle by 30 of azimuth.
const RINGS: usize = 6;
const SECTORS: usize = 12;

/// The incidences, and the number of sectors of the hemisphere with samples.
fn of_samples(data: &scattered::Data, part: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    let incidences: Vec<[f64; 2]> = data.incidences().collect();
    let thetas: BTreeSet<i64> =
        incidences.iter().map(|[theta, _]| (theta.to_degrees() * 10.0).round() as i64).collect();
    let list: Vec<String> = thetas.iter().map(|tenths| degrees((*tenths as f64 / 10.0).to_radians())).collect();
    let widest = list.len().max(1);
    let shown = if widest > 12 { format!("{} polar angles to {}", widest, list[widest - 1]) } else { list.join(" ") };
    let text = format!(
        "light from {}, at {shown} degrees; between and beyond these, the nearest is used",
        match incidences.len() {
            1 => "one direction".into(),
            n => format!("{n} directions"),
        }
    );
    let (status, few) = match thetas.len() {
        1 => (Status::Warn, ". One angle of incidence says nothing about the others"),
        2 | 3 => (Status::Warn, ". So few are too sparse for pictures"),
        _ => (Status::Note, ""),
    };
    let finding = Finding::new("coverage", part, status, format!("{text}{few}"));
    findings.push(finding.number("incidences", incidences.len() as f64));

    let (mut least, mut at) = (usize::MAX, 0.0);
    let mut sectors = BTreeSet::new();
    let mut samples = data.samples().peekable();
    let mut is_left = true;
    let mut is_right = true;
    while let Some(([theta_i, phi_i, theta, phi], _)) = samples.next() {
        let relative = (phi - phi_i).rem_euclid(TAU);
        is_left &= theta.sin() * relative.sin() > -1e-6;
        is_right &= theta.sin() * relative.sin() < 1e-6;
        let ring = ((theta * RINGS as f64 / (PI / 2.0)) as usize).min(RINGS - 1);
        let sector = ((relative * SECTORS as f64 / TAU) as usize).min(SECTORS - 1);
        sectors.insert((ring, sector));
        let is_last = samples.peek().is_none_or(|(next, _)| next[..2] != [theta_i, phi_i]);
        if is_last {
            if sectors.len() < least {
                (least, at) = (sectors.len(), theta_i);
            }
            sectors.clear();
        }
    }
    // If only one side of the plane was measured, the other is its mirror image.
    let all = RINGS * SECTORS / if data.is_isotropic() && (is_left || is_right) { 2 } else { 1 };
    let (status, text) = if is_in_plane(data) {
        (Status::Warn, "measured in the plane of incidence only, and guessed everywhere else".to_string())
    } else {
        let share = least as f64 / all as f64;
        let text = format!(
            "samples in at least {least} of {all} sectors of 15 by 30 degrees, least for light at {} degrees",
            degrees(at)
        );
        (if share < 0.5 { Status::Warn } else { Status::Note }, text)
    };
    findings
        .push(Finding::new("coverage", part, status, text).number("sectors", least as f64).number("of", all as f64));
    findings.extend(backward(data, part));
    findings
}
