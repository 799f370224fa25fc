//! A clear coat on a base.

use crate::vec3::{add, dot, normalize};
use crate::{Ggx, Model, fresnel_dielectric};

/// A clear coat on a base: car paint, plastic, varnished wood.
///
/// `f = coat + (1 - F(cos_i)) (1 - F(cos_o)) base`: the coat is a rough dielectric, and the base gets what passes the
/// coat on the way in and out. After Weidlich and Wilkie, *Arbitrarily layered micro-facet surfaces*, GRAPHITE 2007,
/// section 4, for a thin coat that absorbs nothing and does not bend the directions at the base. It is reciprocal if
/// the base is.
///
/// The transmitted share is that of a smooth coat, while facets reflect less than a smooth one at grazing angles:
/// beyond 60 degrees light is lost there, more than a quarter of it at 80 degrees with `alpha = 0.2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coated<B> {
    /// The material under the coat.
    pub base: B,
    /// The facets of the coat.
    pub ggx: Ggx,
    /// Refractive index of the coat.
    pub eta: f64,
}

impl<B: Model> Model for Coated<B> {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return [0.0; 3];
        }
        let mirrored = |cos: f64| fresnel_dielectric(cos, self.eta);
        let coat = self.ggx.mirrors(wi, wo) * mirrored(dot(wi, normalize(add(wi, wo))));
        let passed = (1.0 - mirrored(wi[2])) * (1.0 - mirrored(wo[2]));
        self.base.f(wi, wo).map(|base| coat + passed * base)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lambert, albedo, model::testing::*, vec3::spherical};

    fn white() -> Coated<Lambert> {
        Coated { base: Lambert { albedo: [1.0; 3] }, ggx: Ggx { alpha: [0.2, 0.2] }, eta: 1.5 }
    }

    #[test]
    fn reciprocal_and_dark_below() {
        assert_reciprocal(&white());
        assert_dark_below(&white());
    }

    #[test]
    fn makes_no_light_and_loses_little_but_at_grazing_angles() {
        for degrees in [0.0f64, 30.0, 60.0, 80.0, 88.0] {
            let [reflected, ..] = albedo(&white(), spherical(degrees.to_radians(), 0.3), 200);
            assert!(reflected < 1.0 && (reflected > 0.8 || degrees > 60.0), "{reflected} at {degrees} degrees");
        }
    }

    /// At the normal: ((n - 1) / (n + 1))^2 D / 4 of the coat, and what passes it twice of the base.
    #[test]
    fn value_at_the_zenith() {
        let up = [0.0, 0.0, 1.0];
        let expected = 0.04 / (4.0 * std::f64::consts::PI * 0.04) + 0.96 * 0.96 / std::f64::consts::PI;
        assert!((white().f(up, up)[0] - expected).abs() < 1e-12, "{} for {expected}", white().f(up, up)[0]);
    }
}
