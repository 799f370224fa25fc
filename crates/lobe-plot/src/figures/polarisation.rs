//! The linear polarisation of what unpolarised light becomes: its degree in the plane of incidence, and degree and angle
//! over the hemisphere.

use std::f64::consts::FRAC_PI_4;
use std::fmt::Write as _;

use super::bar::ramp;
use super::cartesian::title;
use super::chart::Axis;
use super::legend::{Entry, Legend};
use super::shared::{MARGIN, MIDDLE, conditions, heading, id, notes};
use super::slices::{Place, light_and_mirror, ring, rings};
use super::small::{Small, Trace};
use crate::evaluate::Progress;
use crate::geometry::{cross, from_disk, incident, to_disk};
use crate::image::Image;
use crate::ink::Ink;
use crate::layout::{Layout, Paper};
use crate::polarised::{Curve, Linear, axis, curves, matrices, scatter};
use crate::scale::{Scale, Scaling, degrees};
use crate::shown::Shown;
use crate::svg::{Anchor, Area, LABEL, Role, Svg, Text, number};
use crate::view::View;

/// At most this many incidences.
pub(super) const MOST: usize = 3;
/// The radius of a disk on wide paper.
const RADIUS: f64 = 100.0;
/// The space above a disk, and below it.
const ABOVE: f64 = 26.0;
const BELOW: f64 = 14.0;
/// Light of a smaller degree of polarisation has no angle worth showing.
const FAINT: f32 = 0.01;

/// The hemisphere of one incidence.
#[derive(Debug)]
pub(super) struct Disk {
    pub(super) sigma: f64,
    /// Pixels along each side of the square around the disk.
    size: usize,
    /// Rows from the top; `None` outside the disk, and where there is no light.
    light: Vec<Option<Linear>>,
    is_measured: Vec<bool>,
    /// Directions with a stroke along the polarisation.
    strokes: Vec<Stroke>,
}

/// The polarisation of one direction.
#[derive(Debug)]
struct Stroke {
    /// On the unit disk.
    at: [f64; 2],
    /// The direction in which the light oscillates there, of unit length.
    along: [f64; 2],
    light: Linear,
    /// What is said at the pointer.
    text: String,
}

/// What a figure shows.
#[derive(Debug)]
pub(super) struct Found {
    curves: Vec<Curve>,
    pub(super) disks: Vec<Disk>,
}

/// The polarisation of each incidence; nothing if the material is not polarised.
pub(super) fn found(shown: Shown<'_>, progress: &dyn Progress) -> Found {
    let Shown { subject, view } = shown;
    let sigmas = view.incidences(subject, MOST);
    let size = (2.4 * RADIUS * f64::from(view.width) / Layout::WIDE.width).round().clamp(96.0, 360.0) as usize;
    let curves = curves(subject, view, &sigmas, progress);
    progress.begin("polarisation", (FRAC_PI_4 * (size * size * curves.len()) as f64) as u64);
    let disks = curves.iter().map(|curve| disk(shown, curve.sigma, size, progress)).collect();
    Found { curves, disks }
}

