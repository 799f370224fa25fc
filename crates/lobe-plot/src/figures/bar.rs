//! Bars that explain the colours of a figure.

use colorous::Color;

use super::shared::MIDDLE;
use crate::image::Image;
use crate::svg::{Area, Role, Svg, Text};

/// The height of a bar.
const HEIGHT: f64 = 16.0;

/// The left end of a bar, and its length.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    pub left: f64,
    pub length: f64,
}

impl Extent {
    pub fn of(svg: &Svg<'_>) -> Self {
        let left = if svg.layout().is_narrow { 40.0 } else { 150.0 };
        Extent { left, length: svg.layout().width - 2.0 * left }
    }
}

/// The colours from the left end (0) to the right end (1), as a picture of one row.
pub(super) fn ramp(colour: impl Fn(f64) -> Color) -> Image {
    const STEPS: usize = 256;
    let rgba = (0..STEPS).flat_map(|step| {
        let Color { r, g, b } = colour(step as f64 / (STEPS - 1) as f64);
        [r, g, b, 255]
    });
    Image { width: STEPS as u32, height: 1, rgba: rgba.collect() }
}

/// A bar in a frame, without labels.
pub(super) fn framed(svg: &mut Svg<'_>, y: f64, colour: impl Fn(f64) -> Color) -> Extent {
    let Extent { left, length } = Extent::of(svg);
    svg.image(Area { x: left, y, width: length, height: HEIGHT }, &ramp(colour));
    for (from, to) in [
        ([left, y], [left + length, y]),
        ([left, y + HEIGHT], [left + length, y + HEIGHT]),
        ([left, y], [left, y + HEIGHT]),
        ([left + length, y], [left + length, y + HEIGHT]),
    ] {
        svg.line(from, to, Role::Frame, 1.0);
    }
    Extent { left, length }
}

/// A bar with labels, each at its share of the length.
pub(super) fn labelled(svg: &mut Svg<'_>, y: f64, colour: impl Fn(f64) -> Color, labels: &[(f64, &str)]) {
    let Extent { left, length } = framed(svg, y, colour);
    for (share, label) in labels {
        let x = left + share * length;
        svg.line([x, y + HEIGHT], [x, y + HEIGHT + 6.0], Role::Frame, 1.0);
        svg.text([x, y + HEIGHT + 24.0], Text { size: 16.0, ..MIDDLE }, label);
    }
}
