//! Spheres under several lights: one large, and smaller ones next to it; or one sphere per file for several files.

use super::cartesian::title;
use super::shared::{MARGIN, MIDDLE, conditions, heading, id, notes, shortened};
use crate::evaluate::Progress;
use crate::layout::{Layout, Paper};
use crate::scale::minus;
use crate::shade::{Sphere, Studio, shade, studios};
use crate::shown::Shown;
use crate::svg::{Area, Role, Svg, Text};

/// The distance between a sphere and the edge of its backdrop.
const PADDING: f64 = 12.0;
/// The distance between backdrops.
const GAP: f64 = 12.0;
/// The space below a backdrop for its captions.
const CAPTION: f64 = 44.0;

/// A sphere with its caption.
#[derive(Clone, Debug)]
pub(super) struct Ball {
    sphere: Sphere,
    caption: String,
    /// In stops.
    pub(super) exposure: f64,
}

/// The spheres of a figure: one per light for a single file, or the first sphere of each of several files, at one
/// exposure.
pub(super) fn spheres(shown: &[Shown<'_>], progress: &dyn Progress) -> Vec<Ball> {
    let ball = |shown: &Shown<'_>, studio: Studio, units: f64, caption: String| {
        let density = if shown.subject.is_slow() { 0.8 } else { 1.25 };
        let pixels = (density * units * f64::from(shown.view.width) / Layout::WIDE.width).round().clamp(32.0, 560.0);
        let sphere = shade(shown.subject, shown.view, studio, pixels as usize, progress);
        Ball { exposure: sphere.exposure(), sphere, caption }
    };
    match shown {
        [one] => {
            let studios = studios(one.subject, one.view.side);
            let sizes = Places::of_one(Layout::WIDE, 0.0, studios.len());
            let sized = studios.into_iter().zip(sizes.areas);
            sized.map(|(studio, area)| ball(one, studio, area.width - 2.0 * PADDING, name(studio).into())).collect()
        }
        several => {
            let units = Places::of_several(Layout::WIDE, 0.0, several.len()).areas[0].width - 2.0 * PADDING;
            let first = |shown: &Shown<'_>| studios(shown.subject, shown.view.side).first().copied();
            let of_file = |shown: &Shown<'_>| Some(ball(shown, first(shown)?, units, shown.subject.name().into()));
            let mut balls: Vec<Ball> = several.iter().filter_map(of_file).collect();
            // At one exposure, so that brighter materials look brighter; the brightest decides.
            let exposure = balls.iter().map(|ball| ball.exposure).fold(f64::INFINITY, f64::min);
            balls.iter_mut().for_each(|ball| ball.exposure = exposure);
            balls
        }
    }
}

/// The positions of the spheres.
struct Places {
    areas: Vec<Area>,
    /// The height below the last caption.
    bottom: f64,
}

impl Places {
    /// The first large, the others small: next to it, or below it on narrow paper.
    fn of_one(layout: Layout, top: f64, count: usize) -> Self {
        let room = layout.width - 2.0 * MARGIN;
        let square = |x: f64, y: f64, side: f64| Area { x, y, width: side, height: side };
        let mut areas = Vec::new();
        if layout.is_narrow {
            let small = 0.5 * (room - GAP);
            for at in 0..count {
                let (column, row) = (at.saturating_sub(1) % 2, at.saturating_sub(1) / 2);
                areas.push(match at {
                    0 => square(MARGIN, top, room),
                    _ => square(
                        MARGIN + column as f64 * (small + GAP),
                        top + room + CAPTION + row as f64 * (small + CAPTION),
                        small,
                    ),
                });
            }
        } else {
            // The backdrops fill the width, and two rows of small ones fill the height of the large one.
            let columns = if count > 3 { 2 } else { 1 };
            let small = (room - columns as f64 * GAP - CAPTION) / (columns as f64 + 2.0);
            let large = 2.0 * small + CAPTION;
            for at in 0..count {
                let (column, row) = (at.saturating_sub(1) % columns, at.saturating_sub(1) / columns);
                areas.push(match at {
                    0 => square(MARGIN, top, large),
                    _ => square(
                        MARGIN + large + GAP + column as f64 * (small + GAP),
                        top + row as f64 * (small + CAPTION),
                        small,
                    ),
                });
            }
        }
        Places::new(areas, top)
    }

    /// All of the same size.
    fn of_several(layout: Layout, top: f64, count: usize) -> Self {
        let columns = if layout.is_narrow || count == 2 { 2 } else { 3 };
        let side = (layout.width - 2.0 * MARGIN - (columns - 1) as f64 * GAP) / columns as f64;
        let area = |at: usize| Area {
            x: MARGIN + (at % columns) as f64 * (side + GAP),
            y: top + (at / columns) as f64 * (side + CAPTION),
            width: side,
            height: side,
        };
        Places::new((0..count).map(area).collect(), top)
    }

    fn new(areas: Vec<Area>, top: f64) -> Self {
        let bottom = areas.iter().map(|area| area.y + area.height + CAPTION).fold(top, f64::max);
        Places { areas, bottom }
    }
}

/// The spheres with their captions.
pub(super) fn draw(shown: &[Shown<'_>], balls: &[Ball], paper: Paper<'_>) -> String {
    let Some(first) = shown.first() else { return String::new() };
    let mut svg = Svg::new(id("sphere", first.view), paper);
    let colours = if shown.iter().all(|shown| shown.view.colour.is_grey()) { "grey" } else { "sRGB" };
    let top = heading(&mut svg, shown, &format!("Sphere, {colours}, {}", conditions(shown)));
    let Places { areas, bottom } = match shown.len() {
        1 => Places::of_one(paper.layout, top, balls.len()),
        _ => Places::of_several(paper.layout, top, balls.len()),
    };
    for (Ball { sphere, caption, exposure: stops }, area) in balls.iter().zip(areas) {
        let Area { x, y, width: side, .. } = area;
        backdrop(&mut svg, area);
        let size = side - 2.0 * PADDING;
        let inside = Area { x: x + PADDING, y: y + PADDING, width: size, height: size };
        svg.image(inside, &sphere.picture(*stops));
        let letters = (side / 7.6) as usize;
        svg.text([x + 0.5 * side, y + side + 18.0], Text { size: 16.0, ..MIDDLE }, &shortened(caption, letters));
        let muted = Text { size: 14.0, role: Role::Muted, ..MIDDLE };
        svg.text([x + 0.5 * side, y + side + 35.0], muted, &format!("exposure {}", ev(*stops)));
    }
    let note = match balls.is_empty() {
        true => "There are no values for pairs of directions.",
        false => "At 0 EV, a white Lambertian surface that faces the light has the largest pixel value.",
    };
    let end = notes(&mut svg, bottom + 18.0, &[note.into()]);
    svg.finish(end - 4.0, &title(shown, &format!("spheres of the material under {} lights", balls.len())))
}

fn name(studio: Studio) -> &'static str {
    match studio {
        Studio::Key => "light from the upper left",
        Studio::Viewer => "next to the viewer",
        Studio::Rim => "behind the rim",
        Studio::Turned => "turned by 90°",
        Studio::Behind => "through, from behind",
    }
}

/// An exposure in stops, with its sign.
pub(super) fn ev(stops: f64) -> String {
    let sign = if stops > 0.0 { "+" } else { "" };
    minus(&format!("{sign}{stops} EV"))
}

/// A grey on which both white and black edges can be seen.
fn backdrop(svg: &mut Svg<'_>, Area { x, y, width, height }: Area) {
    svg.raw(&format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"6\" fill=\"#6f747b\"/>"));
}
