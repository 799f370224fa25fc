//! Spheres under several lights: one large, and smaller ones next to it.

use super::shared::{MARGIN, MIDDLE, TOP, WIDTH, conditions, heading, id};
use crate::evaluate::Progress;
use crate::scale::minus;
use crate::shade::{Studio, shade, studios};
use crate::subject::Subject;
use crate::svg::{Area, LABEL, Role, Svg, Text};
use crate::view::View;

/// The distance between a sphere and the edge of its backdrop.
const PADDING: f64 = 12.0;
/// The distance between backdrops.
const GAP: f64 = 12.0;
/// Room below a backdrop for its captions.
const CAPTION: f64 = 44.0;

/// The first light large, the others small next to it.
pub(super) fn draw(subject: &Subject, view: &View, progress: &dyn Progress) -> String {
    let studios = studios(subject, view.side);
    let mut svg = Svg::new(id("sphere", view));
    let colours = if view.colour.is_grey() { "grey" } else { "sRGB" };
    heading(&mut svg, subject.name(), &format!("Sphere, {colours}, {}", conditions(subject, view)));
    // The backdrops fill the width, and two rows of small ones the height of the large one.
    let columns = if studios.len() > 3 { 2.0 } else { 1.0 };
    let free = WIDTH - 2.0 * MARGIN - columns * GAP;
    let small = (free - CAPTION) / (columns + 2.0);
    let large = 2.0 * small + CAPTION;
    for (at, &studio) in studios.iter().enumerate() {
        let (side, x, y) = match at {
            0 => (large, MARGIN, TOP),
            _ => {
                let (column, row) = ((at - 1) % columns as usize, (at - 1) / columns as usize);
                let x = MARGIN + large + GAP + column as f64 * (small + GAP);
                (small, x, TOP + row as f64 * (small + CAPTION))
            }
        };
        let size = side - 2.0 * PADDING;
        let pixels = (1.25 * size * f64::from(view.width) / WIDTH).round().clamp(32.0, 560.0) as usize;
        let sphere = shade(subject, view, studio, pixels, progress);
        let stops = sphere.exposure();
        backdrop(&mut svg, Area { x, y, width: side, height: side });
        let area = Area { x: x + PADDING, y: y + PADDING, width: size, height: size };
        svg.image(area, &sphere.picture(stops).data_url());
        svg.text([x + 0.5 * side, y + side + 18.0], Text { size: 16.0, ..MIDDLE }, name(studio));
        let muted = Text { size: 14.0, role: Role::Muted, ..MIDDLE };
        svg.text([x + 0.5 * side, y + side + 35.0], muted, &exposure(stops));
    }
    let bottom = TOP + large + CAPTION + 18.0;
    let note = Text { size: 14.0, role: Role::Muted, ..LABEL };
    svg.text(
        [MARGIN, bottom],
        note,
        "At 0 EV a white Lambertian surface that faces the light is as bright as a pixel can be.",
    );
    let title = format!("{}: spheres of the material under {} lights", subject.name(), studios.len());
    svg.finish([WIDTH, bottom + 18.0], view.width, &title)
}

fn name(studio: Studio) -> &'static str {
    match studio {
        Studio::Key => "light from the upper left",
        Studio::Viewer => "beside the viewer",
        Studio::Rim => "behind the rim",
        Studio::Turned => "turned by 90°",
        Studio::Behind => "through, from behind",
    }
}

fn exposure(stops: f64) -> String {
    let sign = if stops > 0.0 { "+" } else { "" };
    minus(&format!("exposure {sign}{stops} EV"))
}

/// A grey on which both white and black edges can be seen.
fn backdrop(svg: &mut Svg, Area { x, y, width, height }: Area) {
    svg.raw(&format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"6\" fill=\"#6f747b\"/>"));
}