fn disk(shown: Shown<'_>, sigma: f64, size: usize, progress: &dyn Progress) -> Disk {
    let Shown { subject, view } = shown;
    let scatter = scatter(subject, view.side).unwrap_or(lobe::Scatter::Reflection);
    let wi = incident(view.side, sigma, view.psi);
    let place = |at: usize| {
        let [x, y] = [at % size, at / size].map(|pixel| 2.0 * (pixel as f64 + 0.5) / size as f64 - 1.0);
        from_disk(view.side, scatter, view.psi, x, -y)
    };
    let of = |outgoing: &[[f64; 3]]| matrices(subject, &view.quantity, view.psi, wi, outgoing, progress);
    let (inside, outgoing): (Vec<usize>, Vec<[f64; 3]>) =
        (0..size * size).filter_map(|at| Some((at, place(at)?))).unzip();
    let is_covered = subject.coverage(view.side, scatter, sigma, view.psi);
    let (mut light, mut is_measured) = (vec![None; size * size], vec![false; size * size]);
    for ((at, matrix), wo) in inside.into_iter().zip(of(&outgoing)).zip(&outgoing) {
        (light[at], is_measured[at]) = (Linear::of(&matrix), is_covered(*wo));
    }
    let mut spots = vec![Spot { theta: 0.0, turn: 0.0, at: [0.0, 0.0] }];
    for theta in [15.0, 30.0, 45.0, 60.0, 75.0_f64] {
        let turns = (-5..=6).map(|step| 30.0 * f64::from(step));
        spots.extend(turns.map(|turn: f64| {
            let (sin, cos) = turn.to_radians().sin_cos();
            Spot { theta, turn, at: [ring(theta) * cos, ring(theta) * sin] }
        }));
    }
    let directions: Vec<[f64; 3]> =
        spots.iter().filter_map(|Spot { at: [x, y], .. }| from_disk(view.side, scatter, view.psi, *x, *y)).collect();
    let stroke = |((spot, matrix), &wo): ((&Spot, _), &[f64; 3])| {
        let Spot { theta, turn, at } = *spot;
        let light = Linear::of(matrix)?;
        let turn = if theta > 0.0 { format!(", {turn}° from the mirror side") } else { String::new() };
        let kind = if is_covered(wo) { "" } else { ", not measured" };
        let (degree, angle) = (percent(light.degree), light.angle.to_degrees());
        let text = format!("σ = {}, θ = {theta}°{turn}: {degree}, {angle:.0}°{kind}", degrees(sigma));
        Some(Stroke { at, along: along(view, wi, wo, light), light, text })
    };
    let strokes = spots.iter().zip(&of(&directions)).zip(&directions).filter_map(stroke).collect();
    Disk { sigma, size, light, is_measured, strokes }
}

/// A point of the disk with a stroke: the polar angle and the azimuth from the mirror side, in degrees.
struct Spot {
    theta: f64,
    turn: f64,
    at: [f64; 2],
}

/// The direction on the disk in which light that leaves along `wo` oscillates.
fn along(view: &View, wi: [f64; 3], wo: [f64; 3], light: Linear) -> [f64; 2] {
    const STEP: f64 = 1e-4;
    let x = axis(wi, wo, view.psi);
    let y = cross(wo, x);
    let (sin, cos) = f64::from(light.angle).sin_cos();
    let [forth, back] = [STEP, -STEP].map(|step| {
        let moved: [f64; 3] = std::array::from_fn(|k| wo[k] + step * (cos * x[k] + sin * y[k]));
        to_disk(view.side, view.psi, moved)
    });
    let (u, v) = (forth[0] - back[0], forth[1] - back[1]);
    let length = u.hypot(v).max(f64::MIN_POSITIVE);
    [u / length, v / length]
}

fn percent(degree: f32) -> String {
    let percent = 100.0 * degree;
    if percent < 10.0 { format!("{percent:.1} %") } else { format!("{percent:.0} %") }
}

pub(super) fn draw(shown: Shown<'_>, found: &Found, paper: Paper<'_>) -> String {
    let layout = paper.layout;
    let mut svg = Svg::new(id("polarisation", shown.view), paper);
    let what = format!("Linear polarisation of unpolarised light after scattering, {}", conditions(&[shown]));
    let top = heading(&mut svg, &[shown], &what) + 6.0;
    let high = highest(found);
    let y = panel(&mut svg, found, top, high);
    let columns = found.disks.len().clamp(1, MOST) as f64;
    let cell = (layout.width - 2.0 * MARGIN) / columns;
    let radius = RADIUS.min(0.5 * cell - 6.0);
    let size = if layout.is_narrow { 14.0 } else { 16.0 };
    let row = 2.0 * radius + ABOVE + BELOW;
    let label = Text { is_heavy: true, size, ..MIDDLE };
    for (at, disk) in found.disks.iter().enumerate() {
        let x = MARGIN + cell * (at as f64 + 0.5);
        for (row_at, picture) in [degrees_picture(disk, high), angles_picture(disk)].iter().enumerate() {
            let place = Place { x, y: y + row * row_at as f64 + ABOVE + radius, radius };
            let corner = Area { x: x - radius, y: place.y - radius, width: 2.0 * radius, height: 2.0 * radius };
            svg.image(corner, picture);
            rings(&mut svg, place);
            if row_at == 0 {
                strokes(&mut svg, place, disk);
            }
            light_and_mirror(&mut svg, place, shown.view, disk.sigma);
            for Stroke { at, text, .. } in &disk.strokes {
                svg.hint(place.at(*at), 0.07 * radius, text);
            }
            let name = if row_at == 0 { format!("σ = {}", degrees(disk.sigma)) } else { String::new() };
            svg.text([x, place.y - radius - 9.0], label, &name);
        }
    }
    let y = bars(&mut svg, y + 2.0 * row + 16.0, high);
    let lines = [
        "Strokes: the direction in which the light oscillates. The angle is counted from the normal of the plane of \
         light and viewer, counterclockwise as seen by the viewer."
            .to_string(),
        "Lambert equal-area disks, rings at 30° and 60°; light on the left. Pale: not measured; grey: less than 1 % \
         polarised."
            .to_string(),
    ];
    let end = notes(&mut svg, y + 14.0, &lines);
    svg.finish(end - 4.0, &title(&[shown], "degree and angle of linear polarisation"))
}

