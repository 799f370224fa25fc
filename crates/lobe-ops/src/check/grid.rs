//! Checks of grids of four angles, of any meaning, at their knots and poles.

use std::f64::consts::FRAC_PI_2;
use std::ops::Deref;

use super::finding::{Finding, Status, degrees, percent};

/// A grid whose knots and poles are checked.
pub(super) struct Grid<'a>(pub(super) lobe_table::data::Grid<'a>);

impl<'a> Deref for Grid<'a> {
    type Target = lobe_table::data::Grid<'a>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

/// At the pole, all azimuths are one direction: a difference of this share of the values there is more than rounding.
const SAME: f64 = 1e-3;
/// A difference of this share is more than noise.
const APART: f64 = 0.05;

/// The difference between texels that should be equal.
struct Spread {
    /// The largest difference, relative to the largest of the texels.
    difference: f64,
    /// The index of the group in which it is.
    group: usize,
}

impl<'a> Grid<'a> {
    /// The channels at a node.
    pub(super) fn texel(&self, node: [usize; 4]) -> &'a [f32] {
        let at = node.into_iter().zip(self.knots).fold(0, |at, (index, knots)| at * knots.len() + index);
        &self.values[at * self.channels..][..self.channels]
    }

    /// The polar angle of the light in degrees, if it is the only one; `None` also if there is only one value for all
    /// directions, which is a statement about all angles.
    pub(super) fn only_light(&self) -> Option<String> {
        let [light, _, viewer, azimuths] = self.knots.each_ref().map(Vec::len);
        (light == 1 && (viewer > 1 || azimuths > 1)).then(|| degrees(self.knots[0][0]))
    }

    /// Every pair of knots of the light.
    pub(super) fn lights(&self) -> impl Iterator<Item = [usize; 2]> + use<'_> {
        (0..self.knots[0].len()).flat_map(|polar| (0..self.knots[1].len()).map(move |azimuth| [polar, azimuth]))
    }

    /// Reports the knots, which ascend because readers refuse others, and whether they reach far enough.
    pub(super) fn check_knots(&self, part: &str) -> Vec<Finding> {
        let counts = self.knots.each_ref().map(Vec::len);
        let each: Vec<String> =
            self.names.iter().zip(counts).filter(|(_, n)| *n > 1).map(|(name, n)| format!("{n} of {name}")).collect();
        let text = format!("ascending: {}", if each.is_empty() { "one of each axis".into() } else { each.join(", ") });
        let mut findings = vec![Finding::new("knots", part, Status::Pass, text)];

        let [light, .., viewer, _] = self.knots;
        let (first, last) = (light[0], light[light.len() - 1]);
        if last < FRAC_PI_2 - 0.01 || first > 0.01 {
            let (status, text) = match self.only_light() {
                Some(theta) => (
                    Status::Warn,
                    format!(
                        "light at only one polar angle, {theta} degrees, which is used for all others. One angle of incidence says nothing about the others"
                    ),
                ),
                None => (
                    Status::Note,
                    format!(
                        "light was measured only from {} to {} degrees; beyond, the nearest measurement is used",
                        degrees(first),
                        degrees(last)
                    ),
                ),
            };
            let finding = Finding::new("coverage", part, status, text);
            findings.push(finding.number("first", first.to_degrees()).number("last", last.to_degrees()));
        }
        let reach = viewer[viewer.len() - 1];
        // For grazing light, the opposite horizon is nearly half a turn from the mirror direction.
        let needed = if self.is_specular { FRAC_PI_2 + last } else { FRAC_PI_2 };
        if reach < needed - 0.05 {
            let text = format!(
                "{} ends at {} degrees, and the hemisphere at {}; beyond, the last value is used",
                self.names[2],
                degrees(reach),
                degrees(needed)
            );
            let finding = Finding::new("coverage", part, Status::Note, text);
            findings.push(finding.number("reach", reach.to_degrees()).number("needed", needed.to_degrees()));
        }
        findings
    }

    /// `true` if the pole of the viewer, and that of the light, have one value at all azimuths.
    pub(super) fn check_pole(&self, part: &str) -> Vec<Finding> {
        let mut findings = Vec::new();
        let [light, rotations, viewer, azimuths] = self.knots.each_ref().map(Vec::len);
        if self.knots[2][0].abs() < 1e-6 && azimuths > 1 {
            let worst = self.spread(
                self.lights()
                    .map(|[polar, azimuth]| (0..azimuths).map(|phi| self.texel([polar, azimuth, 0, phi])).collect()),
            );
            findings.push(self.pole(part, self.names[2], worst));
        }
        // With the light at the normal, the rotation of the sample and the azimuth of the viewer are one angle.
        if self.knots[0][0].abs() < 1e-6 && light > 0 && rotations > 1 && self.knots[2][0].abs() < 1e-6 && viewer > 0 {
            let at_zenith = (0..rotations).map(|azimuth| self.texel([0, azimuth, 0, 0])).collect();
            let worst = self.spread(std::iter::once(at_zenith));
            findings.push(self.pole(part, self.names[0], worst));
        }
        findings
    }

    fn pole(&self, part: &str, axis: &str, Spread { difference: worst, group: place }: Spread) -> Finding {
        let (status, text) = match worst {
            worst if worst <= SAME => (Status::Pass, format!("one value at {axis} 0, for all azimuths")),
            worst => {
                let status = if worst <= APART { Status::Note } else { Status::Warn };
                let light = degrees(self.knots[0][place / self.knots[1].len().max(1)]);
                let at = if axis == self.names[0] { String::new() } else { format!(" for light at {light} degrees") };
                let part = percent(worst);
                (
                    status,
                    format!(
                        "at {axis} 0, which is one direction, values at different azimuths differ by {part} of the largest{at}"
                    ),
                )
            }
        };
        Finding::new("pole", part, status, text).number("difference", worst)
    }

    /// The largest difference among groups of texels that should be equal.
    fn spread(&self, groups: impl Iterator<Item = Vec<&'a [f32]>>) -> Spread {
        let of_group = |texels: Vec<&[f32]>| {
            let of_channel = |channel: usize| {
                let values = texels.iter().map(|texel| f64::from(texel[channel]));
                let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
                let size = low.abs().max(high.abs());
                if size > 0.0 { (high - low) / size } else { 0.0 }
            };
            (0..self.channels).map(of_channel).fold(0.0, f64::max)
        };
        let each = groups.map(of_group).enumerate();
        let start = Spread { difference: 0.0, group: 0 };
        each.fold(start, |worst, (group, difference)| match difference > worst.difference {
            true => Spread { difference, group },
            false => worst,
        })
    }
}
