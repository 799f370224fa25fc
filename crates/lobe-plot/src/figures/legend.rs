//! Legends of lines.

use super::shared::{MARGIN, shortened};
use crate::ink::Ink;
use crate::svg::{LABEL, Role, Svg, Text};

/// The distance between two entries.
const STEP: f64 = 25.0;

/// A series in a legend.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) ink: Ink,
    pub(super) label: String,
}

/// The series of a figure, and the meaning of its lines and marks.
#[derive(Debug)]
pub(super) struct Legend<'a> {
    /// The meaning of the series.
    pub(super) title: &'a str,
    pub(super) entries: &'a [Entry],
    pub(super) has_mirror: bool,
    pub(super) has_points: bool,
    pub(super) has_continued: bool,
}

/// A mark and its meaning.
enum Sign<'a> {
    Series(&'a Entry),
    Mirror,
    Point,
    Continued,
}

const NOTE: Text = Text { role: Role::Muted, size: 15.0, ..LABEL };

impl Legend<'_> {
    /// One entry per line, downward from `top`.
    pub(super) fn beside(&self, svg: &mut Svg<'_>, [x, top]: [f64; 2]) {
        svg.rich([x, top], Text { size: 16.0, ..NOTE }, self.title);
        let mut y = top;
        for sign in self.series() {
            y += STEP;
            draw(svg, [x, y], &sign, usize::MAX);
        }
        y += 10.0;
        for sign in self.signs() {
            y += STEP - 3.0;
            draw(svg, [x, y], &sign, usize::MAX);
        }
    }

    /// In rows over the width of the figure, downward from `top`; returns the height below them.
    pub(super) fn below(&self, svg: &mut Svg<'_>, top: f64) -> f64 {
        svg.rich([MARGIN, top], Text { size: 16.0, ..NOTE }, self.title);
        let mut y = self.rows(svg, top + STEP - 3.0, &self.series().collect::<Vec<_>>());
        y = self.rows(svg, y, &self.signs());
        y + 2.0
    }

    fn rows(&self, svg: &mut Svg<'_>, top: f64, signs: &[Sign<'_>]) -> f64 {
        // A mark, its label, and the distance to the next one.
        let width = |sign: &Sign<'_>| match sign {
            Sign::Series(entry) => 52.0 + 9.0 * entry.label.chars().count() as f64,
            Sign::Mirror | Sign::Point => 114.0,
            Sign::Continued => 140.0,
        };
        let room = svg.layout().width - 2.0 * MARGIN;
        let widest = signs.iter().map(width).fold(1.0, f64::max);
        let columns = (room / widest).floor().clamp(1.0, 8.0) as usize;
        let width = room / columns as f64;
        for (at, sign) in signs.iter().enumerate() {
            let place = [MARGIN + width * (at % columns) as f64, top + (STEP - 3.0) * (at / columns) as f64];
            draw(svg, place, sign, ((width - 40.0) / 8.5) as usize);
        }
        top + (STEP - 3.0) * signs.len().div_ceil(columns) as f64
    }

    fn series(&self) -> impl Iterator<Item = Sign<'_>> {
        self.entries.iter().map(Sign::Series)
    }

    fn signs(&self) -> Vec<Sign<'_>> {
        let all =
            [(Sign::Mirror, self.has_mirror), (Sign::Point, self.has_points), (Sign::Continued, self.has_continued)];
        all.into_iter().filter_map(|(sign, is_there)| is_there.then_some(sign)).collect()
    }
}

fn draw(svg: &mut Svg<'_>, [x, y]: [f64; 2], sign: &Sign<'_>, letters: usize) {
    match sign {
        Sign::Series(Entry { ink, label }) => {
            svg.series(ink, &[(true, vec![[x, y - 5.5], [x + 26.0, y - 5.5]])]);
            svg.text([x + 36.0, y], LABEL, &shortened(label, letters));
        }
        Sign::Mirror => {
            svg.muted_mark(&[[x + 8.0, y - 9.5], [x + 18.0, y - 9.5], [x + 13.0, y - 1.0]]);
            svg.text([x + 36.0, y], NOTE, "mirror");
        }
        Sign::Point => {
            let (cx, cy) = (x + 13.0, y - 5.0);
            svg.raw(&format!("<circle cx=\"{cx}\" cy=\"{cy}\" r=\"3\" class=\"muted\" fill=\"#5f656d\"/>"));
            svg.text([x + 36.0, y], NOTE, "measured");
        }
        Sign::Continued => {
            svg.raw(&format!(
                "<path d=\"M{x} {}h26\" class=\"muted-line\" stroke=\"#5f656d\" stroke-width=\"2.2\" \
                 stroke-dasharray=\"2.5 4\" stroke-linecap=\"round\" fill=\"none\"/>",
                y - 5.0
            ));
            svg.text([x + 36.0, y], NOTE, "not measured");
        }
    }
}
