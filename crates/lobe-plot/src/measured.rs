//! The directions at which a material was measured: the incidences to draw, the directions to mark, and the parts of
//! the hemisphere that are only continued.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe::formats::Document;
use lobe::table::specular::coords::{angles_to_directions, directions_to_angles};
use lobe::table::utia::{PHIS, THETAS};
use lobe::table::window::klems::AngleBasis;
use lobe::table::window::{self, Block, Component};
use lobe::table::{half_diff, scattered};
use lobe::{Data, Scatter, Side, specular};

use crate::geometry::{dot, incident};

/// Angles nearer than this, in radians, are the same.
const SAME: f64 = 1e-4;

/// The measurement of light that comes from one side and leaves on one side.
#[derive(Debug)]
pub(crate) struct Part {
    scatter: Scatter,
    /// `None` holds for light from either side.
    side: Option<Side>,
    /// Polar angles of the light in radians, ascending; empty if the representation has none of its own.
    pub(crate) incidences: Vec<f64>,
    /// The azimuth of the light in the default view, in radians.
    pub(crate) psi: f64,
    places: Places,
}

/// The outgoing directions of a measurement.
#[derive(Debug)]
enum Places {
    /// The representation has no directions of its own.
    Everywhere,
    /// A grid about the mirror direction, or about the refracted ray: sigma and its polar angle.
    Specular { theta: Vec<f64>, phi: Vec<f64>, zenith: Vec<[f64; 2]> },
    /// A grid about the normal; azimuths count from that of the light if it is isotropic.
    Spherical { theta: Vec<f64>, phi: Vec<f64>, is_relative: bool, is_mirrored: bool },
    /// Any directions, a list for each incidence.
    Scattered { incidences: Vec<Cloud>, is_isotropic: bool },
    /// Bins, of which some may be empty.
    Bins(half_diff::Data),
}

/// The outgoing directions of one incident direction, and the radius around each that counts as measured, in radians.
#[derive(Debug)]
struct Cloud {
    light: [f64; 2],
    /// Polar angle, and azimuth from that of the light.
    outgoing: Vec<[f64; 2]>,
    reach: f64,
}

/// The parts of a document.
pub(crate) fn parts(document: &Document) -> Vec<Part> {
    let has_value = |part: &&lobe::formats::Part| part.data.representation().mirror().is_none();
    let parts = document.parts.iter().filter(has_value);
    let on_side = |part: &lobe::formats::Part, found: Part| Part { side: part.side.or(found.side), ..found };
    parts.flat_map(|part| of_data(&part.data).into_iter().map(move |found| on_side(part, found))).collect()
}

fn of_data(data: &Data) -> Vec<Part> {
    match data {
        Data::Specular(data) => vec![table(data)],
        Data::Spherical(data) => vec![spherical(data)],
        Data::Scattered(data) => vec![scattered(data)],
        Data::Rgl(data) => {
            let parts = data.parts();
            vec![Part {
                incidences: parts.theta_i.iter().map(|&knot| f64::from(knot)).collect(),
                ..Part::reflection(Places::Everywhere)
            }]
        }
        Data::HalfDiff(data) => vec![Part::reflection(Places::Bins(data.clone()))],
        Data::Utia(_) => {
            let grid = |count: usize, step: f64| (0..count).map(|i| (step * i as f64).to_radians()).collect::<Vec<_>>();
            let (theta, phi) = (grid(THETAS, 15.0), grid(PHIS, 7.5));
            let places = Places::Spherical { theta: theta.clone(), phi, is_relative: false, is_mirrored: false };
            vec![Part { incidences: theta, ..Part::reflection(places) }]
        }
        Data::Window(data) => window(data),
        // Nothing is known about the directions of the others, so all are drawn as measured.
        _ => vec![Part::reflection(Places::Everywhere)],
    }
}

impl Part {
    fn reflection(places: Places) -> Self {
        Part { scatter: Scatter::Reflection, side: None, incidences: Vec::new(), psi: 0.0, places }
    }

    /// Whether this part answers for light from `side` that leaves by `scatter`.
    pub(crate) fn answers(&self, side: Side, scatter: Scatter) -> bool {
        self.scatter == scatter && self.side.unwrap_or(Side::Front) == side
    }

