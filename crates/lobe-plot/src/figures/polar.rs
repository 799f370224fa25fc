//! Lobes: the values in the plane of incidence, in polar coordinates about the point of incidence.

use lobe::Scatter;

use super::cartesian::{incidences, line, title};
use super::chart::{DOTS, Line};
use super::legend::{Entry, Legend};
use super::lines::runs;
use super::shared::{MARGIN, MIDDLE, conditions, heading, id, scatter_name};
use crate::in_plane::Curve;
use crate::ink::Ink;
use crate::layout::Paper;
use crate::scale::{Scale, Scaling, degrees};
use crate::shown::Shown;
use crate::svg::{Anchor, Area, LABEL, Role, Svg, Text};

const TOLERANCE: f64 = 0.05;
/// If the largest value of one curve is this many times that of another, a linear radius shows only the first.
const WIDE: f64 = 8.0;

/// The position of the lobes in the figure.
#[derive(Clone, Copy, Debug)]
struct Disk {
    centre: [f64; 2],
    radius: f64,
}

/// Reflection above the surface, transmission below it. `curves` holds the curves of each file.
pub(super) fn draw(shown: &[Shown<'_>], curves: &[Vec<Curve>], asked: Option<Scaling>, paper: Paper<'_>) -> String {
    let Some(first) = shown.first() else { return String::new() };
    let layout = paper.layout;
    let scatters: Vec<Scatter> = [Scatter::Reflection, Scatter::Transmission]
        .into_iter()
        .filter(|scatter| curves.iter().flatten().any(|curve| curve.scatter == *scatter))
        .collect();
    let scale = scale(curves.iter().flatten(), asked);
    let sigmas = incidences(curves.iter().flatten());
    let ink = |file: usize, sigma: f64| match shown.len() {
        1 => Ink::of_order(sigmas.iter().position(|other| *other == sigma).unwrap_or(0), sigmas.len()),
        _ => Ink::of_set(file),
    };
    let is_below = layout.is_narrow || shown.len() > 1;
    let radius = if layout.is_narrow { 152.0 } else { 246.0 };
    let across = if is_below { 0.5 * layout.width } else { 292.0 };
    let room = radius + 38.0;
    let (has_up, has_down) = (scatters.contains(&Scatter::Reflection), scatters.contains(&Scatter::Transmission));
    let (up, down) = (if has_up { room } else { 16.0 }, if has_down { room } else { 16.0 });
    let mut svg = Svg::new(id("polar", first.view), paper);
    let spacing = match scale.scaling {
        Scaling::Log => "log radius",
        Scaling::Linear => "linear radius",
    };
    let what = format!("Lobes, {spacing}, in the plane of incidence, {}", conditions(shown));
    let top = heading(&mut svg, shown, &what);
    let disk = Disk { centre: [across, top + up], radius };
    grid(&mut svg, disk, &scale, &scatters);
    let area = |scatter| match scatter {
        Scatter::Reflection => Area { x: across - radius - 3.0, y: top, width: 2.0 * radius + 6.0, height: up },
        Scatter::Transmission => {
            Area { x: across - radius - 3.0, y: disk.centre[1], width: 2.0 * radius + 6.0, height: down }
        }
    };
    let (mut has_points, mut has_continued) = (false, false);
    for &scatter in &scatters {
        svg.clipped(area(scatter), |svg| {
            for (file, of_file) in curves.iter().enumerate() {
                for curve in of_file.iter().filter(|curve| curve.scatter == scatter) {
                    let name =
                        if shown.len() > 1 { format!("{}: ", shown[file].subject.name()) } else { String::new() };
                    lobe(svg, disk, &scale, curve, &line(curve, ink(file, curve.sigma), &name));
                    has_points |= !curve.points.is_empty();
                    has_continued |= curve.is_measured.contains(&false);
                }
            }
        });
    }
    surface(&mut svg, disk);
    for &scatter in &scatters {
        for &sigma in &sigmas {
            let tip = at(disk.centre, radius + 1.5, sigma, scatter);
            let [left, right] = [-0.021, 0.021].map(|turn| at(disk.centre, radius + 10.0, sigma + turn, scatter));
            match shown.len() {
                1 => svg.mark(&ink(0, sigma), &[left, right, tip]),
                _ => svg.muted_mark(&[left, right, tip]),
            }
        }
    }
    if scatters.len() > 1 {
        let name = Text { is_heavy: true, size: 16.0, ..LABEL };
        svg.text([MARGIN, top + 20.0], name, scatter_name(Scatter::Reflection));
        svg.text([MARGIN, disk.centre[1] + down - 12.0], name, scatter_name(Scatter::Transmission));
    }
    numbers(&mut svg, disk, &scale, has_down);
    let of_order = |sigma: &f64| Entry { ink: ink(0, *sigma), label: degrees(*sigma) };
    let of_file =
        |(file, shown): (usize, &Shown<'_>)| Entry { ink: ink(file, 0.0), label: shown.subject.name().into() };
    let (name, entries) = match shown.len() {
        1 => ("incidence σ", sigmas.iter().map(of_order).collect()),
        _ => ("file", shown.iter().enumerate().map(of_file).collect::<Vec<_>>()),
    };
    let legend = Legend { title: name, entries: &entries, has_mirror: true, has_points, has_continued };
    let mut bottom = disk.centre[1] + down + 34.0;
    svg.rich([across, bottom - 4.0], MIDDLE, "viewing angle θ_{o} around, f (1/sr) outward");
    match is_below {
        true => bottom = legend.below(&mut svg, bottom + 26.0) - 18.0,
        false => legend.beside(&mut svg, [layout.width - 138.0, top + 20.0]),
    }
    svg.finish(bottom + 18.0, &title(shown, "lobes in the plane of incidence"))
}

/// Linear if all curves are visible with it.
fn scale<'a>(curves: impl Iterator<Item = &'a Curve>, asked: Option<Scaling>) -> Scale {
    let inner = |curve: &Curve| -> Vec<f64> {
        let of = curve.theta.iter().zip(&curve.f).filter(|(theta, _)| theta.abs() < 1.5);
        of.map(|(_, f)| f64::from(*f)).collect()
    };
    let all: Vec<Vec<f64>> = curves.map(inner).collect();
    let peaks: Vec<f64> = all.iter().map(|values| values.iter().copied().fold(0.0, f64::max)).collect();
    let most = peaks.iter().copied().fold(0.0, f64::max);
    let least = peaks.iter().copied().filter(|peak| *peak > 0.0).fold(f64::INFINITY, f64::min);
    let mut sorted: Vec<f64> = all.iter().flatten().copied().filter(|value| *value > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let quartile = sorted.get(sorted.len() / 4).copied().unwrap_or(most);
    let is_wide = most > WIDE * least || most > 4.0 * WIDE * quartile;
    match asked.unwrap_or(if is_wide { Scaling::Log } else { Scaling::Linear }) {
        Scaling::Linear => {
            // A radius cannot be negative.
            Scale::around(all.iter().flatten().map(|value| value.max(0.0)), Scaling::Linear)
        }
        // The centre is below most values, so that noise does not inflate the lobes.
        Scaling::Log => Scale::around([most, (0.3 * quartile).max(1e-5 * most)].into_iter(), Scaling::Log),
    }
}

fn at([x, y]: [f64; 2], radius: f64, theta: f64, scatter: Scatter) -> [f64; 2] {
    let up = if scatter == Scatter::Reflection { -1.0 } else { 1.0 };
    [x + radius * theta.sin(), y + up * radius * theta.cos()]
}

fn lobe(svg: &mut Svg<'_>, disk: Disk, scale: &Scale, curve: &Curve, line: &Line) {
    let radius = |f: f32| disk.radius * scale.place(f64::from(f)).clamp(0.0, 1.2);
    let point = |(&theta, &f): (&f64, &f32)| at(disk.centre, radius(f), theta, curve.scatter);
    let points: Vec<[f64; 2]> = curve.theta.iter().zip(&curve.f).map(point).collect();
    svg.series(&line.ink, &runs(&points, &curve.is_measured, TOLERANCE));
    let dots: Vec<[f64; 2]> = curve.points.iter().map(|&at| points[at]).collect();
    if dots.len() <= DOTS {
        svg.dots(&line.ink, &dots);
    }
    for hint in &line.hints {
        svg.hint(points[hint.at], 5.0, &hint.text);
    }
}

/// Circles at the ticks, and rays every 15 degrees.
fn grid(svg: &mut Svg<'_>, disk: Disk, scale: &Scale, scatters: &[Scatter]) {
    let Disk { centre, radius: outer } = disk;
    let ticks = scale.ticks();
    for tick in ticks.iter().filter(|tick| tick.label.is_some()) {
        let radius = outer * scale.place(tick.value);
        if radius > 0.5 {
            for scatter in scatters {
                arc(svg, centre, radius, *scatter, if radius > outer - 0.5 { Role::Frame } else { Role::Grid });
            }
        }
    }
    for &scatter in scatters {
        arc(svg, centre, outer, scatter, Role::Frame);
        for angle in (-90_i32..=90).step_by(15) {
            let theta = f64::from(angle).to_radians();
            let is_major = angle % 30 == 0;
            let role = if is_major { Role::Grid } else { Role::Faint };
            svg.line(at(centre, 0.08 * outer, theta, scatter), at(centre, outer, theta, scatter), role, 1.0);
            if is_major && angle.abs() < 90 {
                let [x, y] = at(centre, outer + 24.0, theta, scatter);
                svg.text([x, y + 5.5], Text { size: 15.0, role: Role::Muted, ..MIDDLE }, &degrees(theta));
            }
        }
    }
}

/// The values of the circles, below the surface.
fn numbers(svg: &mut Svg<'_>, Disk { centre, radius: outer }: Disk, scale: &Scale, has_down: bool) {
    let ticks = scale.ticks();
    let y = if has_down { centre[1] + 18.0 } else { centre[1] + 22.0 };
    let mut last = f64::NEG_INFINITY;
    for tick in ticks.iter().filter(|tick| tick.label.is_some()) {
        let radius = outer * scale.place(tick.value);
        // Numbers that would overlap are left out.
        if radius - last < 46.0 && radius > 0.0 || radius > outer + 0.5 {
            continue;
        }
        last = radius;
        let label = tick.label.as_deref().unwrap_or_default();
        let style = Text { size: 15.0, role: Role::Muted, anchor: Anchor::Middle, has_halo: true, ..LABEL };
        svg.rich([centre[0] + radius, y], style, label);
    }
}

fn arc(svg: &mut Svg<'_>, centre: [f64; 2], radius: f64, scatter: Scatter, role: Role) {
    let [from, to] = [-90.0_f64, 90.0].map(|angle| at(centre, radius, angle.to_radians(), scatter));
    svg.arc(from, to, radius, scatter == Scatter::Reflection, role);
}

/// The surface, and the normal at the point of incidence.
fn surface(svg: &mut Svg<'_>, Disk { centre: [x, y], radius }: Disk) {
    svg.line([x - radius - 12.0, y], [x + radius + 12.0, y], Role::Frame, 1.6);
}
