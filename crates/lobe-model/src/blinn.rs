//! The cosine lobe about the half vector.

use std::f64::consts::PI;

use crate::Model;
use crate::vec3::{add, normalize};

/// The lobe of J. F. Blinn, *Models of light reflection for computer synthesized pictures*, SIGGRAPH 1977, about the
/// half vector `h` of `wi` and `wo`: `f = specular N cos^n(angle between h and the normal)`.
///
/// `N = (n + 2)(n + 4) / (8 pi (2^(-n/2) + n))` makes light from the zenith reflect exactly `specular`: with `t` the
/// polar angle of the viewer, that of `h` is `t/2`, and the integral of `cos^n(t/2) cos t` over the hemisphere is
/// `1/N`. From other directions less is reflected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blinn {
    /// Reflectance at the zenith, per channel, in `[0, 1]`.
    pub specular: [f64; 3],
    /// The exponent `n`, not negative.
    pub exponent: f64,
}

impl Model for Blinn {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return [0.0; 3];
        }
        let n = self.exponent;
        let normalisation = (n + 2.0) * (n + 4.0) / (8.0 * PI * ((-n / 2.0).exp2() + n));
        let lobe = normalisation * normalize(add(wi, wo))[2].powf(n);
        self.specular.map(|s| s * lobe)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{albedo, model::testing::*, vec3::spherical};

    #[test]
    fn normalised_at_the_zenith_and_never_above() {
        for exponent in [0.0, 1.0, 10.0, 200.0] {
            let model = Blinn { specular: [1.0; 3], exponent };
            let zenith = albedo(&model, [0.0, 0.0, 1.0], 200)[0];
            assert!((zenith - 1.0).abs() < 1e-3, "{zenith} with exponent {exponent}");
            for theta in [0.5, 1.0, 1.5] {
                assert!(albedo(&model, spherical(theta, 0.4), 200)[0] <= 1.0 + 1e-3);
            }
        }
    }

    #[test]
    fn without_exponent_it_is_lambert() {
        let model = Blinn { specular: [0.5; 3], exponent: 0.0 };
        assert!((model.f(spherical(0.3, 0.0), spherical(1.0, 2.0))[0] - 0.5 / PI).abs() < 1e-15);
        assert_reciprocal(&Blinn { specular: [1.0, 0.5, 0.1], exponent: 40.0 });
        assert_dark_below(&model);
    }
}