    /// The outgoing directions above the horizon that were measured for light at `sigma` and `psi`, as if light and
    /// viewer were both above. Empty if the representation has no directions of its own.
    pub(crate) fn directions(&self, sigma: f64, psi: f64) -> Vec<[f64; 3]> {
        let spherical = |theta: f64, phi: f64| [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
        let mut found = match &self.places {
            Places::Everywhere | Places::Bins(_) => Vec::new(),
            Places::Specular { theta, phi, zenith } => {
                let place = |theta: f64, phi: f64| {
                    angles_to_directions([sigma, psi, theta, phi], |sigma| at_sigma(zenith, sigma)).1
                };
                theta.iter().flat_map(|&theta| phi.iter().map(move |&phi| place(theta, phi))).collect()
            }
            Places::Spherical { theta, phi, is_relative, is_mirrored } => {
                let turn = if *is_relative { psi } else { 0.0 };
                let halves: &[f64] = if *is_mirrored { &[1.0, -1.0] } else { &[1.0] };
                let place = |theta: f64, phi: f64| halves.iter().map(move |half| spherical(theta, turn + half * phi));
                theta.iter().flat_map(|&theta| phi.iter().flat_map(move |&phi| place(theta, phi))).collect()
            }
            Places::Scattered { incidences, is_isotropic } => match nearest(incidences, *is_isotropic, sigma, psi) {
                Some(cloud) => {
                    let turn = if *is_isotropic { psi } else { cloud.light[1] };
                    cloud.outgoing.iter().map(|&[theta, phi]| spherical(theta, turn + phi)).collect()
                }
                None => Vec::new(),
            },
        };
        found.retain(|d: &[f64; 3]| d[2] > 1e-3);
        found
    }

    /// A test of outgoing directions for light at `sigma` and `psi`, as if light and viewer were both above: does the
    /// value lie within the measurement, rather than in its continuation?
    pub(crate) fn coverage(&self, sigma: f64, psi: f64) -> Box<dyn Fn([f64; 3]) -> bool + Sync + '_> {
        if matches!(self.places, Places::Everywhere) {
            return Box::new(|_| true);
        }
        let first = self.incidences.first().copied().unwrap_or(0.0);
        let last = self.incidences.last().copied().unwrap_or(FRAC_PI_2);
        // With one incidence there is nothing to be between.
        let is_between = self.incidences.len() > 1 && (first - SAME..=last + SAME).contains(&sigma);
        if !is_between && !self.incidences.iter().any(|knot| (knot - sigma).abs() < SAME) && !self.incidences.is_empty()
        {
            return Box::new(|_| false);
        }
        let polar = |wo: [f64; 3]| wo[0].hypot(wo[1]).atan2(wo[2]);
        match &self.places {
            Places::Everywhere => Box::new(|_| true),
            Places::Bins(data) => {
                let wi = incident(Side::Front, sigma, psi);
                Box::new(move |wo| data.is_measured(data.bin(wi, wo)))
            }
            Places::Specular { theta, zenith, .. } => {
                let wi = incident(Side::Front, sigma, psi);
                let last = theta.last().copied().unwrap_or(PI) + SAME;
                Box::new(move |wo| directions_to_angles(wi, wo, |sigma| at_sigma(zenith, sigma))[2] <= last)
            }
            Places::Spherical { theta, .. } => {
                let last = theta.last().copied().unwrap_or(FRAC_PI_2) + SAME;
                Box::new(move |wo| polar(wo) <= last)
            }
            Places::Scattered { incidences, is_isotropic } => {
                let reach = nearest(incidences, *is_isotropic, sigma, psi).map_or(0.0, |cloud| cloud.reach);
                let near = Near::new(self.directions(sigma, psi), reach);
                Box::new(move |wo| near.has_neighbour(wo))
            }
        }
    }
}

/// Tells whether a direction has others near it, by cells as wide as that distance.
struct Near {
    cells: HashMap<[i32; 3], Vec<[f64; 3]>>,
    width: f64,
    cos: f64,
}

