//! The figures.

mod cartesian;
mod legend;
mod polar;
mod slices;
mod sphere;

use std::fmt;

use lobe::Scatter;
use lobe::Side;

use crate::evaluate::Progress;
use crate::scale::minus;
use crate::subject::Subject;
use crate::svg::{Anchor, LABEL, Role, Svg, Text};
use crate::view::View;

/// A kind of figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Figure {
    /// Values in the plane of incidence against the angle of view.
    Curves,
    /// The same about the point of incidence, as lobes.
    Polar,
    /// All outgoing directions, a disk for each incidence.
    Slices,
    /// Spheres under lights.
    Sphere,
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Figure::Curves => "curves",
            Figure::Polar => "polar",
            Figure::Slices => "slices",
            Figure::Sphere => "sphere",
        })
    }
}

/// One figure as an SVG that stands alone: on white, `view.width` pixels wide, in any size readable.
pub fn draw(subject: &Subject, view: &View, figure: Figure, progress: &dyn Progress) -> String {
    match figure {
        Figure::Curves => cartesian::draw(subject, view, progress),
        Figure::Polar => polar::draw(subject, view, progress),
        Figure::Slices => slices::draw(subject, view, progress),
        Figure::Sphere => sphere::draw(subject, view, progress),
    }
}

/// The width of every figure in its own units. Labels are a 42nd of it, as in the column of a paper.
const WIDTH: f64 = 720.0;
/// Where every figure begins and ends.
const MARGIN: f64 = 22.0;
/// Where the plots begin, below the heading.
const TOP: f64 = 76.0;

/// A name for the parts of a figure that is no other's on a page.
fn id(figure: &str, view: &View) -> String {
    format!("{figure}-{}-{:.0}", side_name(view.side), view.psi.to_degrees())
}

/// The name of the file, and what is shown of it.
fn heading(svg: &mut Svg, name: &str, what: &str) {
    // About the characters that fit; a name that is longer loses its middle.
    const FITS: usize = 58;
    let shown = match name.chars().count() {
        count if count > FITS => {
            let part = |from: usize, to: usize| name.chars().skip(from).take(to - from).collect::<String>();
            format!("{}…{}", part(0, FITS / 2), part(count - FITS / 2 + 1, count))
        }
        _ => name.to_string(),
    };
    svg.text([MARGIN, 32.0], Text { size: 20.0, is_heavy: true, ..LABEL }, &shown);
    svg.rich([MARGIN, 56.0], Text { size: 16.0, role: Role::Muted, ..LABEL }, what);
}

/// What a figure shows beside its geometry: where the light is, and which number.
fn conditions(subject: &Subject, view: &View) -> String {
    let mut words = vec![format!("ψ = {}", degrees(view.psi))];
    if subject.sides().len() > 1 {
        words.push(format!("light from {}", side_name(view.side)));
    }
    if !view.quantity.name.is_empty() {
        words.push(view.quantity.name.clone());
    }
    words.join(", ")
}

/// A side for people.
pub(crate) fn side_name(side: Side) -> &'static str {
    match side {
        Side::Front => "above",
        Side::Back => "below",
    }
}

fn scatter_name(scatter: Scatter) -> &'static str {
    match scatter {
        Scatter::Reflection => "reflection",
        Scatter::Transmission => "transmission",
    }
}

/// An angle in degrees with at most one decimal.
pub(crate) fn degrees(radians: f64) -> String {
    let rounded = (10.0 * radians.to_degrees()).round() / 10.0;
    minus(&format!("{}°", if rounded == 0.0 { 0.0 } else { rounded }))
}

/// The colour of a series on white: an even walk through a perceptually uniform ramp, without its palest end.
fn series_colour(index: usize, count: usize) -> String {
    ramp(index, count, [0.02, 0.80])
}

/// The colour of a series on a dark page: without the darkest end.
pub(crate) fn series_colour_on_dark(index: usize, count: usize) -> String {
    ramp(index, count, [0.30, 0.98])
}

fn ramp(index: usize, count: usize, [from, to]: [f64; 2]) -> String {
    let share = if count > 1 { index as f64 / (count - 1) as f64 } else { 0.25 };
    format!("#{:x}", colorous::PLASMA.eval_continuous(from + share * (to - from)))
}

/// Text at the middle of its position.
const MIDDLE: Text = Text { anchor: Anchor::Middle, ..LABEL };
