//! Rough diffuse surfaces.

use std::f64::consts::PI;

use crate::Model;

/// V-grooves with Lambertian walls: the *qualitative* model of M. Oren and S. K. Nayar, *Generalization of Lambert's
/// reflectance model*, SIGGRAPH 1994, equation 30.
///
/// `f = albedo/pi (A + B max(0, cos(phi_i - phi_o)) sin(alpha) tan(beta))` with `A = 1 - s^2 / (2 (s^2 + 0.33))`,
/// `B = 0.45 s^2 / (s^2 + 0.09)`, `alpha` and `beta` the larger and the smaller polar angle, `s` the roughness. It
/// leaves out interreflection between walls and, being a fit, can reflect up to 1.5 % more than `albedo` at grazing
/// incidence for roughness near 0.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayar {
    /// Reflectance of the groove walls, per channel, in `[0, 1]`.
    pub albedo: [f64; 3],
    /// Standard deviation of the slope angle of the walls, in radians.
    pub roughness: f64,
}

impl Model for OrenNayar {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return [0.0; 3];
        }
        let s2 = self.roughness * self.roughness;
        let a = 1.0 - 0.5 * s2 / (s2 + 0.33);
        let b = 0.45 * s2 / (s2 + 0.09);
        // sin(alpha) tan(beta) = sin_i sin_o / cos(beta), and sin_i sin_o cos(phi_i - phi_o) needs no angles.
        let along = (wi[0] * wo[0] + wi[1] * wo[1]).max(0.0);
        let grooves = a + b * along / wi[2].max(wo[2]);
        self.albedo.map(|albedo| albedo / PI * grooves)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lambert, albedo, model::testing::*, vec3::spherical};

    #[test]
    fn without_roughness_it_is_lambert() {
        let (rough, flat) = (OrenNayar { albedo: [0.7; 3], roughness: 0.0 }, Lambert { albedo: [0.7; 3] });
        for wo in directions() {
            assert_eq!(rough.f(spherical(0.8, 0.0), wo), flat.f(spherical(0.8, 0.0), wo));
        }
    }

    #[test]
    fn retroreflects() {
        let model = OrenNayar { albedo: [0.7; 3], roughness: 0.5 };
        let wi = spherical(1.2, 0.0);
        assert!(model.f(wi, wi)[0] > 1.5 * model.f(wi, spherical(1.2, PI))[0]);
        // Toward the light, alpha = beta, so the factor is A + B sin tan.
        let (a, b) = (1.0 - 0.125 / 0.58, 0.45 * 0.25 / 0.34);
        let expected = 0.7 / PI * (a + b * 1.2f64.sin() * 1.2f64.tan());
        assert!((model.f(wi, wi)[0] - expected).abs() < 1e-12);
        assert_reciprocal(&model);
        assert_dark_below(&model);
    }

    #[test]
    fn gains_no_more_than_the_fit_is_known_to() {
        let mut most: f64 = 0.0;
        for roughness in [0.1, 0.2, 0.3, 0.5, 1.0] {
            for theta in [0.0, 0.8, 1.3, 1.5, 1.57] {
                most = most.max(albedo(&OrenNayar { albedo: [1.0; 3], roughness }, spherical(theta, 0.3), 64)[0]);
            }
        }
        assert!(most < 1.015, "{most}");
    }
}
