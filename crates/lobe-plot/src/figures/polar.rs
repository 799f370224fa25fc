//! Lobes: the values in the plane of incidence, in polar coordinates about the point of incidence.

use lobe::Scatter;

use super::legend::{has_continued, incidences, legend, runs};
use super::shared::{MARGIN, MIDDLE, Series, TOP, WIDTH, conditions, degrees, heading, id, scatter_name};
use crate::evaluate::Progress;
use crate::in_plane::{Curve, curves};
use crate::scale::{Scale, Scaling};
use crate::subject::Subject;
use crate::svg::{Anchor, Area, LABEL, Role, Svg, Text};
use crate::view::View;

const TOLERANCE: f64 = 0.05;
const RADIUS: f64 = 246.0;
const CENTRE: f64 = 292.0;
/// If the largest value of one curve is this many times that of another, a linear radius shows only the first.
const WIDE: f64 = 8.0;

/// Reflection above the surface, transmission below it.
pub(super) fn draw(subject: &Subject, view: &View, progress: &dyn Progress) -> String {
    let curves = curves(subject, view, progress);
    let scatters = subject.scatters(view.side);
    let scale = scale(&curves, view.scaling);
    let sigmas = incidences(&curves);
    let (has_up, has_down) = (scatters.contains(&Scatter::Reflection), scatters.contains(&Scatter::Transmission));
    let up = if has_up { RADIUS + 38.0 } else { 16.0 };
    let down = if has_down { RADIUS + 38.0 } else { 16.0 };
    let centre = [CENTRE, TOP + up];
    let mut svg = Svg::new(id("polar", view));
    let radius = match scale.scaling {
        Scaling::Log => "log radius",
        Scaling::Linear => "linear radius",
    };
    heading(
        &mut svg,
        subject.name(),
        &format!("Lobes in the plane of incidence, {radius}, {}", conditions(subject, view)),
    );
    grid(&mut svg, centre, &scale, &scatters);
    let area = |scatter| match scatter {
        Scatter::Reflection => Area { x: CENTRE - RADIUS - 3.0, y: TOP, width: 2.0 * RADIUS + 6.0, height: up },
        Scatter::Transmission => {
            Area { x: CENTRE - RADIUS - 3.0, y: centre[1], width: 2.0 * RADIUS + 6.0, height: down }
        }
    };
    for &scatter in &scatters {
        svg.clipped(area(scatter), |svg| {
            for (index, &sigma) in sigmas.iter().enumerate() {
                for curve in curves.iter().filter(|curve| curve.sigma == sigma && curve.scatter == scatter) {
                    lobe(svg, centre, &scale, curve, Series { index, count: sigmas.len() });
                }
            }
        });
    }
    surface(&mut svg, centre);
    marks(&mut svg, centre, &scatters, &sigmas);
    if scatters.len() > 1 {
        let name = Text { is_heavy: true, size: 16.0, ..LABEL };
        svg.text([MARGIN, TOP + 20.0], name, scatter_name(Scatter::Reflection));
        svg.text([MARGIN, centre[1] + down - 12.0], name, scatter_name(Scatter::Transmission));
    }
    numbers(&mut svg, centre, &scale, has_down);
    legend(&mut svg, [WIDTH - 118.0, TOP + 20.0], &sigmas, has_continued(&curves));
    let bottom = centre[1] + down + 34.0;
    let title = format!("{}: lobes in the plane of incidence", subject.name());
    svg.rich([CENTRE, bottom - 4.0], MIDDLE, "viewing angle θ_{o} around, f (1/sr) outward");
    svg.finish([WIDTH, bottom + 18.0], view.width, &title)
}

