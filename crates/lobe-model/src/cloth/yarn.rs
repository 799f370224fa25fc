//! How the side of a yarn reflects.

use std::f64::consts::{PI, TAU};

use rand::{Rng, RngExt};

use crate::vec3::{Vec3, reflect};
use crate::{Ggx, Model};

/// The surface of a yarn: dyed body and shine.
///
/// The local frame has the fibres along x. Shine is a patchwork with the body (as in [`Mix`](crate::Mix)): reciprocal,
/// and never more than all the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yarn {
    /// Diffuse reflectance of the body, per channel, in `[0, 1]`.
    pub body: [f64; 3],
    /// Reflectance of the shining facets, per channel, in `[0, 1]`.
    pub shine: [f64; 3],
    /// Share of the shining facets in the surface, in `[0, 1]`.
    pub share: f64,
    /// Roughness of the shine along and across the fibres, positive; fibres are smoother along than across.
    pub roughness: [f64; 2],
}

impl Yarn {
    /// Samples a direction in which light from `wi` continues, with its weight `f cos / pdf`. Returns `None` if the
    /// sampled direction points into the yarn.
    pub(super) fn sample(&self, wi: Vec3, rng: &mut impl Rng) -> Option<(Vec3, Vec3)> {
        let ggx = Ggx { alpha: self.roughness };
        let u: [f64; 2] = [rng.random(), rng.random()];
        let wo = if rng.random::<f64>() < self.share {
            reflect(wi, ggx.visible_normal(wi, u))
        } else {
            let (radius, (sin, cos)) = (u[0].sqrt(), (TAU * u[1]).sin_cos());
            [radius * cos, radius * sin, (1.0 - u[0]).sqrt()]
        };
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return None;
        }
        // One pdf for both ways of reaching this direction, so that neither gives rare bright samples.
        let pdf = (1.0 - self.share) * wo[2] / PI + self.share * ggx.pdf(wi, wo);
        Some((wo, self.f(wi, wo).map(|f| f * wo[2] / pdf)))
    }
}

impl Model for Yarn {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return [0.0; 3];
        }
        let mirrors = if self.share > 0.0 { self.share * Ggx { alpha: self.roughness }.mirrors(wi, wo) } else { 0.0 };
        std::array::from_fn(|c| (1.0 - self.share) * self.body[c] / PI + self.shine[c] * mirrors)
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_pcg::Pcg32;

    use super::*;
    use crate::{albedo, model::testing::*, vec3::spherical};

    #[test]
    fn samples_carry_the_albedo() {
        let yarn = Yarn { body: [0.9, 0.5, 0.1], shine: [0.5, 0.8, 1.0], share: 0.4, roughness: [0.3, 0.6] };
        let mut rng = Pcg32::seed_from_u64(5);
        for theta in [0.1, 0.9, 1.4] {
            let wi = spherical(theta, 0.8);
            let count = 100_000;
            let mut mean = [0.0; 3];
            for _ in 0..count {
                if let Some((_, share)) = yarn.sample(wi, &mut rng) {
                    mean = std::array::from_fn(|c| mean[c] + share[c] / f64::from(count));
                }
            }
            for (got, expected) in mean.into_iter().zip(albedo(&yarn, wi, 200)) {
                assert!((got - expected).abs() < 0.005, "{got} instead of {expected} at {theta}");
            }
        }
    }

    #[test]
    fn reciprocal_and_no_brighter_than_white() {
        let yarn = Yarn { body: [1.0; 3], shine: [1.0; 3], share: 0.5, roughness: [0.2, 0.6] };
        assert_reciprocal(&yarn);
        assert_dark_below(&yarn);
        for theta in [0.0, 0.8, 1.4] {
            let all = albedo(&yarn, spherical(theta, 0.4), 200)[0];
            assert!(all <= 1.0 + 2e-3, "{all} at {theta}");
        }
    }
}