/// The end of the scale of degrees: a round number that no measured degree exceeds.
fn highest(found: &Found) -> f64 {
    let measured = |curve: &Curve| {
        let of = curve.matrices.iter().zip(&curve.is_measured).zip(&curve.theta);
        let of = of.filter(|((_, is_measured), theta)| **is_measured && theta.abs() < 1.5);
        of.filter_map(|((matrix, _), _)| Some(Linear::of(matrix)?.degree)).fold(0.0, f32::max)
    };
    let of_disk = |disk: &Disk| {
        let of = disk.light.iter().zip(&disk.is_measured).filter(|(_, is_measured)| **is_measured);
        of.filter_map(|(light, _)| Some(light.as_ref()?.degree)).fold(0.0, f32::max)
    };
    let most = found.curves.iter().map(measured).chain(found.disks.iter().map(of_disk)).fold(0.0, f32::max);
    round_up(most)
}

/// The degree in the plane of incidence; returns the height below it.
fn panel(svg: &mut Svg<'_>, found: &Found, top: f64, high: f64) -> f64 {
    let layout = svg.layout();
    let left = if layout.is_narrow { 50.0 } else { 64.0 };
    let area = Area { x: left, y: top, width: layout.width - left - MARGIN, height: 180.0 };
    let inks: Vec<Ink> = (0..found.curves.len()).map(|at| Ink::of_order(at, found.curves.len())).collect();
    let traces = found.curves.iter().zip(&inks).map(|(curve, ink)| Trace {
        ink: ink.clone(),
        x: &curve.theta,
        values: curve.matrices.iter().map(|matrix| Some(100.0 * Linear::of(matrix)?.degree)).collect(),
        is_measured: &curve.is_measured,
        mirror: Some(curve.sigma),
    });
    let small = Small {
        area,
        name: "degree of polarisation (%)".into(),
        axis: Axis::Angle,
        scale: Scale { scaling: Scaling::Linear, low: 0.0, high: 100.0 * high },
        traces: traces.collect(),
        has_labels: [true; 2],
        size: 15.0,
    };
    small.draw(svg);
    svg.rich([left + 0.5 * area.width, top + 222.0], MIDDLE, "viewing angle θ_{o} (degrees)");
    let entry = |(curve, ink): (&Curve, &Ink)| Entry { ink: ink.clone(), label: degrees(curve.sigma) };
    let entries: Vec<Entry> = found.curves.iter().zip(&inks).map(entry).collect();
    let legend = Legend {
        title: "incidence σ",
        entries: &entries,
        has_mirror: true,
        has_points: false,
        has_continued: found.curves.iter().any(|curve| curve.is_measured.contains(&false)),
    };
    legend.below(svg, top + 250.0)
}

/// The share of paper that is mixed into what was not measured.
const PALE: f32 = 0.7;

