//! The measured parts of the hemisphere.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use lobe_formats::Document;
use lobe_table::specular::AXIS_NAMES;
use lobe_table::specular::coords::angles_to_directions;
use lobe_table::{Aspect, Edges, Representation, Scatter};

use super::finding::{Finding, Status, degrees, part_name, percent};
use crate::directions::spherical;

pub(super) fn check(document: &Document) -> Vec<Finding> {
    document.parts.iter().flat_map(|part| of_data(part.data.representation(), &part_name(document, part))).collect()
}

fn of_data(data: &dyn Representation, name: &str) -> Vec<Finding> {
    let mut findings: Vec<Finding> = dark_nodes(data, name).into_iter().collect();
    findings.extend(of_samples(data, name));
    if data.is_two_sided() {
        findings.extend(data.channels().names().iter().map(|band| of_band(data, band)));
    }
    let extent = data.extent();
    findings.extend(extent.map(|extent| Finding::new("coverage", name, Status::Note, extent.into())));
    findings
}

/// The measurements of a sheet that a band has, and the values that an evaluation gives for the others.
fn of_band(data: &dyn Representation, band: &str) -> Finding {
    let sections = data.sections();
    let of_band = sections.iter().filter(|section| section.channels.names() == [band]);
    let measured: Vec<Aspect> = of_band.map(|section| section.aspect).collect();
    let (mut dark, mut answered) = (Vec::new(), Vec::new());
    for aspect in [Aspect::ALL[3], Aspect::ALL[1], Aspect::ALL[0], Aspect::ALL[2]] {
        let is_known_backward = aspect.scatter == Scatter::Transmission && measured.contains(&aspect.reversed());
        match measured.contains(&aspect) {
            true => {}
            false if is_known_backward => answered.push(aspect.to_string()),
            false => dark.push(aspect.to_string()),
        }
    }
    let mut text = Vec::new();
    if !answered.is_empty() {
        text.push(format!("no {}: that of the other direction is used for it", answered.join(", no ")));
    }
    if !dark.is_empty() {
        text.push(format!("no {}: 0 there", dark.join(", no ")));
    }
    let (status, text) = match (dark.is_empty(), text.is_empty()) {
        (_, true) => (Status::Pass, "transmission and reflection of both sides".into()),
        (true, _) => (Status::Note, text.join("; ")),
        (false, _) => (Status::Warn, text.join("; ")),
    };
    Finding::new("coverage", band, status, text)
}

