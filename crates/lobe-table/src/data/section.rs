//! Descriptions of measured values, for people and for checks.

use std::borrow::Cow;

use super::{Aspect, Kind};
use crate::Channels;

/// Values of one measurement, with facts about them. Most data have one section; windows have one per band of
/// wavelengths, side and scatter.
#[derive(Clone, Debug)]
pub struct Section<'a> {
    /// The name of the section in the file; empty if there is only one.
    pub name: String,
    /// The representation of these values.
    pub kind: Kind,
    /// The aspect that was measured.
    pub aspect: Aspect,
    /// The meaning of the channels.
    pub channels: Channels,
    /// The knots of each axis. Empty if the representation has no lists of knots.
    pub axes: Vec<SectionAxis>,
    /// Further facts.
    pub facts: Vec<Fact>,
    /// The quantity of the values, with its unit.
    pub quantity: &'static str,
    /// All stored values, without gaps that are NaN.
    pub values: Cow<'a, [f32]>,
    /// The memory that the values take, in bytes.
    pub bytes: usize,
    /// The values that represent light and were measured; `None` if all do.
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

/// A fact, with a name of one word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fact {
    /// The subject of the fact.
    pub name: &'static str,
    /// The text of the fact.
    pub text: String,
}

impl<'a> Section<'a> {
    /// A section of `f` in 1/sr, without further facts.
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

/// The part of the data that the file itself marks as not measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gaps {
    /// The number that is missing.
    pub missing: usize,
    /// The number if nothing were missing.
    pub all: usize,
    /// The unit that is counted, such as `bins`.
    pub of: &'static str,
    /// `true` if evaluation treats them as gaps; a mask that no program uses is only mentioned.
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
    /// The number of channels of a value.
    pub channels: usize,
    /// The azimuths of the viewer cover half a turn on purpose.
    pub is_mirrored: bool,
    /// The angles of the viewer are about the mirror direction.
    pub is_specular: bool,
}

/// The kinks of interpolated values, for integrals over the hemisphere: angles about an axis in the plane of incidence.
#[derive(Clone, Debug, PartialEq)]
pub struct Kinks {
    /// The polar angle of the axis, on the other side of the normal from the light; 0 is the normal.
    pub zenith: f64,
    /// Polar angles about the axis, ascending.
    pub thetas: Vec<f64>,
    /// Azimuths about the axis, counted from the light, ascending.
    pub phis: Vec<f64>,
}

/// Knots that were degrees in a file are within this of the pole or the full turn, in radians.
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