fn image(disk: &Disk, colour: impl Fn(&Linear) -> [u8; 3]) -> Image {
    let pixel = |(light, is_measured): (&Option<Linear>, &bool)| match light {
        None => [0; 4],
        Some(light) => {
            let mixed = |c: u8| (f32::from(c) + PALE * (255.0 - f32::from(c))).round() as u8;
            let [r, g, b] = if *is_measured { colour(light) } else { colour(light).map(mixed) };
            [r, g, b, 255]
        }
    };
    let rgba = disk.light.iter().zip(&disk.is_measured).flat_map(pixel).collect();
    Image { width: disk.size as u32, height: disk.size as u32, rgba }
}

fn degrees_picture(disk: &Disk, high: f64) -> Image {
    image(disk, |light| degree_colour(light, high))
}

fn angles_picture(disk: &Disk) -> Image {
    image(disk, angle_colour)
}

/// The colour of a degree on a scale from 0 to `high`.
pub(super) fn degree_colour(light: &Linear, high: f64) -> [u8; 3] {
    let colorous::Color { r, g, b } =
        colorous::VIRIDIS.eval_continuous((f64::from(light.degree) / high).clamp(0.0, 1.0));
    [r, g, b]
}

/// The colour of an angle; grey if there is too little polarisation for one.
pub(super) fn angle_colour(light: &Linear) -> [u8; 3] {
    if light.degree < FAINT {
        return [0xb8, 0xbc, 0xc2];
    }
    let turn = f64::from(light.angle) / std::f64::consts::PI;
    let colorous::Color { r, g, b } = colorous::SINEBOW.eval_continuous(turn.rem_euclid(1.0));
    [r, g, b]
}

/// A round number that no degree exceeds.
pub(super) fn round_up(most: f32) -> f64 {
    [0.05, 0.1, 0.2, 0.5].into_iter().find(|round| f64::from(most) <= *round).unwrap_or(1.0)
}

/// Strokes along the polarisation where there is enough of it.
fn strokes(svg: &mut Svg<'_>, place: Place, disk: &Disk) {
    let mut path = String::new();
    for Stroke { at, along, light, .. } in &disk.strokes {
        if light.degree < FAINT {
            continue;
        }
        let half = 0.06;
        let end = |sign: f64| place.at([at[0] + sign * half * along[0], at[1] + sign * half * along[1]]);
        let ([x1, y1], [x2, y2]) = (end(-1.0), end(1.0));
        let _ = write!(path, "M{} {}L{} {}", number(x1), number(y1), number(x2), number(y2));
    }
    for (colour, opacity, width) in [("#000000", 0.55, 3.2), ("#ffffff", 1.0, 1.5)] {
        svg.raw(&format!(
            "<path d=\"{path}\" stroke=\"{colour}\" stroke-opacity=\"{opacity}\" stroke-width=\"{width}\" \
             stroke-linecap=\"round\" fill=\"none\"/>"
        ));
    }
}

/// The colour bars of degrees and angles; returns the height below them.
pub(super) fn bars(svg: &mut Svg<'_>, y: f64, high: f64) -> f64 {
    let degree = |share: f64| colorous::VIRIDIS.eval_continuous(share);
    let y = bar(svg, y, "degree of polarisation (%)", 100.0 * high, 4, degree);
    bar(svg, y + 10.0, "angle of polarisation (degrees)", 180.0, 6, |share| colorous::SINEBOW.eval_continuous(share))
}

/// A colour bar from 0 to `high`, below its name; returns the height below it.
fn bar(svg: &mut Svg<'_>, y: f64, name: &str, high: f64, steps: u32, colour: impl Fn(f64) -> colorous::Color) -> f64 {
    let left = MARGIN + 16.0;
    let length = svg.layout().width - 2.0 * left;
    let small = Text { size: 15.0, ..LABEL };
    svg.text([left, y], small, name);
    svg.image(Area { x: left, y: y + 8.0, width: length, height: 14.0 }, &ramp(colour));
    for step in 0..=steps {
        let share = f64::from(step) / f64::from(steps);
        let x = left + share * length;
        svg.line([x, y + 22.0], [x, y + 27.0], Role::Frame, 1.0);
        let value = share * high;
        let label = if value.fract() == 0.0 { format!("{value:.0}") } else { format!("{value}") };
        svg.text([x, y + 42.0], Text { anchor: Anchor::Middle, ..small }, &label);
    }
    y + 54.0
}
