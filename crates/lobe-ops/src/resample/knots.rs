//! Knots that keep the interpolation error under a bound.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe_table::{GridError, specular};

use super::error::LOWEST;
use super::{error, measure};
use crate::samples::{directions, nodes};
use crate::{Aspect, OnBackend};

/// The bound on the interpolation error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// Relative to the largest value of the material; or to each value, but at least to a thousandth of the largest.
    pub error: f64,
    /// `true` if the error is relative to each value.
    pub per_value: bool,
    /// The polar angle of both directions up to which the bound applies, in radians, because values, and the largest
    /// with them, grow toward the horizon.
    pub limit: f64,
    /// If no choice of knots meets the bound, slightly more than the smallest possible error is allowed instead.
    pub is_aim: bool,
}

/// A table with chosen knots.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// The table.
    pub samples: specular::Data,
    /// The error at directions that had no part in the choice, measured as in the bound.
    pub error: f64,
    /// The error if all knots are kept: any bound of at least this can be met.
    pub least: f64,
}

/// The knots of one axis, in radians.
#[derive(Clone, Debug, PartialEq)]
pub enum Knots {
    /// All of these knots.
    Keep(Vec<f64>),
    /// As few of these knots as the bound allows, including the first and the last.
    Choose(Vec<f64>),
}

impl Knots {
    fn all(&self) -> &[f64] {
        match self {
            Knots::Keep(knots) | Knots::Choose(knots) => knots,
        }
    }
}

/// The factor by which the error may exceed the smallest possible one, if the bound is an aim that cannot be met.
const SLACK: f64 = 1.2;
/// The most channels that are probed.
const CHANNELS: usize = 4;
/// In a bound on each value, values below this share of the largest count as that share.
const FLOOR: f64 = 1e-3;
/// The distance beyond the limit, in radians, in which nodes have to be exact, because values are interpolated toward
/// them: more than the longest step between candidates.
const MARGIN: f64 = 0.09;
/// The number of directions at which the result is tested.
pub const PROBES: usize = 100_000;

/// Measures a material on a dense grid, keeps the knots that linear interpolation needs, and measures again there.
///
/// On each axis to choose, the knot with the largest error is added until the error there is within its share of the
/// bound. The multilinear interpolant is no further from the material than the sum of the errors of the axes, so equal
/// shares are enough; larger shares are tried first, because the largest errors seldom coincide, and finally all knots
/// are kept. `progress` is called with the finished share.
///
/// The result misses the bound if [`Chosen::least`] does: no knots can be added between the candidates, and a
/// discontinuous material, such as a Klems matrix, cannot be interpolated to any bound. All knots are then kept, unless
/// the bound is an aim.
///
/// # Errors
/// The same as for [`measure`].
pub fn choose<'a>(
    scattering: impl Into<OnBackend<'a>>,
    aspect: Aspect,
    axes: &[Knots; 4],
    bound: Bound,
    progress: impl Fn(f64),
) -> Result<Chosen, GridError> {
    let scattering = scattering.into();
    let free = axes.iter().filter(|axis| matches!(axis, Knots::Choose(knots) if knots.len() > 1)).count().max(1);
    let all = axes.each_ref().map(|axis| axis.all().to_vec());
    let dense = measure(scattering, aspect, all, |done| progress(0.6 * done))?;
    // A table that is too large to be evaluated is worse than any other.
    let error_of = |samples: &specular::Data| {
        error(scattering, aspect, samples, bound.limit, PROBES).map_or(f64::INFINITY, |found| {
            if bound.per_value { found.relative_to_value } else { found.relative_to_peak }
        })
    };
    let least = error_of(&dense);
    progress(0.7);
    let is_possible = least <= bound.error;
    let is_fixed = axes.iter().all(|axis| matches!(axis, Knots::Keep(_)));
    if is_fixed || !(is_possible || bound.is_aim) {
        progress(1.0);
        return Ok(Chosen { samples: dense, error: least, least });
    }
    let allowed = if is_possible { bound.error } else { SLACK * least };
    let grid = Grid::new(&dense, bound);
    // First as if the errors of the axes did not add up, then as if they did, then with a margin.
    for (step, share) in [1.0, 0.5, 1.0 / free as f64, 0.5 / free as f64].into_iter().enumerate() {
        let knots = std::array::from_fn(|axis| match &axes[axis] {
            Knots::Keep(knots) => knots.clone(),
            Knots::Choose(_) => grid.thin(axis, share * allowed),
        });
        let samples = measure(scattering, aspect, knots, |_| {})?;
        let found = error_of(&samples);
        progress(0.7 + 0.075 * (step + 1) as f64);
        if found <= allowed {
            return Ok(Chosen { samples, error: found, least });
        }
    }
    Ok(Chosen { samples: dense, error: least, least })
}

