//! Small panels of curves against the viewing angle or the wavelength.

use super::chart::Axis;
use super::lines::runs;
use crate::ink::Ink;
use crate::scale::{Scale, Scaling, Tick, minus};
use crate::svg::{Anchor, Area, LABEL, Role, Svg, Text};

/// The largest deviation of a drawn line from the values, in units of the figure.
const TOLERANCE: f64 = 0.1;
/// Viewing angles with a label, in degrees.
const LABELLED: [i32; 3] = [-60, 0, 60];

/// A curve of a panel.
#[derive(Clone, Debug)]
pub(super) struct Trace<'a> {
    pub(super) ink: Ink,
    /// The viewing angles in radians, or the wavelengths in nm, ascending.
    pub(super) x: &'a [f64],
    /// A value for each, or `None` if there is none.
    pub(super) values: Vec<Option<f32>>,
    pub(super) is_measured: &'a [bool],
    /// The viewing angle of the mirror direction.
    pub(super) mirror: Option<f64>,
}

/// A panel.
#[derive(Debug)]
pub(super) struct Small<'a> {
    pub(super) area: Area,
    /// The name in its corner; see [`Svg::rich`].
    pub(super) name: String,
    pub(super) axis: Axis,
    pub(super) scale: Scale,
    pub(super) traces: Vec<Trace<'a>>,
    /// Labels of the axis below the panel, and of the values to its left.
    pub(super) has_labels: [bool; 2],
    /// The size of labels.
    pub(super) size: f64,
}

impl Small<'_> {
    pub(super) fn draw(&self, svg: &mut Svg<'_>) {
        let Area { x, y, width, height } = self.area;
        let place = |at: f64| x + width * self.axis.place(at);
        let level = |value: f64| y + height * (1.0 - self.scale.place(value).clamp(-0.2, 1.2));
        let style = Text { size: self.size, ..LABEL };
        for (value, label) in self.ticks() {
            let at = place(value);
            svg.line([at, y], [at, y + height], if value == 0.0 { Role::Grid } else { Role::Faint }, 1.0);
            if let Some(label) = label.filter(|_| self.has_labels[0]) {
                let text = Text { anchor: Anchor::Middle, ..style };
                svg.text([at, y + height + self.size + 2.0], text, &label);
            }
        }
        for tick in self.levels() {
            let at = level(tick.value);
            svg.line([x, at], [x + width, at], if tick.value == 0.0 { Role::Grid } else { Role::Faint }, 1.0);
            if self.has_labels[1] {
                let text = Text { anchor: Anchor::End, ..style };
                svg.rich([x - 6.0, at + 0.35 * self.size], text, tick.label.as_deref().unwrap_or_default());
            }
        }
        svg.clipped(self.area, |svg| {
            for trace in &self.traces {
                for part in trace.parts() {
                    let points: Vec<[f64; 2]> =
                        part.iter().map(|&(x, value, _)| [place(x), level(f64::from(value))]).collect();
                    let is_measured: Vec<bool> = part.iter().map(|&(.., is_measured)| is_measured).collect();
                    svg.series(&trace.ink, &runs(&points, &is_measured, TOLERANCE));
                }
            }
        });
        for Trace { ink, mirror, .. } in &self.traces {
            let Some(at) = mirror.map(place) else { continue };
            svg.mark(ink, &[[at - 3.5, y - 6.0], [at + 3.5, y - 6.0], [at, y - 0.6]]);
        }
        for (from, to) in [
            ([x, y], [x, y + height]),
            ([x, y + height], [x + width, y + height]),
            ([x + width, y + height], [x + width, y]),
            ([x + width, y], [x, y]),
        ] {
            svg.line(from, to, Role::Frame, 1.0);
        }
        let name = Text { is_heavy: true, has_halo: true, ..style };
        svg.rich([x + 6.0, y + self.size + 3.0], name, &self.name);
    }

    /// The values that have a line and a label: as many as there is room for, among them 0.
    fn levels(&self) -> Vec<Tick> {
        let ticks: Vec<Tick> = self.scale.ticks().into_iter().filter(|tick| tick.label.is_some()).collect();
        let place = |tick: &Tick| self.area.height * self.scale.place(tick.value);
        let least = ticks.windows(2).map(|pair| place(&pair[1]) - place(&pair[0])).fold(f64::INFINITY, f64::min);
        let step = (1.1 * self.size / least).ceil().max(1.0) as usize;
        let zero = ticks.iter().position(|tick| tick.value == 0.0).unwrap_or(0);
        ticks.into_iter().skip(zero % step).step_by(step).collect()
    }

    /// The values along the axis that have a line, and their labels.
    fn ticks(&self) -> Vec<(f64, Option<String>)> {
        match self.axis {
            Axis::Angle => {
                let label = |angle: i32| LABELLED.contains(&angle).then(|| minus(&angle.to_string()));
                (-60..=60).step_by(30).map(|angle| (f64::from(angle).to_radians(), label(angle))).collect()
            }
            Axis::Wavelength(low, high) => {
                let scale = Scale { scaling: Scaling::Linear, low, high };
                scale.ticks().into_iter().map(|tick| (tick.value, tick.label)).collect()
            }
        }
    }
}

impl Trace<'_> {
    /// The curve, divided where it has no value.
    fn parts(&self) -> Vec<Vec<(f64, f32, bool)>> {
        let mut parts = vec![Vec::new()];
        for ((x, value), is_measured) in self.x.iter().zip(&self.values).zip(self.is_measured) {
            match value {
                Some(value) => parts.last_mut().expect("a part").push((*x, *value, *is_measured)),
                None => parts.push(Vec::new()),
            }
        }
        parts.retain(|part| !part.is_empty());
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_values_do_not_overlap_and_include_0() {
        let ratio = Scale { scaling: Scaling::Linear, low: -1.0, high: 1.0 };
        let decades = Scale { scaling: Scaling::Log, low: 1e-4, high: 10.0 };
        for (scale, height) in [84.0, 116.0, 300.0].into_iter().flat_map(|height| [(ratio, height), (decades, height)])
        {
            let area = Area { x: 0.0, y: 0.0, width: 100.0, height };
            let (name, traces) = (String::new(), Vec::new());
            let small = Small { area, name, axis: Axis::Angle, scale, traces, has_labels: [true; 2], size: 14.0 };
            let levels = small.levels();
            assert!(levels.len() > 1, "{height}");
            for pair in levels.windows(2) {
                assert!(
                    height * (scale.place(pair[1].value) - scale.place(pair[0].value)) >= 14.0,
                    "{height} {pair:?}"
                );
            }
            assert_eq!(scale.low < 0.0, levels.iter().any(|tick| tick.value == 0.0));
        }
    }

    #[test]
    fn curves_end_where_there_is_no_value() {
        let trace = Trace {
            ink: Ink::of_set(0),
            x: &[0.0, 0.1, 0.2, 0.3],
            values: vec![Some(1.0), None, Some(2.0), Some(3.0)],
            is_measured: &[true, true, false, true],
            mirror: None,
        };
        assert_eq!(trace.parts(), [vec![(0.0, 1.0, true)], vec![(0.2, 2.0, false), (0.3, 3.0, true)]]);
    }
}
