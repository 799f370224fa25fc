//! Shows how different a fitted model looks from the measurement, on a sphere.

use lobe_ops::compare::Spheres;

use super::cartesian::title;
use super::shared::{MARGIN, MIDDLE, heading, id, notes};
use super::slices::{LEFT_OF_BAR, frame_of_bar};
use crate::image::Image;
use crate::layout::Paper;
use crate::shown::Shown;
use crate::svg::{Area, Role, Svg, Text};

const RADIUS: f64 = 150.0;
/// The difference at the end of the colours.
const END: f64 = 10.0;

/// The differences of the pixels in colour, and their summary.
pub(super) fn draw(shown: Shown<'_>, spheres: &Spheres, paper: Paper<'_>) -> String {
    let width = paper.layout.width;
    let radius = RADIUS.min(0.5 * width - MARGIN);
    let mut svg = Svg::new(id("appearance", shown.view), paper);
    let what = "Two spheres, of the fit and of the measurement: CIE ΔE 2000";
    let top = heading(&mut svg, &[shown], what) + 6.0;
    let area = Area { x: 0.5 * width - radius, y: top, width: 2.0 * radius, height: 2.0 * radius };
    svg.image(area, &picture(spheres));
    let found = spheres.summary();
    let said = format!("mean {:.2}, 95 % below {:.2}, at most {:.2}", found.mean, found.percentile_95, found.max);
    let y = top + 2.0 * radius + 22.0;
    svg.text([0.5 * width, y], Text { size: 14.0, role: Role::Muted, ..MIDDLE }, &said);
    bar(&mut svg, y + 18.0);
    let lines = ["A distant light above left. A difference of about 1 is just noticeable side by side.".to_string()];
    let bottom = notes(&mut svg, y + 90.0, &lines);
    svg.finish(bottom, &title(&[shown], "the visible difference between the fit and the measurement"))
}

/// Dark for 0, bright for large differences.
fn colour(delta_e: f64) -> [u8; 3] {
    let colorous::Color { r, g, b } = colorous::VIRIDIS.eval_continuous((delta_e / END).clamp(0.0, 1.0));
    [r, g, b]
}

fn picture(spheres: &Spheres) -> Image {
    let pixel = |delta_e: &Option<f64>| match delta_e {
        None => [0; 4],
        Some(delta_e) => {
            let [r, g, b] = colour(*delta_e);
            [r, g, b, 255]
        }
    };
    let size = spheres.size as u32;
    Image { width: size, height: size, rgba: spheres.delta_e.iter().flat_map(pixel).collect() }
}

fn bar(svg: &mut Svg<'_>, y: f64) {
    const STEPS: usize = 256;
    let width = svg.layout().width;
    let left = if svg.layout().is_narrow { 40.0 } else { LEFT_OF_BAR };
    let length = width - 2.0 * left;
    let rgba = (0..STEPS).flat_map(|step| {
        let [r, g, b] = colour(END * step as f64 / (STEPS - 1) as f64);
        [r, g, b, 255]
    });
    let ramp = Image { width: STEPS as u32, height: 1, rgba: rgba.collect() };
    svg.image(Area { x: left, y, width: length, height: 16.0 }, &ramp);
    frame_of_bar(svg, [left, y], length);
    for (delta_e, label) in [(0.0, "0"), (1.0, "1"), (2.0, "2"), (5.0, "5"), (END, "10+")] {
        let x = left + delta_e / END * length;
        svg.line([x, y + 16.0], [x, y + 22.0], Role::Frame, 1.0);
        svg.text([x, y + 40.0], Text { size: 16.0, ..MIDDLE }, label);
    }
}
