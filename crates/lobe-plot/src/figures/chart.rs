//! Panels of lines over one axis: viewing angles or wavelengths.

use super::legend::{Entry, Legend};
use super::lines::runs;
use super::shared::{MARGIN, MIDDLE, heading, notes};
use crate::ink::Ink;
use crate::layout::Paper;
use crate::scale::{Scale, Scaling, minus};
use crate::shown::Shown;
use crate::svg::{Anchor, Area, LABEL, Role, Svg, Text};

/// The largest deviation of a drawn line from the values, in units of the figure.
const TOLERANCE: f64 = 0.05;
/// The distance between panels.
const GAP: f64 = 30.0;
/// The room above a panel for its name, in addition to that distance and to the one below the heading.
const NAME: [f64; 2] = [10.0, 22.0];
/// Labels of more letters than this do not fit next to a plot.
const SHORT: usize = 9;
/// More dots than this would hide their line.
pub(super) const DOTS: usize = 200;

/// The axis over which lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Axis {
    /// Viewing angles, from -90 to 90 degrees.
    Angle,
    /// Wavelengths in nanometres, from the first to the last.
    Wavelength(f64, f64),
}

impl Axis {
    /// The position of radians or nanometres: 0 on the left, 1 on the right.
    pub(super) fn place(self, x: f64) -> f64 {
        match self {
            Axis::Angle => 0.5 + x.to_degrees() / 180.0,
            Axis::Wavelength(first, last) => (x - first) / (last - first),
        }
    }
}

/// A line of one series.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) ink: Ink,
    /// Radians or nanometres, ascending.
    pub(super) x: Vec<f64>,
    pub(super) f: Vec<f32>,
    pub(super) is_measured: Vec<bool>,
    /// The hints at some of its points.
    pub(super) hints: Vec<Hint>,
}

/// A hint that is shown when the pointer is on a point of a line.
#[derive(Clone, Debug)]
pub(super) struct Hint {
    /// The position in the line.
    pub(super) at: usize,
    /// The value was measured there, which a dot shows.
    pub(super) is_point: bool,
    pub(super) text: String,
}

/// The mark of a mirror direction, or of a straight ray, above a panel.
#[derive(Clone, Debug)]
pub(super) struct Mirror {
    pub(super) ink: Option<Ink>,
    pub(super) x: f64,
}

/// Lines with their own axis of values.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub(super) name: String,
    /// Panels of one group have the same axis of values.
    pub(super) group: usize,
    pub(super) lines: Vec<Line>,
    pub(super) mirrors: Vec<Mirror>,
}

