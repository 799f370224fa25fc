//! All elements of Mueller matrices in the plane of incidence, as four rows of four panels.

use super::cartesian::title;
use super::chart::Axis;
use super::legend::{Entry, Legend};
use super::shared::{MARGIN, MIDDLE, conditions, heading, id, notes};
use super::small::{Small, Trace};
use crate::evaluate::Progress;
use crate::ink::Ink;
use crate::layout::Paper;
use crate::polarised::{Curve, curves};
use crate::scale::{Scale, Scaling, degrees};
use crate::shown::Shown;
use crate::svg::{Area, Svg};

/// More curves than this cannot be distinguished in small panels.
pub(super) const MOST: usize = 5;
/// Relative to the largest value of a figure, a value below which there is too little light for a ratio.
const DARK: f32 = 1e-7;

/// The matrices of each incidence; none if the material is not polarised.
pub(super) fn matrices(shown: Shown<'_>, progress: &dyn Progress) -> Vec<Curve> {
    let sigmas = shown.view.incidences(shown.subject, MOST);
    curves(shown.subject, shown.view, &sigmas, progress)
}

/// The first panel is `f` for unpolarised light, the others are the elements relative to it.
pub(super) fn draw(shown: Shown<'_>, curves: &[Curve], paper: Paper<'_>) -> String {
    let layout = paper.layout;
    let mut svg = Svg::new(id("mueller", shown.view), paper);
    let what = format!("Mueller matrix in the plane of incidence, {}", conditions(&[shown]));
    let top = heading(&mut svg, &[shown], &what) + 6.0;
    let (left, gap, size) = if layout.is_narrow { (40.0, 9.0, 11.5) } else { (58.0, 16.0, 14.0) };
    let width = (layout.width - left - MARGIN - 3.0 * gap) / 4.0;
    let height = if layout.is_narrow { 84.0 } else { 116.0 };
    // The first panel has values of its own to its left, so that its column is labelled twice.
    let inks: Vec<Ink> = (0..curves.len()).map(|at| Ink::of_order(at, curves.len())).collect();
    let first = first_scale(curves, shown.view.scaling.unwrap_or(Scaling::Log));
    let ratio = Scale { scaling: Scaling::Linear, low: -1.0, high: 1.0 };
    let most = curves.iter().flat_map(|curve| &curve.matrices).fold(0.0_f32, |most, m| most.max(m[0][0]));
    for (row, column) in (0..4).flat_map(|row| (0..4).map(move |column| (row, column))) {
        let is_first = row + column == 0;
        let area =
            Area { x: left + column as f64 * (width + gap), y: top + row as f64 * (height + gap + 2.0), width, height };
        let value = |m: &[[f32; 4]; 4]| match is_first {
            true => Some(m[0][0]),
            false => (m[0][0] > DARK * most).then(|| m[row][column] / m[0][0]),
        };
        let traces = curves.iter().zip(&inks).map(|(curve, ink)| Trace {
            ink: ink.clone(),
            x: &curve.theta,
            values: curve.matrices.iter().map(value).collect(),
            is_measured: &curve.is_measured,
            mirror: Some(curve.sigma),
        });
        let name = match is_first {
            true => "m_{00} (1/sr)".into(),
            false => format!("m_{{{row}{column}}}"),
        };
        let small = Small {
            area,
            name,
            axis: Axis::Angle,
            scale: if is_first { first } else { ratio },
            traces: traces.collect(),
            has_labels: [row == 3, column == 0],
            size,
        };
        small.draw(&mut svg);
    }
    let bottom = top + 4.0 * height + 3.0 * (gap + 2.0);
    svg.rich([0.5 * (left + layout.width - MARGIN), bottom + 42.0], MIDDLE, "viewing angle θ_{o} (degrees)");
    let entry = |(curve, ink): (&Curve, &Ink)| Entry { ink: ink.clone(), label: degrees(curve.sigma) };
    let entries: Vec<Entry> = curves.iter().zip(&inks).map(entry).collect();
    let legend = Legend {
        title: "incidence σ",
        entries: &entries,
        has_mirror: true,
        has_points: false,
        has_continued: curves.iter().any(|curve| curve.is_measured.contains(&false)),
    };
    let y = legend.below(&mut svg, bottom + 70.0);
    let note = "m00 is f for unpolarised light; the other elements are relative to it. Stokes vectors refer to the \
                normal of the plane of incidence, before and after: S1 is light along it minus light across it.";
    let end = notes(&mut svg, y + 6.0, &[note.into()]);
    svg.finish(end - 4.0, &title(&[shown], "the elements of the Mueller matrix against the viewing angle"))
}

/// The scale of the values for unpolarised light. Values near the horizon are left out, and unmeasured ones if any is
/// measured.
fn first_scale(curves: &[Curve], scaling: Scaling) -> Scale {
    let any = curves.iter().any(|curve| curve.is_measured.contains(&true));
    let mut values = Vec::new();
    for curve in curves {
        for ((theta, matrix), is_measured) in curve.theta.iter().zip(&curve.matrices).zip(&curve.is_measured) {
            if theta.abs() < 1.5 && (*is_measured || !any) {
                values.push(f64::from(matrix[0][0]));
            }
        }
    }
    Scale::around(values.into_iter(), scaling)
}
