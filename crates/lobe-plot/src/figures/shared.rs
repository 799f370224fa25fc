//! What all figures share: margins, headings, names and the colours of series.

use lobe::{Scatter, Side};

use crate::scale::minus;
use crate::subject::Subject;
use crate::svg::{Anchor, LABEL, Role, Svg, Text};
use crate::view::View;

/// The width of every figure in its own units. Labels are a 42nd of it, as in a column of a printed paper.
pub(super) const WIDTH: f64 = 720.0;
/// The left and right margin of every figure.
pub(super) const MARGIN: f64 = 22.0;
/// The top of the plots, below the heading.
pub(super) const TOP: f64 = 76.0;

/// An id for the parts of a figure, unique on a page.
pub(super) fn id(figure: &str, view: &View) -> String {
    format!("{figure}-{}-{:.0}", side_name(view.side), view.psi.to_degrees())
}

/// The name of the file, and what is shown of it.
pub(super) fn heading(svg: &mut Svg, name: &str, what: &str) {
    // About as many characters as fit; a longer name loses its middle.
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

/// What a figure shows: the position of the light and the quantity.
pub(super) fn conditions(subject: &Subject, view: &View) -> String {
    let mut words = vec![format!("ψ = {}", degrees(view.psi))];
    if subject.sides().len() > 1 {
        words.push(format!("light from the {}", side_name(view.side)));
    }
    if !view.quantity.name.is_empty() {
        words.push(view.quantity.name.clone());
    }
    words.join(", ")
}

/// The name of a side.
pub(crate) fn side_name(side: Side) -> &'static str {
    match side {
        Side::Front => "front",
        Side::Back => "back",
    }
}

pub(super) fn scatter_name(scatter: Scatter) -> &'static str {
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

/// One of several curves in a figure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Series {
    /// Its position among them.
    pub(crate) index: usize,
    /// How many there are.
    pub(crate) count: usize,
}

impl Series {
    /// The colour on white: evenly spaced in a perceptually uniform ramp, without its palest end.
    pub(crate) fn colour(self) -> String {
        self.of_ramp(0.02, 0.80)
    }

    /// The colour on a dark page: without the darkest end.
    pub(crate) fn colour_on_dark(self) -> String {
        self.of_ramp(0.30, 0.98)
    }

    fn of_ramp(self, from: f64, to: f64) -> String {
        let share = if self.count > 1 { self.index as f64 / (self.count - 1) as f64 } else { 0.25 };
        format!("#{:x}", colorous::PLASMA.eval_continuous(from + share * (to - from)))
    }
}

/// Text centred on its position.
pub(super) const MIDDLE: Text = Text { anchor: Anchor::Middle, ..LABEL };