/// Linear if all curves can be seen that way.
fn scale(curves: &[Curve], asked: Option<Scaling>) -> Scale {
    let inner = |curve: &Curve| -> Vec<f64> {
        let of = curve.theta.iter().zip(&curve.f).filter(|(theta, _)| theta.abs() < 1.5);
        of.map(|(_, f)| f64::from(*f)).collect()
    };
    let all: Vec<Vec<f64>> = curves.iter().map(inner).collect();
    let peaks: Vec<f64> = all.iter().map(|values| values.iter().copied().fold(0.0, f64::max)).collect();
    let most = peaks.iter().copied().fold(0.0, f64::max);
    let least = peaks.iter().copied().filter(|peak| *peak > 0.0).fold(f64::INFINITY, f64::min);
    let mut sorted: Vec<f64> = all.iter().flatten().copied().filter(|value| *value > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let quartile = sorted.get(sorted.len() / 4).copied().unwrap_or(most);
    let is_wide = most > WIDE * least || most > 4.0 * WIDE * quartile;
    match asked.unwrap_or(if is_wide { Scaling::Log } else { Scaling::Linear }) {
        // A radius cannot be negative.
        Scaling::Linear => Scale::from_zero(all.iter().flatten().copied()),
        // The centre lies below most values, so that noise does not inflate the lobes.
        Scaling::Log => Scale::around([most, (0.3 * quartile).max(1e-5 * most)].into_iter(), Scaling::Log),
    }
}

fn at([x, y]: [f64; 2], radius: f64, theta: f64, scatter: Scatter) -> [f64; 2] {
    let up = if scatter == Scatter::Reflection { -1.0 } else { 1.0 };
    [x + radius * theta.sin(), y + up * radius * theta.cos()]
}

fn lobe(svg: &mut Svg, centre: [f64; 2], scale: &Scale, curve: &Curve, series: Series) {
    let radius = |f: f32| RADIUS * scale.place(f64::from(f)).clamp(0.0, 1.2);
    let point = |(&theta, &f): (&f64, &f32)| at(centre, radius(f), theta, curve.scatter);
    let points: Vec<[f64; 2]> = curve.theta.iter().zip(&curve.f).map(point).collect();
    svg.series(series.index, &series.colour(), &runs(&points, &curve.is_measured, TOLERANCE));
}

/// Circles at the ticks, and rays every 15 degrees.
fn grid(svg: &mut Svg, centre: [f64; 2], scale: &Scale, scatters: &[Scatter]) {
    let ticks = scale.ticks();
    for tick in ticks.iter().filter(|tick| tick.label.is_some()) {
        let radius = RADIUS * scale.place(tick.value);
        if radius > 0.5 {
            for scatter in scatters {
                arc(svg, centre, radius, *scatter, if radius > RADIUS - 0.5 { Role::Frame } else { Role::Grid });
            }
        }
    }
    for &scatter in scatters {
        arc(svg, centre, RADIUS, scatter, Role::Frame);
        for angle in (-90_i32..=90).step_by(15) {
            let theta = f64::from(angle).to_radians();
            let is_major = angle % 30 == 0;
            let role = if is_major { Role::Grid } else { Role::Faint };
            svg.line(at(centre, 0.08 * RADIUS, theta, scatter), at(centre, RADIUS, theta, scatter), role, 1.0);
            if is_major && angle.abs() < 90 {
                let [x, y] = at(centre, RADIUS + 24.0, theta, scatter);
                svg.text([x, y + 5.5], Text { size: 15.0, role: Role::Muted, ..MIDDLE }, &degrees(theta));
            }
        }
    }
}

/// The values of the circles, below the surface.
fn numbers(svg: &mut Svg, centre: [f64; 2], scale: &Scale, has_down: bool) {
    let ticks = scale.ticks();
    let y = if has_down { centre[1] + 18.0 } else { centre[1] + 22.0 };
    let labelled: Vec<_> = ticks.iter().filter(|tick| tick.label.is_some()).collect();
    let mut last = f64::NEG_INFINITY;
    for tick in labelled {
        let radius = RADIUS * scale.place(tick.value);
        // Numbers that would overlap are left out.
        if radius - last < 46.0 && radius > 0.0 || radius > RADIUS + 0.5 {
            continue;
        }
        last = radius;
        let label = tick.label.as_deref().unwrap_or_default();
        let style = Text { size: 15.0, role: Role::Muted, anchor: Anchor::Middle, has_halo: true, ..LABEL };
        svg.rich([centre[0] + radius, y], style, label);
    }
}

fn arc(svg: &mut Svg, centre: [f64; 2], radius: f64, scatter: Scatter, role: Role) {
    let [from, to] = [-90.0_f64, 90.0].map(|angle| at(centre, radius, angle.to_radians(), scatter));
    svg.arc(from, to, radius, scatter == Scatter::Reflection, role);
}

/// The surface, and the normal at the point of incidence.
fn surface(svg: &mut Svg, [x, y]: [f64; 2]) {
    svg.line([x - RADIUS - 12.0, y], [x + RADIUS + 12.0, y], Role::Frame, 1.6);
}

/// Marks the mirror directions and the straight-through rays.
fn marks(svg: &mut Svg, centre: [f64; 2], scatters: &[Scatter], sigmas: &[f64]) {
    for &scatter in scatters {
        for (index, &sigma) in sigmas.iter().enumerate() {
            let tip = at(centre, RADIUS + 1.5, sigma, scatter);
            let [left, right] = [-0.021, 0.021].map(|turn| at(centre, RADIUS + 10.0, sigma + turn, scatter));
            svg.mark(index, &Series { index, count: sigmas.len() }.colour(), &[left, right, tip]);
        }
    }
}