impl Near {
    /// `reach` is how far near is, in radians.
    fn new(directions: Vec<[f64; 3]>, reach: f64) -> Self {
        // The chord of the angle: a neighbour is at most one cell away.
        let mut near = Near { cells: HashMap::new(), width: (2.0 * (0.5 * reach).sin()).max(1e-3), cos: reach.cos() };
        for direction in directions {
            near.cells.entry(near.cell(direction)).or_default().push(direction);
        }
        near
    }

    fn cell(&self, direction: [f64; 3]) -> [i32; 3] {
        direction.map(|c| (c / self.width).floor() as i32)
    }

    fn has_neighbour(&self, direction: [f64; 3]) -> bool {
        let [x, y, z] = self.cell(direction);
        let around = (0..27).filter_map(|at| self.cells.get(&[x + at % 3 - 1, y + at / 3 % 3 - 1, z + at / 9 - 1]));
        around.flatten().any(|place| dot(*place, direction) >= self.cos)
    }
}

fn table(data: &specular::Data) -> Part {
    let [sigma, psi, theta, phi] = data.knots();
    let offset = |index: usize| data.refraction().map_or(0.0, |offsets| offsets[index]);
    let zenith = sigma.iter().enumerate().map(|(index, &sigma)| [sigma, sigma + offset(index)]).collect();
    Part {
        scatter: data.scatter(),
        side: None,
        incidences: sigma.clone(),
        psi: psi[0],
        places: Places::Specular { theta: theta.clone(), phi: phi.clone(), zenith },
    }
}

fn spherical(data: &lobe::table::spherical::Data) -> Part {
    let [theta_i, phi_i, theta_o, phi_o] = data.knots();
    // The azimuths of an isotropic grid count from its only phi_i.
    let from = if data.is_isotropic() { phi_i[0] } else { 0.0 };
    Part {
        scatter: data.scatter(),
        side: None,
        incidences: theta_i.clone(),
        psi: if data.is_isotropic() { 0.0 } else { phi_i[0] },
        places: Places::Spherical {
            theta: theta_o.clone(),
            phi: phi_o.iter().map(|phi| phi - from).collect(),
            is_relative: data.is_isotropic(),
            is_mirrored: data.is_mirrored(),
        },
    }
}

fn scattered(data: &scattered::Data) -> Part {
    let mut clouds: Vec<Cloud> =
        data.incidences().map(|light| Cloud { light, outgoing: Vec::new(), reach: 0.0 }).collect();
    let mut at = 0;
    let mut sides = [false; 2];
    for ([theta_i, phi_i, theta_o, phi_o], _) in data.samples() {
        // The samples come incidence by incidence.
        while clouds[at].light != [theta_i, phi_i] && at + 1 < clouds.len() {
            at += 1;
        }
        let relative = phi_o - phi_i;
        let across = theta_o.sin() * relative.sin();
        sides = [sides[0] || across > SAME, sides[1] || across < -SAME];
        clouds[at].outgoing.push([theta_o, relative]);
    }
    // If only one half of an isotropic material was measured, it is used for both.
    if data.is_isotropic() && sides[0] != sides[1] {
        for cloud in &mut clouds {
            let mirrored: Vec<_> = cloud.outgoing.iter().map(|&[theta, phi]| [theta, -phi]).collect();
            cloud.outgoing.extend(mirrored);
        }
    }
    clouds.iter_mut().for_each(|cloud| cloud.reach = reach(&cloud.outgoing));
    let mut incidences: Vec<f64> = clouds.iter().map(|cloud| cloud.light[0]).collect();
    incidences.dedup_by(|a, b| (*a - *b).abs() < SAME);
    Part {
        scatter: data.scatter(),
        side: None,
        incidences,
        psi: if data.is_isotropic() { 0.0 } else { clouds[clouds.len() - 1].light[1] },
        places: Places::Scattered { incidences: clouds, is_isotropic: data.is_isotropic() },
    }
}

