//! Helmholtz reciprocity: exchanging light and viewer does not change the value.

use serde::Serialize;

use crate::directions::pairs;
use crate::pairs::eval_pairs;
use crate::{Aspect, OnBackend};

/// The difference between `f(wi, wo)` and `f(wo, wi)`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reciprocity {
    /// The number of pairs of directions that were exchanged.
    pub pairs: usize,
    /// The largest difference, in 1/sr.
    pub max: f64,
    /// The root of the mean squared difference, in 1/sr.
    pub rms: f64,
    /// `rms` relative to the root of the mean squared value.
    pub relative_rms: f64,
    /// The median difference, relative to the mean of the two values.
    pub relative_median: f64,
    /// The directions of the largest difference: `wi` and `wo`, with z > 0.
    pub worst: [[f64; 3]; 2],
}

/// The most values that are compared: with a thousand channels or more, fewer pairs are enough.
const VALUES: usize = 1 << 24;

/// Exchanges up to `count` pairs of directions, with polar angles up to `limit` in radians: the same pairs at every
/// call, half of them near the mirror direction. Differences are over all channels.
///
/// Transmission is compared with transmission in the opposite direction. If a file has only one direction, both are the
/// same data, and the result is meaningless.
pub fn reciprocity<'a>(scattering: impl Into<OnBackend<'a>>, aspect: Aspect, limit: f64, count: usize) -> Reciprocity {
    let scattering = scattering.into();
    let pairs = pairs(count.min((VALUES / scattering.channels().count()).max(100)), limit);
    let there: Vec<_> = pairs.iter().map(|&(wi, wo)| aspect.place(wi, wo)).collect();
    let back: Vec<_> = there.iter().map(|&(wi, wo)| (wo, wi)).collect();
    let channels = scattering.channels().count();
    let (there, back) = (eval_pairs(scattering, &there), eval_pairs(scattering, &back));

    let (mut max, mut worst) = (0.0, [[0.0, 0.0, 1.0]; 2]);
    let (mut squares, mut values) = (0.0, 0.0);
    let mut relative = Vec::with_capacity(there.len());
    for (index, (&a, &b)) in there.iter().zip(&back).enumerate() {
        let (difference, mean) = (f64::from(a - b).abs(), 0.5 * (f64::from(a) + f64::from(b)));
        squares += difference * difference;
        values += mean * mean;
        if mean != 0.0 {
            relative.push(difference / mean.abs());
        }
        if difference > max {
            let (wi, wo) = pairs[index / channels];
            (max, worst) = (difference, [wi, wo]);
        }
    }
    relative.sort_by(f64::total_cmp);
    let part = |a: f64, b: f64| if b > 0.0 { (a / b).sqrt() } else { 0.0 };
    Reciprocity {
        pairs: pairs.len(),
        max,
        rms: part(squares, there.len() as f64),
        relative_rms: part(squares, values),
        relative_median: relative.get(relative.len() / 2).copied().unwrap_or(0.0),
        worst,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Exact, Mono, gold};

    #[test]
    fn a_model_is_reciprocal() {
        let found = reciprocity(&Exact(gold(0.3)), Aspect::REFLECTION, 1.4, 2000);
        assert!(found.pairs > 1500 && found.relative_rms < 1e-4, "{found:?}");
    }

    /// `f = a + b cos(theta_i)` differs by `b |cos(theta_i) - cos(theta_o)|` from itself exchanged.
    #[test]
    fn differences_are_measured() {
        let limit = 1.3_f64;
        let found = reciprocity(&Mono(|wi: [f64; 3], _| 1.0 + 0.5 * wi[2]), Aspect::REFLECTION, limit, 4000);
        let [wi, wo] = found.worst;
        assert!((found.max - 0.5 * (wi[2] - wo[2]).abs()).abs() < 1e-6, "{found:?}");
        assert!(found.max > 0.3 && found.max < 0.5 * (1.0 - limit.cos()), "{found:?}");
        assert!(found.rms > 0.01 && found.rms < found.max && found.relative_median < found.max, "{found:?}");
    }

    /// Transmission with a known side of the light is compared with that of the other side.
    #[test]
    fn transmission_is_compared_with_the_reverse_direction() {
        let uneven = Mono(|wi: [f64; 3], wo: [f64; 3]| match (wi[2] > 0.0, wo[2] > 0.0) {
            (true, false) => 1.0,
            (false, true) => 0.8,
            _ => 0.0,
        });
        let found = reciprocity(&uneven, Aspect::TRANSMISSION, 1.3, 500);
        assert!((found.max - 0.2).abs() < 1e-6 && (found.relative_median - 0.2 / 0.9).abs() < 1e-6, "{found:?}");
        assert_eq!(reciprocity(&uneven, Aspect::REFLECTION, 1.3, 500).max, 0.0);
    }
}
