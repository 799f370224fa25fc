//! Descriptions of the contents of a file, in names, numbers and words: what `lobe info` shows.

use lobe_formats::{self as formats, Document};
use lobe_table::data::Section;
use lobe_table::{Aspect, Scatter};
use serde::Serialize;

/// The description of a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// The name of the part in the file, and the light that it belongs to; may be empty.
    pub name: String,
    /// The representation.
    pub kind: &'static str,
    /// `reflection` or `transmission`.
    pub scatter: &'static str,
    /// The names of the channels.
    pub channels: Vec<String>,
    /// The coordinates, if it is a grid.
    pub axes: Vec<Axis>,
    /// Further facts.
    pub facts: Vec<(&'static str, String)>,
    /// The values as a whole.
    pub values: Values,
}

/// A coordinate of a grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// The name of the coordinate.
    pub name: &'static str,
    /// The unit of its knots.
    pub unit: &'static str,
    /// The number of knots.
    pub count: usize,
    /// The first knot.
    pub first: f32,
    /// The last knot.
    pub last: f32,
    /// All knots.
    pub knots: Vec<f32>,
}

/// The values of a part as a whole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Values {
    /// The meaning of the values.
    pub of: &'static str,
    /// The number of values.
    pub count: usize,
    /// Their size in memory, in bytes.
    pub bytes: usize,
    /// The smallest value.
    pub smallest: f32,
    /// The largest value.
    pub largest: f32,
    /// The number of values below 0.
    pub negative: usize,
}

impl Part {
    /// Everything but the name, as readable names and values.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![
            ("kind", self.kind.to_string()),
            ("scatter", self.scatter.to_string()),
            ("channels", format!("{}: {}", self.channels.len(), self.channels.join(" "))),
        ];
        for Axis { name, unit, count, first, last, knots } in &self.axes {
            rows.push((
                name,
                match count {
                    1 => format!("1 knot: {first} {unit}"),
                    _ => {
                        let knots: Vec<String> = knots.iter().map(f32::to_string).collect();
                        format!("{count} knots, {first} to {last} {unit}: {}", knots.join(" "))
                    }
                },
            ));
        }
        rows.extend(self.facts.iter().cloned());
        let Values { of, count, bytes, smallest, largest, negative } = &self.values;
        rows.push(("values", format!("{count} of {of}, {smallest} to {largest}, {negative} negative, {bytes} bytes")));
        rows
    }
}

/// The parts of a file.
pub fn describe(document: &Document) -> Vec<Part> {
    let of_part = |part: &formats::Part| {
        let sections = part.data.representation().sections();
        let name = |section: &Section<'_>| if document.is_sheet() { name(part, section) } else { section.name.clone() };
        sections.iter().map(|section| Part::new(name(section), section)).collect::<Vec<_>>()
    };
    document.parts.iter().flat_map(of_part).collect()
}

/// The name of a part of a sheet.
fn name(part: &formats::Part, section: &Section<'_>) -> String {
    let what = match part.side {
        Some(light) => Aspect { scatter: section.aspect.scatter, light }.to_string(),
        None => scatter(section).into(),
    };
    format!("{} {what}", part.name).trim().into()
}

fn scatter(section: &Section<'_>) -> &'static str {
    match section.aspect.scatter {
        Scatter::Reflection => "reflection",
        Scatter::Transmission => "transmission",
    }
}

impl Part {
    fn new(name: String, section: &Section<'_>) -> Self {
        Part {
            name,
            kind: section.kind.name(),
            scatter: scatter(section),
            channels: section.channels.names(),
            axes: section.axes.iter().map(|axis| Axis::new(axis.name, &axis.knots)).collect(),
            facts: section.facts.iter().map(|fact| (fact.name, fact.text.clone())).collect(),
            values: Values::new(section),
        }
    }
}

impl Axis {
    fn new(name: &'static str, radians: &[f64]) -> Self {
        let knots = degrees(radians);
        Axis { name, unit: "degrees", count: knots.len(), first: knots[0], last: knots[knots.len() - 1], knots }
    }
}

impl Values {
    fn new(section: &Section<'_>) -> Self {
        let values = &section.values;
        let (smallest, largest) = range(values.iter().copied());
        let negative = values.iter().filter(|&&value| value < 0.0).count();
        Values { of: section.quantity, count: values.len(), bytes: section.bytes, smallest, largest, negative }
    }
}

/// The smallest and the largest value.
pub fn range(values: impl Iterator<Item = f32>) -> (f32, f32) {
    values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Files hold degrees in `f32` precision, so rounding to it shows the number in the file.
fn degrees(radians: &[f64]) -> Vec<f32> {
    radians.iter().map(|angle| angle.to_degrees() as f32).collect()
}
