//! Rough metal.

use crate::Model;
use crate::microfacet::Ggx;
use crate::vec3::{add, dot, normalize};

/// A metal of GGX microfacets: `f = D F / (4 cos_i cos_o (1 + lambda_i + lambda_o))`, with the height-correlated
/// masking of Heitz 2014, equation 99 (see [`Ggx`]). Light that hits two facets is lost, so very rough metal is
/// slightly too dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// The facets.
    pub ggx: Ggx,
    /// Real part of the refractive index, per channel.
    pub eta: [f64; 3],
    /// Imaginary part of the refractive index, per channel.
    pub k: [f64; 3],
}

impl Model for Conductor {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        let mirrors = self.ggx.mirrors(wi, wo);
        if mirrors == 0.0 {
            return [0.0; 3];
        }
        let cos = half_angle_cosine(wi, wo);
        std::array::from_fn(|c| mirrors * fresnel_conductor(cos, self.eta[c], self.k[c]))
    }
}

/// The cosine of the angle between either direction and the normal of the facets that mirror one into the other.
#[inline]
pub fn half_angle_cosine(wi: [f64; 3], wo: [f64; 3]) -> f64 {
    dot(wi, normalize(add(wi, wo)))
}

/// The reflectance of a smooth conductor in vacuum for unpolarised light, from the cosine of the angle of incidence.
///
/// The exact Fresnel equations for a complex refractive index `eta + i k`: M. Born and E. Wolf, *Principles of optics*,
/// section 14.2 (7th edition).
#[inline]
pub fn fresnel_conductor(cos: f64, eta: f64, k: f64) -> f64 {
    let difference = eta * eta - k * k - (1.0 - cos * cos);
    let imaginary = 2.0 * eta * k;
    // Indices are far from where squares overflow, against which `hypot` would guard at several times the cost.
    let modulus = (difference * difference + imaginary * imaginary).sqrt();
    average(cos, modulus, (0.5 * (modulus + difference)).max(0.0).sqrt())
}

/// The reflectance of a smooth dielectric in vacuum for unpolarised light: that of a conductor that absorbs nothing.
///
/// `eta` is the refractive index; beyond the critical angle of an index below 1, all light is reflected.
#[inline]
pub fn fresnel_dielectric(cos: f64, eta: f64) -> f64 {
    let difference = eta * eta - (1.0 - cos * cos);
    average(cos, difference.abs(), difference.max(0.0).sqrt())
}

/// The mean of both reflectances: of `a + ib`, the square root of (eta + ik)^2 - sin^2, it takes the squared modulus and
/// the real part.
#[inline]
fn average(cos: f64, modulus: f64, a: f64) -> f64 {
    let (cos2, sin2) = (cos * cos, 1.0 - cos * cos);
    // The perpendicular reflectance is `less / more`. Half the sum with the parallel one, whose ratio to it is
    // `(even - odd) / (even + odd)`, both multiplied by cos^2 to avoid a division by zero.
    let [less, more] = [modulus + cos2 - 2.0 * a * cos, modulus + cos2 + 2.0 * a * cos];
    let (even, odd) = (modulus * cos2 + sin2 * sin2, 2.0 * a * cos * sin2);
    less * even / (more * (even + odd))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{albedo, model::testing::*, vec3::spherical};
    use std::f64::consts::PI;

    fn gold(alpha: [f64; 2]) -> Conductor {
        Conductor { ggx: Ggx { alpha }, eta: [0.143, 0.375, 1.442], k: [3.983, 2.386, 1.603] }
    }

    /// A mirror at any angle: the limit of a large k.
    fn silvered(alpha: [f64; 2]) -> Conductor {
        Conductor { ggx: Ggx { alpha }, eta: [1.0; 3], k: [1e6; 3] }
    }

    #[test]
    fn fresnel_limits() {
        for (eta, k) in [(0.143, 3.983), (1.5, 0.0), (2.0, 1.0)] {
            let normal = ((eta - 1.0f64).powi(2) + k * k) / ((eta + 1.0f64).powi(2) + k * k);
            assert!((fresnel_conductor(1.0, eta, k) - normal).abs() < 1e-14);
            assert_eq!(fresnel_conductor(0.0, eta, k), 1.0);
        }
        for cos in [1.0, 0.7, 0.2, 0.0] {
            for eta in [1.5, 0.7] {
                assert_eq!(fresnel_dielectric(cos, eta), fresnel_conductor(cos, eta, 0.0), "{cos}, {eta}");
            }
        }
        // Glass at Brewster's angle reflects only the perpendicular half: ((n^2 - 1) / (n^2 + 1))^2 / 2.
        let brewster = 1.0 / (1.0 + 1.5f64 * 1.5).sqrt();
        assert!((fresnel_conductor(brewster, 1.5, 0.0) - 0.5 * (1.25f64 / 3.25).powi(2)).abs() < 1e-14);
    }

    #[test]
    fn value_at_the_zenith() {
        let up = [0.0, 0.0, 1.0];
        let got = silvered([0.3, 0.5]).f(up, up)[1];
        assert!((got - 1.0 / (4.0 * PI * 0.15)).abs() < 1e-5, "{got}");
    }

    #[test]
    fn reflects_no_more_than_it_receives() {
        for alpha in [[0.2, 0.2], [0.15, 0.5], [1.0, 1.0]] {
            for theta in [0.0, 0.8, 1.3, 1.5] {
                let got = albedo(&silvered(alpha), spherical(theta, 0.9), 200)[0];
                assert!(got <= 1.0 + 2e-3, "{got} at {theta} with {alpha:?}");
            }
        }
        // For light from the zenith, the light mirrored by facets steeper than 45 degrees is lost below the horizon:
        // alpha^2 / (1 + alpha^2).
        let smooth = albedo(&silvered([0.15, 0.15]), [0.0, 0.0, 1.0], 200)[0];
        assert!(smooth < 1.0 / (1.0 + 0.15 * 0.15) && smooth > 0.97, "{smooth}");
        let [r, g, b] = albedo(&gold([0.2, 0.2]), spherical(0.5, 0.0), 100);
        assert!(r > g && g > b, "gold is yellow");
    }

    #[test]
    fn reciprocal_and_anisotropic() {
        assert_reciprocal(&gold([0.1, 0.4]));
        assert_dark_below(&gold([0.3, 0.3]));
        let (up, model) = ([0.0, 0.0, 1.0], gold([0.1, 0.4]));
        assert!(model.f(up, spherical(0.6, 0.0))[0] < 0.1 * model.f(up, spherical(0.6, PI / 2.0))[0]);
    }
}
