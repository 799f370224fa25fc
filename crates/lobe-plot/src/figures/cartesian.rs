//! Curves against the viewing angle.

use lobe::Scatter;

use super::legend::{has_continued, incidences, legend, runs};
use super::shared::{MARGIN, MIDDLE, Series, TOP, WIDTH, conditions, heading, id, scatter_name};
use crate::evaluate::Progress;
use crate::in_plane::{Curve, curves};
use crate::scale::{Scale, Scaling, minus};
use crate::subject::Subject;
use crate::svg::{Anchor, Area, LABEL, Role, Svg, Text};
use crate::view::View;

/// How far a drawn line may deviate from the values, in units of the figure.
const TOLERANCE: f64 = 0.05;
const LEFT: f64 = 92.0;
const RIGHT: f64 = 138.0;

/// Reflection above transmission, each with its own axis of values.
pub(super) fn draw(subject: &Subject, view: &View, progress: &dyn Progress) -> String {
    let curves = curves(subject, view, progress);
    let scatters = subject.scatters(view.side);
    let scaling = view.scaling.unwrap_or(Scaling::Log);
    let sigmas = incidences(&curves);
    let height = if scatters.len() > 1 { 300.0 } else { 380.0 };
    let mut svg = Svg::new(id(if scaling == Scaling::Log { "curves-log" } else { "curves-linear" }, view));
    heading(&mut svg, subject.name(), &format!("In the plane of incidence, {}", conditions(subject, view)));
    for (panel, &scatter) in scatters.iter().enumerate() {
        let y = TOP + 6.0 + panel as f64 * (height + 30.0);
        let area = Area { x: LEFT, y, width: WIDTH - LEFT - RIGHT, height };
        let scale = Scale::around(shown(&curves, scatter), scaling);
        axes(&mut svg, area, &scale, panel + 1 == scatters.len());
        svg.clipped(area, |svg| {
            for (index, &sigma) in sigmas.iter().enumerate() {
                let of = |curve: &&Curve| curve.sigma == sigma && curve.scatter == scatter;
                if let Some(curve) = curves.iter().find(of) {
                    plot(svg, area, &scale, curve, Series { index, count: sigmas.len() });
                }
            }
        });
        for (index, &sigma) in sigmas.iter().enumerate() {
            let x = place(area, sigma);
            let corners = [[x - 5.5, y - 10.0], [x + 5.5, y - 10.0], [x, y - 0.8]];
            svg.mark(index, &Series { index, count: sigmas.len() }.colour(), &corners);
        }
        frame(&mut svg, area);
        let name = match scatters.len() {
            1 if scatter == Scatter::Reflection => "",
            _ => scatter_name(scatter),
        };
        svg.text([area.x + 10.0, y + 22.0], Text { is_heavy: true, size: 16.0, has_halo: true, ..LABEL }, name);
    }
    legend(&mut svg, [WIDTH - RIGHT + 20.0, TOP + 20.0], &sigmas, has_continued(&curves));
    let bottom = TOP + 6.0 + scatters.len() as f64 * (height + 30.0) - 30.0;
    let middle = 0.5 * (LEFT + WIDTH - RIGHT);
    svg.rich([middle, bottom + 52.0], MIDDLE, "viewing angle θ_{o} (degrees)");
    let note = Text { role: Role::Muted, size: 15.0, ..LABEL };
    svg.text([LEFT, bottom + 52.0], note, "light side");
    let end = [WIDTH - RIGHT, bottom + 52.0];
    let away = if scatters == [Scatter::Transmission] { "straight side" } else { "mirror side" };
    svg.text(end, Text { anchor: Anchor::End, ..note }, away);
    let upward = Text { is_upward: true, ..MIDDLE };
    svg.rich([MARGIN + 4.0, 0.5 * (TOP + bottom)], upward, "f (1/sr)");
    let title = format!("{}: f against the viewing angle in the plane of incidence", subject.name());
    svg.finish([WIDTH, bottom + 72.0], view.width, &title)
}

/// The values that the axis has to cover. Values near the horizon are left out, and those that were not measured too
/// unless nothing was.
fn shown(curves: &[Curve], scatter: Scatter) -> impl Iterator<Item = f64> {
    let of = move |curve: &&Curve| curve.scatter == scatter;
    let any = curves.iter().filter(of).any(|curve| curve.is_measured.contains(&true));
    curves.iter().filter(of).flat_map(move |curve| {
        let of = curve.theta.iter().zip(&curve.f).zip(&curve.is_measured);
        let fits = move |((theta, _), measured): &((&f64, &f32), &bool)| theta.abs() < 1.5 && (**measured || !any);
        of.filter(fits).map(|((_, f), _)| f64::from(*f))
    })
}

fn place(area: Area, theta: f64) -> f64 {
    area.x + area.width * (0.5 + theta.to_degrees() / 180.0)
}

fn plot(svg: &mut Svg, area: Area, scale: &Scale, curve: &Curve, series: Series) {
    let y = |f: f32| area.y + area.height * (1.0 - scale.place(f64::from(f)).clamp(-0.2, 1.2));
    let points: Vec<[f64; 2]> =
        curve.theta.iter().zip(&curve.f).map(|(&theta, &f)| [place(area, theta), y(f)]).collect();
    svg.series(series.index, &series.colour(), &runs(&points, &curve.is_measured, TOLERANCE));
}

/// The grid lines and their numbers.
fn axes(svg: &mut Svg, area: Area, scale: &Scale, is_last: bool) {
    let number = Text { size: 16.0, ..LABEL };
    for angle in (-90..=90).step_by(10) {
        let x = place(area, f64::from(angle).to_radians());
        let is_major = angle % 30 == 0;
        if is_major {
            svg.line([x, area.y], [x, area.y + area.height], if angle == 0 { Role::Grid } else { Role::Faint }, 1.0);
        }
        let length = if is_major { 6.0 } else { 3.5 };
        svg.line([x, area.y + area.height], [x, area.y + area.height + length], Role::Frame, 1.0);
        if is_major && is_last {
            let text = Text { anchor: Anchor::Middle, ..number };
            svg.text([x, area.y + area.height + 25.0], text, &minus(&angle.to_string()));
        }
    }
    for tick in scale.ticks() {
        let y = area.y + area.height * (1.0 - scale.place(tick.value));
        let role = if tick.label.is_some() { Role::Grid } else { Role::Faint };
        svg.line([area.x, y], [area.x + area.width, y], role, 1.0);
        let length = if tick.label.is_some() { 6.0 } else { 3.5 };
        svg.line([area.x - length, y], [area.x, y], Role::Frame, 1.0);
        if let Some(label) = tick.label {
            svg.rich([area.x - 11.0, y + 5.5], Text { anchor: Anchor::End, ..number }, &label);
        }
    }
}

fn frame(svg: &mut Svg, Area { x, y, width, height }: Area) {
    for (from, to) in [
        ([x, y], [x, y + height]),
        ([x, y + height], [x + width, y + height]),
        ([x + width, y + height], [x + width, y]),
        ([x + width, y], [x, y]),
    ] {
        svg.line(from, to, Role::Frame, 1.2);
    }
}
