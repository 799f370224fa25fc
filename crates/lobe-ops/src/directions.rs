//! Directions at which to evaluate a material.

use std::f64::consts::{FRAC_PI_2, TAU};

use lobe_table::specular::coords::angles_to_directions;

/// The unit vector at polar angle `theta` from +z and azimuth `phi` from +x.
pub(crate) fn spherical(theta: f64, phi: f64) -> [f64; 3] {
    let ((sin, cos), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
    [sin * cos_phi, sin * sin_phi, cos]
}

/// Point `index` of a sequence that fills the unit cube of `N` dimensions evenly: multiples, modulo 1, of the powers
/// of `1 / g`, where `g^(N + 1) = g + 1` (M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
pub(crate) fn quasi_random<const N: usize>(index: usize) -> [f64; N] {
    // Each step contracts by at least 1/2, so 60 steps are exact.
    let g = (0..60).fold(1.5_f64, |g, _| (1.0 + g).powf(1.0 / (N as f64 + 1.0)));
    std::array::from_fn(|axis| (0.5 + (index as f64 + 1.0) * g.powi(-(axis as i32 + 1))).fract())
}

/// Up to `count` pairs of directions with z > 0 and polar angles up to `limit`, the same ones at every call.
///
/// Half of the `wo` are near the mirror direction, where measured materials change most. The others, and all `wi`, are
/// spread evenly over the projected hemisphere.
pub fn pairs(count: usize, limit: f64) -> Vec<([f64; 3], [f64; 3])> {
    let reach = limit.sin();
    let projected = |u: f64, v: f64| spherical((reach * u.sqrt()).clamp(0.0, 1.0).asin(), TAU * v);
    let pair = |index: usize| {
        let [a, b, c, d] = quasi_random::<4>(index);
        let sigma = (reach * a.sqrt()).clamp(0.0, 1.0).asin();
        if index.is_multiple_of(2) {
            return (projected(a, b), projected(c, d));
        }
        angles_to_directions([sigma, TAU * b, FRAC_PI_2 * c.powi(3), TAU * d], |sigma| sigma)
    };
    (0..count).map(pair).filter(|(_, wo)| wo[2] >= limit.cos()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sequence_is_even() {
        let points: Vec<[f64; 2]> = (0..4000).map(quasi_random).collect();
        let inside = |x: f64, y: f64| points.iter().filter(|p| p[0] < x && p[1] < y).count() as f64 / 4000.0;
        for (x, y) in [(0.5, 0.5), (0.1, 0.9), (0.25, 0.3)] {
            assert!((inside(x, y) - x * y).abs() < 2e-3, "{} in {x} by {y}", inside(x, y));
        }
    }

    #[test]
    fn pairs_are_unit_vectors_within_the_limit() {
        let limit = 1.2_f64;
        let pairs = pairs(1000, limit);
        assert!(pairs.len() > 700, "{}", pairs.len());
        for (wi, wo) in pairs {
            for w in [wi, wo] {
                assert!((w.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-12);
                assert!(w[2] >= limit.cos() - 1e-12, "{w:?}");
            }
        }
    }
}