/// A figure of panels, one below the other.
#[derive(Clone, Debug)]
pub(super) struct Chart<'a> {
    pub(super) id: String,
    pub(super) shown: Vec<Shown<'a>>,
    /// The contents of the figure, shown below the names.
    pub(super) what: String,
    /// A description for screen readers.
    pub(super) title: String,
    pub(super) axis: Axis,
    pub(super) scaling: Scaling,
    pub(super) panels: Vec<Panel>,
    /// The meaning of the series, and each of them.
    pub(super) legend: (&'static str, Vec<Entry>),
    /// The labels at the left and the right end of the axis.
    pub(super) ends: [&'static str; 2],
    pub(super) notes: Vec<String>,
}

impl Chart<'_> {
    pub(super) fn draw(&self, paper: Paper<'_>) -> String {
        let layout = paper.layout;
        let (legend, entries) = &self.legend;
        let is_below = layout.is_narrow || entries.iter().any(|entry| entry.label.chars().count() > SHORT);
        // The axis has its name to the left of the longest number.
        let left = if layout.is_narrow { 30.0 + 9.0 * self.longest_number().max(4) as f64 } else { 92.0 };
        let right = if is_below { MARGIN } else { 156.0 };
        let height = match (self.panels.len(), layout.is_narrow) {
            (..=1, false) => 380.0,
            (..=1, true) | (2, false) => 300.0,
            (2, true) => 240.0,
            (_, false) => 230.0,
            (_, true) => 190.0,
        };
        let mut svg = Svg::new(self.id.as_str(), paper);
        let has_names = self.panels.iter().any(|panel| !panel.name.is_empty());
        let [between, first] = if has_names { NAME } else { [0.0; 2] };
        let top = heading(&mut svg, &self.shown, &self.what) + 6.0 + first;
        let step = height + GAP + between;
        for (index, panel) in self.panels.iter().enumerate() {
            let y = top + index as f64 * step;
            let area = Area { x: left, y, width: layout.width - left - right, height };
            self.panel(&mut svg, area, panel, index + 1 == self.panels.len());
        }
        let bottom = top + (self.panels.len().max(1) - 1) as f64 * step + height;
        let mut y = self.below_axis(&mut svg, [left, layout.width - right], bottom);
        let legend = Legend {
            title: legend,
            entries,
            has_mirror: self.panels.iter().any(|panel| !panel.mirrors.is_empty()),
            has_points: self.lines().any(|line| (1..=DOTS).contains(&line.points().count())),
            has_continued: self.lines().any(|line| line.is_measured.contains(&false)),
        };
        match is_below {
            true => y = legend.below(&mut svg, y + 6.0),
            false => legend.beside(&mut svg, [layout.width - right + 20.0, top + 14.0]),
        }
        let end = notes(&mut svg, y + 4.0, &self.notes);
        let upward = Text { is_upward: true, ..MIDDLE };
        svg.rich([MARGIN - if layout.is_narrow { 4.0 } else { -4.0 }, 0.5 * (top + bottom)], upward, "f (1/sr)");
        svg.finish(end - 4.0, &self.title)
    }

    fn lines(&self) -> impl Iterator<Item = &Line> {
        self.panels.iter().flat_map(|panel| &panel.lines)
    }

    /// The lines that share the axis of values of a panel.
    fn of_group(&self, panel: &Panel) -> Vec<&Line> {
        let of_group = self.panels.iter().filter(|other| other.group == panel.group);
        of_group.flat_map(|panel| &panel.lines).collect()
    }

    /// The characters of the longest number at an axis of values.
    fn longest_number(&self) -> usize {
        let scales = self.panels.iter().map(|panel| Scale::around(self.counted(&self.of_group(panel)), self.scaling));
        let labels = scales.flat_map(|scale| scale.ticks()).filter_map(|tick| tick.label);
        // Without the signs of an exponent, which are not drawn.
        let characters = |label: String| label.chars().filter(|c| !matches!(c, '^' | '{' | '}')).count();
        labels.map(characters).max().unwrap_or(0)
    }

    fn panel(&self, svg: &mut Svg<'_>, area: Area, panel: &Panel, is_last: bool) {
        let lines = self.of_group(panel);
        let scale = Scale::around(self.counted(&lines), self.scaling);
        self.angles_or_wavelengths(svg, area, is_last);
        values(svg, area, &scale);
        let y = |f: f32| area.y + area.height * (1.0 - scale.place(f64::from(f)).clamp(-0.2, 1.2));
        let place = |x: f64| area.x + area.width * self.axis.place(x);
        svg.clipped(area, |svg| {
            for line in &panel.lines {
                let points: Vec<[f64; 2]> = line.x.iter().zip(&line.f).map(|(&x, &f)| [place(x), y(f)]).collect();
                svg.series(&line.ink, &runs(&points, &line.is_measured, TOLERANCE));
                if line.points().count() <= DOTS {
                    svg.dots(&line.ink, &line.points().map(|hint| points[hint.at]).collect::<Vec<_>>());
                }
            }
            for line in &panel.lines {
                for hint in &line.hints {
                    svg.hint([place(line.x[hint.at]), y(line.f[hint.at])], 6.0, &hint.text);
                }
            }
        });
        for mirror in &panel.mirrors {
            let x = place(mirror.x);
            let corners = [[x - 5.5, area.y - 10.0], [x + 5.5, area.y - 10.0], [x, area.y - 0.8]];
            match &mirror.ink {
                Some(ink) => svg.mark(ink, &corners),
                None => svg.muted_mark(&corners),
            }
        }
        frame(svg, area);
        // Above the marks of the mirror directions; in the panel it would cover lines.
        let name = Text { is_heavy: true, size: 16.0, ..LABEL };
        if !panel.name.is_empty() {
            svg.text([area.x, area.y - 14.0], name, &panel.name);
        }
        if self.scaling == Scaling::Log && !lines.iter().any(|line| line.f.iter().any(|f| *f > 0.0)) {
            let middle = [area.x + 0.5 * area.width, area.y + 0.5 * area.height];
            svg.text(middle, Text { role: Role::Muted, has_halo: true, ..MIDDLE }, "no value is above 0");
        }
    }

    /// The values that an axis has to cover. Values near the horizon are left out, and so are unmeasured ones, unless
    /// nothing was measured.
    fn counted(&self, lines: &[&Line]) -> impl Iterator<Item = f64> {
        let any = lines.iter().any(|line| line.is_measured.contains(&true));
        let is_near_horizon = |x: f64| self.axis == Axis::Angle && x.abs() >= 1.5;
        let mut values = Vec::new();
        for line in lines {
            for ((&x, &f), &is_measured) in line.x.iter().zip(&line.f).zip(&line.is_measured) {
                if !is_near_horizon(x) && (is_measured || !any) {
                    values.push(f64::from(f));
                }
            }
        }
        values.into_iter()
    }

    /// The vertical grid lines and their numbers.
    fn angles_or_wavelengths(&self, svg: &mut Svg<'_>, area: Area, is_last: bool) {
        let bottom = area.y + area.height;
        let mut tick = |x: f64, label: Option<String>, role: Role| {
            let x = area.x + area.width * self.axis.place(x);
            if label.is_some() {
                svg.line([x, area.y], [x, bottom], role, 1.0);
            }
            svg.line([x, bottom], [x, bottom + if label.is_some() { 6.0 } else { 3.5 }], Role::Frame, 1.0);
            if let Some(label) = label.filter(|_| is_last) {
                let text = Text { anchor: Anchor::Middle, size: 16.0, ..LABEL };
                svg.text([x, bottom + 25.0], text, &label);
            }
        };
        match self.axis {
            Axis::Angle => {
                for angle in (-90..=90).step_by(10) {
                    let label = (angle % 30 == 0).then(|| minus(&angle.to_string()));
                    tick(f64::from(angle).to_radians(), label, if angle == 0 { Role::Grid } else { Role::Faint });
                }
            }
            Axis::Wavelength(low, high) => {
                for mark in (Scale { scaling: Scaling::Linear, low, high }).ticks() {
                    tick(mark.value, mark.label, Role::Faint);
                }
            }
        }
    }

    /// The label of the axis; returns the height below it.
    fn below_axis(&self, svg: &mut Svg<'_>, [from, to]: [f64; 2], bottom: f64) -> f64 {
        let label = match self.axis {
            Axis::Angle => "viewing angle θ_{o} (degrees)",
            Axis::Wavelength(..) => "wavelength (nm)",
        };
        let note = Text { role: Role::Muted, size: 15.0, ..LABEL };
        // The labels at the ends go below the axis label if they would overlap.
        let y = bottom + if svg.layout().is_narrow { 72.0 } else { 52.0 };
        svg.rich([0.5 * (from + to), bottom + 52.0], MIDDLE, label);
        let [start, end] = self.ends;
        if start.is_empty() && end.is_empty() {
            return bottom + 76.0;
        }
        svg.text([from, y], note, start);
        svg.text([to, y], Text { anchor: Anchor::End, ..note }, end);
        y + 24.0
    }
}

