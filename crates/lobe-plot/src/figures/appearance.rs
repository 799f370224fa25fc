//! Shows how different a fitted model looks from the measurement, on a sphere.

use colorous::Color;
use lobe_ops::compare::Spheres;

use super::bar;
use super::cartesian::title;
use super::shared::{MARGIN, MIDDLE, heading, id, notes};
use crate::image::Image;
use crate::layout::Paper;
use crate::shown::Shown;
use crate::svg::{Area, Role, Svg, Text};

const RADIUS: f64 = 150.0;
/// The difference at the end of the colours.
const END: f64 = 10.0;
/// Differences, as shares of the end.
const LABELS: [(f64, &str); 5] = [(0.0, "0"), (0.1, "1"), (0.2, "2"), (0.5, "5"), (1.0, "10+")];

/// The differences of the pixels in colour, and their summary.
pub(super) fn draw(shown: Shown<'_>, spheres: &Spheres, paper: Paper<'_>) -> String {
    let width = paper.layout.width;
    let radius = RADIUS.min(0.5 * width - MARGIN);
    let mut svg = Svg::new(id("appearance", shown.view), paper);
    let what = "Two spheres, of the fit and of the measurement: CIE ΔE 2000";
    let top = heading(&mut svg, &[shown], what) + 6.0;
    let area = Area { x: 0.5 * width - radius, y: top, width: 2.0 * radius, height: 2.0 * radius };
    svg.image(area, &Image::square(spheres.size, &spheres.delta_e, colour));
    let found = spheres.summary();
    let said = format!("mean {:.2}, 95 % below {:.2}, at most {:.2}", found.mean, found.percentile_95, found.max);
    let y = top + 2.0 * radius + 22.0;
    svg.text([0.5 * width, y], Text { size: 14.0, role: Role::Muted, ..MIDDLE }, &said);
    bar::labelled(&mut svg, y + 18.0, |share| colour(END * share), &LABELS);
    let lines = ["A distant light above left. A difference of about 1 is just noticeable side by side.".to_string()];
    let bottom = notes(&mut svg, y + 90.0, &lines);
    svg.finish(bottom, &title(&[shown], "the visible difference between the fit and the measurement"))
}

/// Dark for 0, bright for large differences.
fn colour(delta_e: f64) -> Color {
    colorous::VIRIDIS.eval_continuous((delta_e / END).clamp(0.0, 1.0))
}