/// One and a half times the distance at which most directions have a neighbour, within reason.
fn reach(outgoing: &[[f64; 2]]) -> f64 {
    let directions: Vec<[f64; 3]> =
        outgoing.iter().map(|[theta, phi]| [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]).collect();
    // A few hundred directions are enough for an estimate.
    let step = directions.len().div_ceil(200);
    let mut nearest: Vec<f64> = Vec::new();
    for a in directions.iter().step_by(step) {
        let others = directions.iter().map(|b| dot(*a, *b)).filter(|cos| *cos < 1.0 - 1e-9);
        nearest.push(others.fold(-1.0, f64::max).acos());
    }
    nearest.sort_by(f64::total_cmp);
    let most = nearest.get(nearest.len() * 9 / 10).copied().unwrap_or(0.0);
    (1.5 * most).clamp(2.5_f64.to_radians(), 15_f64.to_radians())
}

fn window(data: &window::Data) -> Vec<Part> {
    let Some(band) = data.bands.first() else { return Vec::new() };
    let mut parts = Vec::new();
    for block in Block::ALL {
        // A missing transmission block is the other one with light and viewer exchanged.
        let stand_in = match block {
            Block::TransmissionFront => Block::TransmissionBack,
            Block::TransmissionBack => Block::TransmissionFront,
            Block::ReflectionFront | Block::ReflectionBack => block,
        };
        let Some(component) = band.window.block(block).or_else(|| band.window.block(stand_in)) else { continue };
        let (scatter, side) = match block {
            Block::TransmissionFront => (Scatter::Transmission, Side::Back),
            Block::TransmissionBack => (Scatter::Transmission, Side::Front),
            Block::ReflectionFront => (Scatter::Reflection, Side::Back),
            Block::ReflectionBack => (Scatter::Reflection, Side::Front),
        };
        let incidences = match component {
            Component::Klems(matrix) => middles(matrix.incident()),
            Component::Tree(_) => Vec::new(),
        };
        parts.push(Part { scatter, side: Some(side), incidences, ..Part::reflection(Places::Everywhere) });
    }
    parts
}

/// The middles of the rings of a basis in radians; the first ring is a cap about the normal.
fn middles(basis: &AngleBasis) -> Vec<f64> {
    let middle = |ring: &lobe::table::window::klems::Ring| match ring.lower {
        lower if lower < 1e-3 => 0.0,
        lower => (0.5 * (lower + ring.upper)).to_radians(),
    };
    basis.rings().iter().map(middle).collect()
}

/// The polar angle of the zenith at `sigma`, linear between the knots.
fn at_sigma(zenith: &[[f64; 2]], sigma: f64) -> f64 {
    let upper = zenith.partition_point(|[knot, _]| *knot < sigma).min(zenith.len() - 1);
    let ([a, from], [b, to]) = (zenith[upper.saturating_sub(1)], zenith[upper]);
    // The offset from sigma is interpolated, which is 0 without refraction.
    let share = if b > a { ((sigma - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
    sigma + (1.0 - share) * (from - a) + share * (to - b)
}

fn nearest(clouds: &[Cloud], is_isotropic: bool, sigma: f64, psi: f64) -> Option<&Cloud> {
    let wi = incident(Side::Front, sigma, psi);
    let distance = |cloud: &&Cloud| match is_isotropic {
        true => (cloud.light[0] - sigma).abs(),
        false => -dot(incident(Side::Front, cloud.light[0], cloud.light[1].rem_euclid(TAU)), wi),
    };
    clouds.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_found_across_cells_and_nowhere_else() {
        let direction = |degrees: f64| incident(Side::Front, degrees.to_radians(), 0.7);
        let near = Near::new((0..9).map(|i| direction(10.0 * f64::from(i))).collect(), 3_f64.to_radians());
        for tenths in 0..880 {
            let degrees = 0.1 * f64::from(tenths) + 0.05;
            let distance = (degrees - 10.0 * (degrees / 10.0).round().min(8.0)).abs();
            assert_eq!(near.has_neighbour(direction(degrees)), distance < 3.0, "{degrees}");
        }
    }

    #[test]
    fn the_refracted_ray_is_linear_between_its_knots_and_goes_on_beside_them() {
        let zenith = [[0.0, 0.0], [0.8, 0.5]];
        for (sigma, expected) in [(0.0, 0.0), (0.4, 0.25), (0.8, 0.5), (1.0, 0.7)] {
            assert!((at_sigma(&zenith, sigma) - expected).abs() < 1e-12, "{sigma}");
        }
        assert_eq!(at_sigma(&[[0.3, 0.3]], 1.0), 1.0);
    }
}