impl Line {
    /// The measured points.
    fn points(&self) -> impl Iterator<Item = &Hint> {
        self.hints.iter().filter(|hint| hint.is_point)
    }
}

/// The horizontal grid lines and their numbers.
fn values(svg: &mut Svg<'_>, area: Area, scale: &Scale) {
    for tick in scale.ticks() {
        let y = area.y + area.height * (1.0 - scale.place(tick.value));
        let role = if tick.label.is_some() { Role::Grid } else { Role::Faint };
        svg.line([area.x, y], [area.x + area.width, y], role, 1.0);
        let length = if tick.label.is_some() { 6.0 } else { 3.5 };
        svg.line([area.x - length, y], [area.x, y], Role::Frame, 1.0);
        if let Some(label) = tick.label {
            svg.rich([area.x - 11.0, y + 5.5], Text { anchor: Anchor::End, size: 16.0, ..LABEL }, &label);
        }
    }
}

fn frame(svg: &mut Svg<'_>, Area { x, y, width, height }: Area) {
    for (from, to) in [
        ([x, y], [x, y + height]),
        ([x, y + height], [x + width, y + height]),
        ([x + width, y + height], [x + width, y]),
        ([x + width, y], [x, y]),
    ] {
        svg.line(from, to, Role::Frame, 1.2);
    }
}
