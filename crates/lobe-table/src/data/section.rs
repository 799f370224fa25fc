//! What there is to say about measured values, for people and for checks.

use std::borrow::Cow;

use super::{Aspect, Kind};
use crate::Channels;

/// Values of one measurement, with what there is to say about them. Most data have one section; windows have one for each
/// band of wavelengths, side and way.
#[derive(Clone, Debug)]
pub struct Section<'a> {
    /// What the section is called in the file's own words; empty if there is only one.
    pub name: String,
    /// The representation of these values.
    pub kind: Kind,
    /// What was measured.
    pub aspect: Aspect,
    /// What the channels mean.
    pub channels: Channels,
    /// The knots of each axis. Empty if the representation has no lists of knots.
    pub axes: Vec<SectionAxis>,
    /// Whatever else there is to say.
    pub facts: Vec<Fact>,
    /// What the values are, with their unit.
    pub quantity: &'static str,
    /// All values that are stored, without gaps that are NaN.
    pub values: Cow<'a, [f32]>,
    /// The memory that the values take, in bytes.
    pub bytes: usize,
    /// Those of the values that represent light and were measured; `None` if all do.
    pub measured: Option<Vec<f32>>,
}

/// An axis of angles.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionAxis {
    /// Its name in the representation.
    pub name: &'static str,
    /// Its knots in radians, ascending.
    pub knots: Vec<f64>,
}

/// Something to say, under a name of one word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fact {
    /// What it is about.
    pub name: &'static str,
    /// What there is to say.
    pub text: String,
}

impl<'a> Section<'a> {
    /// `f` in 1/sr, about which nothing else is known.
    pub fn new(kind: Kind, aspect: Aspect, channels: Channels, values: &'a [f32]) -> Self {
        Section {
            name: String::new(),
            kind,
            aspect,
            channels,
            axes: Vec::new(),
            facts: Vec::new(),
            quantity: "f in 1/sr",
            values: Cow::Borrowed(values),
            bytes: size_of_val(values),
            measured: None,
        }
    }

    /// The same with axes: names and knots in radians.
    pub fn with_axes<const N: usize>(mut self, names: [&'static str; N], knots: &[Vec<f64>; N]) -> Self {
        let axes = names.into_iter().zip(knots).map(|(name, knots)| SectionAxis { name, knots: knots.clone() });
        self.axes.extend(axes);
        self
    }

    /// The same with one more fact.
    pub fn with_fact(mut self, name: &'static str, text: impl Into<String>) -> Self {
        self.facts.push(Fact { name, text: text.into() });
        self
    }

    /// The values that represent light and were measured.
    pub fn measured(&self) -> &[f32] {
        self.measured.as_deref().unwrap_or(&self.values)
    }
}

/// How much of the data the file itself marks as not measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gaps {
    /// How many are missing.
    pub missing: usize,
    /// How many there would be.
    pub all: usize,
    /// What is counted, such as `bins`.
    pub of: &'static str,
    /// Whether evaluation knows them as gaps; a mask that no program uses is only worth telling.
    pub is_used: bool,
}

/// Values on a grid of four angles: polar angle and azimuth of the light, then of the viewer.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// The names of the axes.
    pub names: [&'static str; 4],
    /// The knots of each, in radians.
    pub knots: &'a [Vec<f64>; 4],
    /// `[light polar][light azimuth][viewer polar][viewer azimuth][channel]`.
    pub values: &'a [f32],
    /// How many channels a value has.
    pub channels: usize,
    /// The azimuths of the viewer cover half a turn, and that is how it is meant.
    pub is_mirrored: bool,
    /// The angles of the viewer are about the mirror direction.
    pub is_specular: bool,
}

/// Where interpolated values have kinks, for integrals over the hemisphere: angles about an axis in the plane of incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct Kinks {
    /// The polar angle of the axis, on the other side of the normal from the light; 0 is the normal.
    pub zenith: f64,
    /// Polar angles about the axis, ascending.
    pub thetas: Vec<f64>,
    /// Azimuths about the axis, counted from the light, ascending.
    pub phis: Vec<f64>,
}

/// Knots that were degrees in a file come back to within this of the pole or the full turn, in radians.
pub const ANGLE_ROUNDING: f64 = 1e-5;

/// `true` if the last of these angles is the first one again, a turn later.
pub fn closes_circle(knots: &[f64]) -> bool {
    knots.len() > 1 && (knots[knots.len() - 1] - knots[0] - std::f64::consts::TAU).abs() < ANGLE_ROUNDING
}

/// Every pair of a polar angle and an azimuth. The last azimuth of a full turn repeats the first and is left out.
pub(crate) fn pairs(thetas: &[f64], phis: &[f64]) -> Vec<[f64; 2]> {
    let open = phis.len() - usize::from(closes_circle(phis));
    thetas.iter().flat_map(|&theta| phis[..open].iter().map(move |&phi| [theta, phi])).collect()
}
