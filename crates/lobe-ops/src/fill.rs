//! Filling in values for unmeasured directions.

use lobe_table::{GridError, specular};

use crate::samples::{closes_circle, position, with_values};

/// The extrapolation beyond the last measured value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Beyond {
    /// The nearest measured value.
    #[default]
    Nearest,
    /// The line through the two nearest measured values, not below 0.
    Linear,
}

/// A table without gaps.
#[derive(Clone, Debug, PartialEq)]
pub struct Filled {
    /// The table.
    pub samples: specular::Data,
    /// The nodes that were filled, in the order of the values, `[sigma][psi][theta][phi]`.
    pub mask: Vec<bool>,
}

/// The nodes that look as if nothing was measured there: all channels are exactly 0.
///
/// Files have no better way to express it, and a measured value is seldom exactly 0.
pub fn zeros(samples: &specular::Data) -> Vec<bool> {
    missing(samples, |texel| texel.iter().all(|&value| value == 0.0))
}

/// The nodes with a negative value in any channel: noise around a subtracted dark level.
pub fn negatives(samples: &specular::Data) -> Vec<bool> {
    missing(samples, |texel| texel.iter().any(|&value| value < 0.0))
}

fn missing(samples: &specular::Data, is_missing: impl Fn(&[f32]) -> bool) -> Vec<bool> {
    samples.values().chunks_exact(samples.channels().count()).map(is_missing).collect()
}

/// Fills the nodes that `mask` marks, which has one element per node in the order of the values.
///
/// Gaps between measured nodes of a row of theta are interpolated linearly, and rows that end early are continued as
/// `beyond` says. Rows in which nothing was measured are then filled along phi in the same way, around the circle; then
/// along psi; then along sigma. A table in which nothing was measured is unchanged, and its mask is empty.
///
/// # Panics
/// If `mask` does not have one element per node.
///
/// # Errors
/// If a continued value is too large for `f32`.
pub fn fill(samples: &specular::Data, mask: &[bool], beyond: Beyond) -> Result<Filled, GridError> {
    let counts = samples.knots().each_ref().map(Vec::len);
    let channels = samples.channels().count();
    assert_eq!(mask.len(), counts.iter().product::<usize>(), "one element per node");
    let mut values = samples.values().to_vec();
    let mut is_known: Vec<bool> = mask.iter().map(|missing| !missing).collect();
    if !is_known.contains(&true) {
        return Ok(Filled { samples: samples.clone(), mask: vec![false; mask.len()] });
    }
    for axis in [2, 3, 1, 0] {
        let knots = &samples.knots()[axis];
        let is_circle = axis == 1 || axis == 3;
        let turn = is_circle && !closes_circle(knots);
        let stride = position(counts, std::array::from_fn(|other| usize::from(other == axis))).max(1);
        let starts = (0..mask.len()).filter(|index| (index / stride).is_multiple_of(counts[axis]));
        for start in starts.collect::<Vec<_>>() {
            let row: Vec<usize> = (0..counts[axis]).map(|step| start + step * stride).collect();
            let known: Vec<usize> = (0..row.len()).filter(|&step| is_known[row[step]]).collect();
            if known.is_empty() || known.len() == row.len() {
                continue;
            }
            for step in (0..row.len()).filter(|step| !known.contains(step)).collect::<Vec<_>>() {
                let [(a, share_a), (b, share_b)] = sources(knots, &known, step, turn, beyond);
                for channel in 0..channels {
                    let value = |step: usize| f64::from(values[row[step] * channels + channel]);
                    let filled = share_a * value(a) + share_b * value(b);
                    // A line through falling values must not lead below 0.
                    let is_line = share_a < 0.0 || share_b < 0.0;
                    values[row[step] * channels + channel] = if is_line { filled.max(0.0) } else { filled } as f32;
                }
            }
            row.iter().for_each(|&index| is_known[index] = true);
        }
    }
    Ok(Filled { samples: with_values(samples, values)?, mask: mask.to_vec() })
}

