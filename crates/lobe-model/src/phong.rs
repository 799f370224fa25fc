//! The cosine lobe about the mirror direction.

use std::f64::consts::TAU;

use crate::Model;
use crate::vec3::{dot, reflect};

/// The lobe of B. T. Phong, *Illumination for computer generated pictures*, CACM 18(6), 1975, in the reciprocal and
/// energy conserving form of E. P. Lafortune and Y. D. Willems, *Using the modified Phong reflectance model for
/// physically based rendering*, 1994: `f = specular (n + 2) / (2 pi) cos^n(angle between wo and the mirror direction)`.
///
/// The whole lobe is above the surface only for light from the zenith, of which it reflects exactly `specular`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// Reflectance at the zenith, per channel, in `[0, 1]`.
    pub specular: [f64; 3],
    /// The exponent `n`, not negative.
    pub exponent: f64,
}

impl Model for Phong {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return [0.0; 3];
        }
        let cos = dot(reflect(wi, [0.0, 0.0, 1.0]), wo).max(0.0);
        let lobe = (self.exponent + 2.0) / TAU * cos.powf(self.exponent);
        self.specular.map(|s| s * lobe)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{albedo, model::testing::*, vec3::spherical};

    #[test]
    fn normalised_at_the_zenith_and_never_above() {
        for exponent in [0.0, 1.0, 10.0, 50.0] {
            let model = Phong { specular: [1.0; 3], exponent };
            let zenith = albedo(&model, [0.0, 0.0, 1.0], 200)[0];
            assert!((zenith - 1.0).abs() < 1e-3, "{zenith} with exponent {exponent}");
            for theta in [0.5, 1.0, 1.5] {
                assert!(albedo(&model, spherical(theta, 0.4), 200)[0] <= 1.0 + 1e-3);
            }
        }
    }

    #[test]
    fn peaks_at_the_mirror_direction() {
        let model = Phong { specular: [1.0, 0.5, 0.25], exponent: 30.0 };
        let peak = model.f(spherical(0.6, 0.0), spherical(0.6, TAU / 2.0));
        for (x, s) in peak.into_iter().zip(model.specular) {
            assert!((x - s * 32.0 / TAU).abs() < 1e-12);
        }
        assert_reciprocal(&model);
        assert_dark_below(&model);
    }
}