/// Nodes of a table about the mirror direction that are above the horizon and exactly 0, and their share of all.
fn dark_nodes(data: &dyn Representation, part: &str) -> Option<Finding> {
    let grid = data.grid().filter(|grid| grid.is_specular)?;
    let [sigmas, psis, thetas, phis] = grid.knots;
    let mut texels = grid.values.chunks_exact(grid.channels);
    let (mut dark, mut above) = (0_usize, 0_usize);
    for &sigma in sigmas {
        let zenith = data.kinks(&Edges::default(), [sigma, psis[0]]).map_or(sigma, |kinks| kinks.zenith);
        for &psi in psis {
            for &theta in thetas {
                for (&phi, texel) in phis.iter().zip(&mut texels) {
                    if angles_to_directions([sigma, psi, theta, phi], |_| zenith).1[2] > 1e-3 {
                        above += 1;
                        dark += usize::from(texel.iter().all(|&value| value == 0.0));
                    }
                }
            }
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

/// `true` if only the plane of incidence was measured, so that no integral over the hemisphere is a measurement.
pub(crate) fn is_in_plane(data: &dyn Representation) -> bool {
    let is_flat = |([_, phi_i, theta, phi], _): ([f64; 4], &[f32])| theta < 1e-3 || (phi - phi_i).sin().abs() < 1e-3;
    data.samples().is_some_and(|mut samples| samples.all(is_flat))
}

/// The incidences at which the brightest sample is toward the light: such data are often read the wrong way around.
fn backward(data: &dyn Representation, part: &str) -> Option<Finding> {
    let mut brightest: Vec<([f64; 4], f64)> = Vec::new();
    for (angles, texel) in data.samples()? {
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

/// What is said of data with one outgoing direction for each incident one.
pub(super) const ONE_VIEW: &str =
    "only one outgoing direction was measured for each incident one, which is used for all others";

/// `true` if there is one outgoing direction for each incident one.
pub(super) fn has_one_view(data: &dyn Representation) -> bool {
    let Some(samples) = data.samples() else { return false };
    let mut lights = BTreeSet::new();
    let mut samples = samples.map(|(angles, _)| [angles[0], angles[1]].map(f64::to_bits));
    samples.all(|light| lights.insert(light))
}

/// The polar angle of the light in degrees, if it is the only one.
pub(super) fn only_light(data: &dyn Representation) -> Option<String> {
    let mut samples = data.samples()?.map(|([theta, ..], _)| theta);
    let first = samples.next()?;
    samples.all(|theta| (theta - first).abs() < 1e-6).then(|| degrees(first))
}

/// The sectors of outgoing directions that are counted: 15 degrees of polar angle by 30 of azimuth.
const RINGS: usize = 6;
const SECTORS: usize = 12;

/// With samples in a smaller share of the sectors than this, an integral over the hemisphere is a guess.
const SPARSE: f64 = 0.25;

/// The number of sectors of the hemisphere with samples, for each incidence.
struct Sectors {
    /// For each incidence, in the order of the data.
    counts: Vec<([f64; 2], usize)>,
    /// The sectors of the hemisphere; those of one half, if the other is its mirror image.
    all: usize,
}

impl Sectors {
    fn new(data: &dyn Representation) -> Self {
        let mut counts = Vec::new();
        let mut sectors = BTreeSet::new();
        let mut samples = data.samples().into_iter().flatten().peekable();
        let (mut is_left, mut is_right) = (true, true);
        while let Some(([theta_i, phi_i, theta, phi], _)) = samples.next() {
            let relative = (phi - phi_i).rem_euclid(TAU);
            is_left &= theta.sin() * relative.sin() > -1e-6;
            is_right &= theta.sin() * relative.sin() < 1e-6;
            let ring = ((theta * RINGS as f64 / (PI / 2.0)) as usize).min(RINGS - 1);
            let sector = ((relative * SECTORS as f64 / TAU) as usize).min(SECTORS - 1);
            sectors.insert((ring, sector));
            if samples.peek().is_none_or(|(next, _)| next[..2] != [theta_i, phi_i]) {
                counts.push(([theta_i, phi_i], sectors.len()));
                sectors.clear();
            }
        }
        let all = RINGS * SECTORS / if data.is_isotropic() && (is_left || is_right) { 2 } else { 1 };
        Sectors { counts, all }
    }

    /// The incidence with the fewest, and their share of all.
    fn least(&self) -> Option<([f64; 2], usize, f64)> {
        let least = self.counts.iter().min_by_key(|(_, count)| *count)?;
        Some((least.0, least.1, least.1 as f64 / self.all as f64))
    }
}

/// The incidences with so few outgoing directions that their integral is unknown.
pub(super) fn sparse(data: &dyn Representation) -> Vec<[f64; 2]> {
    let Sectors { counts, all } = Sectors::new(data);
    let is_sparse = |(_, count): &([f64; 2], usize)| (*count as f64) < SPARSE * all as f64;
    counts.into_iter().filter(is_sparse).map(|(incidence, _)| incidence).collect()
}

/// The incidences, and the number of sectors of the hemisphere with samples, for data without a grid.
fn of_samples(data: &dyn Representation, part: &str) -> Vec<Finding> {
    if data.samples().is_none() {
        return Vec::new();
    }
    let mut findings = Vec::new();
    let incidences: Vec<[f64; 2]> = data.aspects().first().map_or_else(Vec::new, |aspect| data.incidences(*aspect));
    let thetas: BTreeSet<i64> =
        incidences.iter().map(|[theta, _]| (theta.to_degrees() * 10.0).round() as i64).collect();
    let list: Vec<String> = thetas.iter().map(|tenths| degrees((*tenths as f64 / 10.0).to_radians())).collect();
    let widest = list.len().max(1);
    let shown = if widest > 12 { format!("{} polar angles to {}", widest, list[widest - 1]) } else { list.join(" ") };
    let text = match incidences.len() {
        1 => format!("light from one direction, at {shown} degrees, which is used for all others"),
        n => format!("light from {n} directions, at {shown} degrees; linear between them, and beyond them the nearest"),
    };
    let (status, few) = match thetas.len() {
        1 => (Status::Warn, ". One angle of incidence says nothing about the others"),
        2 | 3 => (Status::Warn, ". So few are too sparse for pictures"),
        _ => (Status::Note, ""),
    };
    let finding = Finding::new("coverage", part, status, format!("{text}{few}"));
    findings.push(finding.number("incidences", incidences.len() as f64));

    let sectors = Sectors::new(data);
    let Some(([theta, _], least, share)) = sectors.least() else { return findings };
    let (status, text) = if is_in_plane(data) {
        (Status::Warn, "measured only in the plane of incidence, and guessed everywhere else".to_string())
    } else {
        let text = format!(
            "samples in at least {least} of {} sectors of 15 by 30 degrees, fewest for light at {} degrees",
            sectors.all,
            degrees(theta)
        );
        (if share < 0.5 { Status::Warn } else { Status::Note }, text)
    };
    findings.push(
        Finding::new("coverage", part, status, text).number("sectors", least as f64).number("of", sectors.all as f64),
    );
    if has_one_view(data) {
        findings.push(Finding::new("coverage", part, Status::Warn, ONE_VIEW.into()));
    }
    findings.extend(backward(data, part));
    findings
}