/// Candidates for the knots of an unknown material, a million nodes: those of sigma are densest at grazing light, where
/// values grow without bound, and those of theta at the mirror direction, where the first step is a ten-thousandth of a
/// degree. An isotropic material has one knot of psi, and more of the others.
pub fn candidates(is_isotropic: bool) -> [Vec<f64>; 4] {
    let [sigmas, psis, thetas, phis] = if is_isotropic { [61, 1, 161, 73] } else { [25, 25, 61, 31] };
    let steps = |count: usize| (0..count).map(move |index| index as f64 / (count - 1).max(1) as f64);
    [
        steps(sigmas).map(|x| FRAC_PI_2 * (1.0 - (1.0 - x).powi(2))).collect(),
        steps(psis).map(|x| TAU * x).collect(),
        steps(thetas).map(|x| PI * x.powi(3)).collect(),
        steps(phis).map(|x| TAU * x).collect(),
    ]
}

/// The values of a material at dense knots.
struct Grid {
    knots: [Vec<f64>; 4],
    /// `[node][channel]`, each divided by the unit of its error.
    values: Vec<f64>,
    /// The units of errors, in the layout of the values.
    scales: Vec<f64>,
    /// One per node: whether an error there matters.
    counts: Vec<bool>,
    channels: usize,
}

impl Grid {
    fn new(samples: &specular::Data, bound: Bound) -> Self {
        let all = samples.channels().count();
        let chosen: Vec<usize> =
            (0..all.min(CHANNELS)).map(|i| i * (all - 1) / (all.min(CHANNELS) - 1).max(1)).collect();
        let texels = samples.values().chunks_exact(all);
        let values: Vec<f64> = texels.flat_map(|texel| chosen.iter().map(|&c| f64::from(texel[c]))).collect();
        let limit = bound.limit.min(LOWEST.acos());
        let is_within = |limit: f64| {
            move |node| {
                let (wi, wo) = directions(samples, node);
                wi[2].min(wo[2]) >= limit.cos()
            }
        };
        let counted = nodes(samples).zip(values.chunks_exact(chosen.len())).filter(|(node, _)| is_within(limit)(*node));
        let peak = counted.flat_map(|(_, texel)| texel).copied().fold(f64::MIN_POSITIVE, f64::max);
        let counts = nodes(samples).map(is_within(limit + MARGIN)).collect();
        let scale = |value: &f64| if bound.per_value { value.abs().max(FLOOR * peak) } else { peak };
        Grid {
            knots: samples.knots().clone(),
            scales: values.iter().map(scale).collect(),
            values,
            counts,
            channels: chosen.len(),
        }
    }

    /// The knots of an axis such that no other knot deviates from the lines between them by more than `error`.
    fn thin(&self, axis: usize, error: f64) -> Vec<f64> {
        let knots = &self.knots[axis];
        if knots.len() < 3 {
            return knots.clone();
        }
        let last = knots.len() - 1;
        let mut kept = vec![0, last];
        let mut open = vec![(0, last)];
        while let Some((a, b)) = open.pop() {
            let worst = (a + 1..b).map(|k| (k, self.error(axis, a, k, b))).max_by(|x, y| x.1.total_cmp(&y.1));
            if let Some((k, _)) = worst.filter(|(_, worst)| *worst > error) {
                kept.push(k);
                open.extend([(a, k), (k, b)]);
            }
        }
        kept.sort_unstable();
        kept.dedup();
        kept.into_iter().map(|k| knots[k]).collect()
    }

    /// The largest distance of the values at knot `k` of an axis from the line between knots `a` and `b`, in units of
    /// the bound.
    fn error(&self, axis: usize, a: usize, k: usize, b: usize) -> f64 {
        let knots = &self.knots[axis];
        let t = (knots[k] - knots[a]) / (knots[b] - knots[a]);
        let inner: usize = self.knots[axis + 1..].iter().map(Vec::len).product();
        let outer: usize = self.knots[..axis].iter().map(Vec::len).product();
        let mut largest = 0.0_f64;
        for first in 0..outer {
            let row = |knot: usize| (first * knots.len() + knot) * inner;
            let (at_a, at_k, at_b) = (row(a), row(k), row(b));
            for i in (0..inner).filter(|i| self.counts[at_k + i]) {
                for c in 0..self.channels {
                    let value = |at: usize| self.values[(at + i) * self.channels + c];
                    let line = (1.0 - t) * value(at_a) + t * value(at_b);
                    let difference = (line - value(at_k)).abs() / self.scales[(at_k + i) * self.channels + c];
                    largest = largest.max(difference);
                }
            }
        }
        largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Exact, Mono, gold};

