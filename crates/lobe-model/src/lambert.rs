//! The perfectly diffuse surface.

use std::f64::consts::PI;

use crate::Model;

/// Equal radiance in every direction (J. H. Lambert, *Photometria*, 1760): `f = albedo / pi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    /// Reflected share of the light, per channel, in `[0, 1]`.
    pub albedo: [f64; 3],
}

impl Model for Lambert {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 { [0.0; 3] } else { self.albedo.map(|a| a / PI) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{albedo, model::testing::*, vec3::spherical};

    #[test]
    fn reflects_its_albedo_from_every_direction() {
        let model = Lambert { albedo: [0.9, 0.5, 0.0] };
        for theta in [0.0, 0.7, 1.5] {
            let got = albedo(&model, spherical(theta, 2.0), 8);
            for (x, expected) in got.into_iter().zip(model.albedo) {
                assert!((x - expected).abs() < 1e-12, "{x} instead of {expected}");
            }
        }
        assert_reciprocal(&model);
        assert_dark_below(&model);
    }
}
