//! Circles of azimuths: whether they close, their gaps, and whether both sides are alike.

use std::f64::consts::{PI, TAU};

use super::finding::{Finding, Status, degrees, percent};
use super::grid::Grid;
use crate::samples::closes_circle;

/// At the seam, a difference of this share of the largest value is more than rounding.
const SAME: f64 = 1e-3;
/// A gap as wide as this, 45 degrees, is more than one step of a circle.
const WIDE: f64 = PI / 4.0 + 1e-3;

pub(super) fn check(grid: &Grid<'_>, part: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    for axis in [1, 3] {
        let knots = &grid.knots[axis];
        if knots.len() < 2 || axis == 3 && grid.is_mirrored && !is_in_plane(grid) {
            continue;
        }
        findings.push(if closes_circle(knots) { seam(grid, part, axis) } else { gap(grid, part, axis) });
    }
    let is_isotropic = grid.knots[1].len() == 1;
    if grid.knots[3].len() == 1 {
        let what = if grid.is_specular { "the mirror direction" } else { "the normal" };
        let text = format!("one {} only: the same all around {what}", grid.names[3]);
        findings.push(Finding::new("symmetry", part, Status::Note, text));
    } else if is_isotropic && !grid.is_mirrored {
        findings.extend(mirror(grid, part));
    }
    findings
}

/// The first and the last azimuth are the same, and so should be their values.
fn seam(grid: &Grid<'_>, part: &str, axis: usize) -> Finding {
    let last = grid.knots[axis].len() - 1;
    let Apart { largest: difference, .. } = pairs(grid, axis, |_| 0, |index| (index == last).then_some(last));
    let name = grid.names[axis];
    let (status, text) = match difference {
        d if d <= SAME => (Status::Pass, format!("{name} closes at 360 degrees with the values of 0")),
        d => {
            let text =
                format!("the values at {name} 0 and 360, which are one angle, differ by {} of the largest", percent(d));
            (Status::Warn, text)
        }
    };
    Finding::new("azimuth seam", part, status, text).number("difference", difference)
}

/// `true` if the only azimuths of the viewer are those of the plane of incidence.
pub(super) fn is_in_plane(grid: &Grid<'_>) -> bool {
    let knots = &grid.knots[3];
    knots.len() == 2 && (knots[1] - knots[0] - PI).abs() < 0.01
}

fn gap(grid: &Grid<'_>, part: &str, axis: usize) -> Finding {
    let (knots, name) = (&grid.knots[axis], grid.names[axis]);
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let gap = TAU - (last - first);
    let step = knots.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let (status, text) = if axis == 3 && is_in_plane(grid) {
        let text = format!(
            "{name} has only {} and {} degrees: measured in the plane of incidence, guessed everywhere else",
            degrees(first),
            degrees(last)
        );
        (Status::Warn, text)
    } else if gap > WIDE.max(1.5 * step) {
        let text = format!(
            "{name} runs from {} to {} degrees; the gap of {} degrees is closed by linear interpolation",
            degrees(first),
            degrees(last),
            degrees(gap)
        );
        (Status::Warn, text)
    } else {
        (Status::Pass, format!("{name} ends one step, {} degrees, short of the circle and closes", degrees(gap)))
    };
    Finding::new("azimuth seam", part, status, text).number("gap", gap.to_degrees())
}

/// An isotropic material is the same on both sides of the plane of incidence.
fn mirror(grid: &Grid<'_>, part: &str) -> Option<Finding> {
    let phis = &grid.knots[3];
    let around = |angle: f64| angle.rem_euclid(TAU);
    let twin = |index: usize| {
        let wanted = around(-phis[index]);
        let distance = |other: f64| (around(other) - wanted).abs().min(TAU - (around(other) - wanted).abs());
        (0..phis.len()).find(|&other| distance(phis[other]) < 1e-4)
    };
    let with_twin = (0..phis.len()).filter(|&index| twin(index).is_some_and(|other| other != index)).count();
    if with_twin < 2 {
        return None;
    }
    let Apart { largest: difference, mean } = pairs(grid, 3, |index| index, twin);
    let (status, text) = match difference {
        d if d <= SAME => (Status::Pass, "both sides of the plane of incidence are alike".into()),
        d => {
            let text = format!(
                "both sides of the plane of incidence differ, by up to {} of the largest value and by {} on average",
                percent(d),
                percent(mean)
            );
            (if mean > 0.05 { Status::Warn } else { Status::Note }, text)
        }
    };
    Some(Finding::new("symmetry", part, status, text).number("difference", difference).number("mean", mean))
}

/// The differences between values at pairs of azimuths.
struct Apart {
    /// The largest difference, relative to the largest value of the grid.
    largest: f64,
    /// The mean difference, relative to the mean value.
    mean: f64,
}

/// The differences between the values at azimuths of an axis and those at their partners.
fn pairs(grid: &Grid<'_>, axis: usize, one: impl Fn(usize) -> usize, other: impl Fn(usize) -> Option<usize>) -> Apart {
    let counts = grid.knots.each_ref().map(Vec::len);
    let (mut worst, mut sum, mut values) = (0.0_f64, 0.0, 0.0);
    for index in 0..counts.iter().product() {
        let node = crate::samples::node(counts, index);
        let Some(partner) = other(node[axis]) else { continue };
        let at = |azimuth: usize| grid.texel(std::array::from_fn(|i| if i == axis { azimuth } else { node[i] }));
        for (a, b) in at(one(node[axis])).iter().zip(at(partner)) {
            let difference = f64::from(a - b).abs();
            worst = worst.max(difference);
            sum += difference;
            values += f64::from(*a).abs();
        }
    }
    let peak = grid.values.iter().map(|value| f64::from(value.abs())).fold(0.0, f64::max);
    Apart { largest: if peak > 0.0 { worst / peak } else { 0.0 }, mean: if values > 0.0 { sum / values } else { 0.0 } }
}