    const LIMIT: f64 = 1.4;

    fn isotropic() -> [Knots; 4] {
        candidates(true).map(Knots::Choose)
    }

    #[test]
    fn the_bound_holds_and_a_smaller_one_takes_more_knots() {
        let material = Exact(gold(0.4));
        let nodes = [0.05, 0.01].map(|bound| {
            let bound = Bound { error: bound, per_value: false, limit: LIMIT, is_aim: false };
            let chosen = choose(&material, Aspect::REFLECTION, &isotropic(), bound, |_| {}).expect("a table");
            assert!(chosen.error <= bound.error, "{} is over {}", chosen.error, bound.error);
            // Directions that had no part in the choice.
            let found = error(&material, Aspect::REFLECTION, &chosen.samples, LIMIT, 300_000).expect("a table");
            assert!(found.relative_to_peak <= 1.5 * bound.error, "{found:?}");
            chosen.samples.values().len()
        });
        assert!(nodes[0] < nodes[1], "{nodes:?}");
    }

    #[test]
    fn linear_values_need_no_inner_knots() {
        let flat = Mono(|_, _| 0.25);
        let bound = Bound { error: 1e-4, per_value: true, limit: LIMIT, is_aim: false };
        let chosen = choose(&flat, Aspect::REFLECTION, &isotropic(), bound, |_| {}).expect("a table");
        assert_eq!(chosen.samples.knots().each_ref().map(Vec::len), [2, 1, 2, 2]);
    }

    #[test]
    fn given_knots_are_kept() {
        let [.., thetas, _] = isotropic();
        let fixed =
            [Knots::Keep(vec![0.0, 0.5, 1.0]), Knots::Keep(vec![0.0]), thetas, Knots::Keep(vec![0.0, 1.0, 2.0])];
        let bound = Bound { error: 0.05, per_value: false, limit: LIMIT, is_aim: false };
        let chosen = choose(&Exact(gold(0.4)), Aspect::REFLECTION, &fixed, bound, |_| {}).expect("a table");
        assert_eq!(
            (&chosen.samples.knots()[0], &chosen.samples.knots()[3]),
            (&vec![0.0, 0.5, 1.0], &vec![0.0, 1.0, 2.0])
        );
        // Three azimuths are not enough, which is reported.
        assert!(chosen.error > 0.05, "{}", chosen.error);
    }

    #[test]
    fn a_discontinuity_misses_the_bound_and_is_reported() {
        let jump = Mono(|_: [f64; 3], wo: [f64; 3]| if wo[0] > 0.1 { 1.0 } else { 0.0 });
        let bound = Bound { error: 0.01, per_value: false, limit: LIMIT, is_aim: false };
        let chosen = choose(&jump, Aspect::REFLECTION, &isotropic(), bound, |_| {}).expect("a table");
        assert!(chosen.error > 0.3 && chosen.error == chosen.least, "{} {}", chosen.error, chosen.least);
        // As an aim, it is replaced by a possible error, which fewer knots also reach.
        let aim = choose(&jump, Aspect::REFLECTION, &isotropic(), Bound { is_aim: true, ..bound }, |_| {});
        let aim = aim.expect("a table");
        assert!(aim.error <= SLACK * aim.least && aim.least == chosen.least, "{} {}", aim.error, aim.least);
        assert!(aim.samples.values().len() <= chosen.samples.values().len());
    }

    #[test]
    fn the_smallest_error_is_a_bound_that_succeeds() {
        let material = Exact(gold(0.1));
        let tight = Bound { error: 1e-6, per_value: false, limit: LIMIT, is_aim: false };
        let least = choose(&material, Aspect::REFLECTION, &isotropic(), tight, |_| {}).expect("a table").least;
        assert!(least > tight.error);
        for error in [least, 1.5 * least] {
            let bound = Bound { error, ..tight };
            let chosen = choose(&material, Aspect::REFLECTION, &isotropic(), bound, |_| {}).expect("a table");
            assert!(chosen.error <= error, "{} {error}", chosen.error);
        }
    }
}