/// The two known steps from which a step of a row is filled, and their weights.
fn sources(knots: &[f64], known: &[usize], step: usize, turn: bool, beyond: Beyond) -> [(usize, f64); 2] {
    use std::f64::consts::TAU;
    let (first, last) = (known[0], known[known.len() - 1]);
    let upper = known.partition_point(|&other| other < step);
    let line = |a: usize, at_a: f64, b: usize, at_b: f64| {
        let t = (knots[step] - at_a) / (at_b - at_a);
        [(a, 1.0 - t), (b, t)]
    };
    match upper {
        _ if upper > 0 && upper < known.len() => {
            let (a, b) = (known[upper - 1], known[upper]);
            line(a, knots[a], b, knots[b])
        }
        0 if turn => line(last, knots[last] - TAU, first, knots[first]),
        _ if turn => line(last, knots[last], first, knots[first] + TAU),
        _ if beyond == Beyond::Nearest || known.len() < 2 => {
            [(if upper == 0 { first } else { last }, 1.0), (first, 0.0)]
        }
        0 => line(known[0], knots[known[0]], known[1], knots[known[1]]),
        _ => {
            let (a, b) = (known[known.len() - 2], last);
            line(a, knots[a], b, knots[b])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::degrees;
    use lobe_table::{Channels, Scatter};

    /// `f = 1 + theta + 2 sigma` in degrees, over the full circle of phi without its end.
    fn ramp() -> specular::Data {
        let knots =
            [&[0.0, 30.0, 60.0][..], &[0.0], &[0.0, 10.0, 20.0, 40.0, 80.0], &[0.0, 90.0, 180.0, 270.0]].map(degrees);
        let mut values = Vec::new();
        for sigma in [0.0, 30.0, 60.0] {
            for theta in [0.0, 10.0, 20.0, 40.0, 80.0] {
                values.extend([1.0 + theta + 2.0 * sigma; 4]);
            }
        }
        specular::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a table")
    }

    fn without(samples: &specular::Data, is_missing: impl Fn([usize; 4]) -> bool) -> (specular::Data, Vec<bool>) {
        let mask: Vec<bool> = crate::samples::nodes(samples).map(is_missing).collect();
        let values = samples.values().iter().zip(&mask).map(|(&v, &missing)| if missing { 0.0 } else { v }).collect();
        (with_values(samples, values).expect("a table"), mask)
    }

    fn assert_same(found: &specular::Data, expected: &specular::Data) {
        for (at, (x, expected)) in found.values().iter().zip(expected.values()).enumerate() {
            assert!((x - expected).abs() < 1e-3, "{x} is not {expected} at {at}");
        }
    }

    #[test]
    fn a_plane_is_restored() {
        // A gap, two ends of rows, and a row of theta that was not measured at all.
        let (holed, mask) = without(&ramp(), |[s, _, t, h]| (s, t) == (0, 2) || (s == 1 && t >= 3) || (s, h) == (2, 1));
        assert_eq!(zeros(&holed), mask);
        let filled = fill(&holed, &mask, Beyond::Linear).expect("a table");
        assert_same(&filled.samples, &ramp());
        assert_eq!(filled.mask, mask);
    }

    #[test]
    fn the_nearest_value_is_continued() {
        let (holed, mask) = without(&ramp(), |[_, _, t, _]| t >= 3);
        let filled = fill(&holed, &mask, Beyond::Nearest).expect("a table");
        assert_eq!(filled.samples.texel([1, 0, 4, 2]), ramp().texel([1, 0, 2, 2]));
        // Measured values stay to the last bit.
        assert_eq!(filled.samples.texel([1, 0, 1, 2]), ramp().texel([1, 0, 1, 2]));
    }

    #[test]
    fn a_missing_incidence_is_filled_from_its_neighbours() {
        let (holed, mask) = without(&ramp(), |[s, ..]| s == 1);
        assert_same(&fill(&holed, &mask, Beyond::Nearest).expect("a table").samples, &ramp());
    }

    #[test]
    fn extrapolation_does_not_go_below_zero() {
        let knots = [vec![0.0], vec![0.0], degrees(&[0.0, 10.0, 40.0]), vec![0.0]];
        let samples =
            specular::Data::new(Scatter::Reflection, knots, Channels::Mono, vec![2.0, 1.0, 0.0]).expect("a table");
        let filled = fill(&samples, &zeros(&samples), Beyond::Linear).expect("a table");
        assert_eq!(filled.samples.values(), [2.0, 1.0, 0.0]);
    }

    #[test]
    fn negative_values_are_found_and_empty_tables_stay_empty() {
        let knots = || [vec![0.0], vec![0.0], degrees(&[0.0, 10.0]), vec![0.0]];
        let table =
            |values| specular::Data::new(Scatter::Reflection, knots(), Channels::Mono, values).expect("a table");
        assert_eq!(negatives(&table(vec![-1.0, 0.0])), [true, false]);
        let dark = table(vec![0.0, 0.0]);
        let filled = fill(&dark, &zeros(&dark), Beyond::Linear).expect("a table");
        assert_eq!((filled.samples, filled.mask), (dark, vec![false, false]));
    }
}
