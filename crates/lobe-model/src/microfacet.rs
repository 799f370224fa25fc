//! Rough surfaces as collections of small mirrors.

use std::f64::consts::{PI, TAU};

use crate::vec3::{Vec3, add, cross, dot, normalize, scale};

/// The GGX distribution of microfacet normals with Smith's masking, isotropic or anisotropic.
///
/// Distribution: B. Walter et al., *Microfacet models for refraction through rough surfaces*, EGSR 2007, equation 33;
/// anisotropic form and masking: E. Heitz, *Understanding the masking-shadowing function in microfacet-based BRDFs*,
/// JCGT 3(2), 2014, equations 72, 85, 86 and 99.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    /// Roughness along x and y, positive.
    pub alpha: [f64; 2],
}

impl Ggx {
    /// Density of the microfacet normal `h`, in 1/sr: its integral weighted with `h.z` is 1.
    #[inline]
    pub fn distribution(&self, h: [f64; 3]) -> f64 {
        if h[2] <= 0.0 {
            return 0.0;
        }
        let [ax, ay] = self.alpha;
        let q = (h[0] / ax).powi(2) + (h[1] / ay).powi(2) + h[2] * h[2];
        1.0 / (PI * ax * ay * q * q)
    }

    /// Smith's auxiliary function: the hidden facets per facet visible from `w`.
    #[inline]
    pub fn lambda(&self, w: [f64; 3]) -> f64 {
        let [ax, ay] = self.alpha;
        let tan2 = ((ax * w[0]).powi(2) + (ay * w[1]).powi(2)) / (w[2] * w[2]);
        0.5 * ((1.0 + tan2).sqrt() - 1.0)
    }

    /// The BRDF in 1/sr if every facet were a perfect mirror, with height-correlated masking. Zero below the surface.
    #[inline]
    pub fn mirrors(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return 0.0;
        }
        let masking = 1.0 + self.lambda(wi) + self.lambda(wo);
        self.distribution(normalize(add(wi, wo))) / (4.0 * wi[2] * wo[2] * masking)
    }

    /// A facet normal visible from `wi`, from two uniform numbers in `[0, 1)`.
    ///
    /// E. Heitz, *Sampling the GGX distribution of visible normals*, JCGT 7(4), 2018.
    pub fn visible_normal(&self, wi: [f64; 3], u: [f64; 2]) -> [f64; 3] {
        let [ax, ay] = self.alpha;
        let stretched = normalize([ax * wi[0], ay * wi[1], wi[2]]);
        let across = stretched[0].hypot(stretched[1]);
        let t1 = if across > 0.0 { [-stretched[1] / across, stretched[0] / across, 0.0] } else { [1.0, 0.0, 0.0] };
        let t2 = cross(stretched, t1);
        let (radius, (sin, cos)) = (u[0].sqrt(), (TAU * u[1]).sin_cos());
        let p1 = radius * cos;
        let s = 0.5 * (1.0 + stretched[2]);
        let p2 = (1.0 - s) * (1.0 - p1 * p1).sqrt() + s * radius * sin;
        let p3 = (1.0 - p1 * p1 - p2 * p2).max(0.0).sqrt();
        let n: Vec3 = add(add(scale(t1, p1), scale(t2, p2)), scale(stretched, p3));
        normalize([ax * n[0], ay * n[1], n[2].max(1e-12)])
    }

    /// Density, in 1/sr, of the direction to which a facet of [`Ggx::visible_normal`] mirrors `wi`.
    pub fn pdf(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        let h = normalize(add(wi, wo));
        if wi[2] <= 0.0 || dot(wi, h) <= 0.0 {
            return 0.0;
        }
        self.distribution(h) / (4.0 * wi[2] * (1.0 + self.lambda(wi)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vec3::{reflect, spherical};

    const MODELS: [Ggx; 3] = [Ggx { alpha: [0.2, 0.2] }, Ggx { alpha: [0.2, 0.6] }, Ggx { alpha: [1.0, 1.0] }];

    /// Midpoint rule over the upper hemisphere.
    fn integrate(value: impl Fn(Vec3) -> f64) -> f64 {
        let (rings, sectors) = (400, 400);
        let mut sum = 0.0;
        for i in 0..rings * sectors {
            let theta = ((i / sectors) as f64 + 0.5) / rings as f64 * PI / 2.0;
            let phi = ((i % sectors) as f64 + 0.5) / sectors as f64 * TAU;
            sum += theta.sin() * value(spherical(theta, phi));
        }
        sum * PI / 2.0 * TAU / (rings * sectors) as f64
    }

    #[test]
    fn projected_area_of_the_facets_equals_the_surface() {
        for ggx in MODELS {
            let area = integrate(|h| ggx.distribution(h) * h[2]);
            assert!((area - 1.0).abs() < 1e-4, "{area} for {ggx:?}");
            // Seen from w, the visible facets cover exactly the projected surface (Heitz 2014, equation 14).
            for w in [spherical(0.3, 0.2), spherical(1.2, 1.9)] {
                let seen = integrate(|h| ggx.distribution(h) * dot(w, h).max(0.0)) / (1.0 + ggx.lambda(w));
                assert!((seen - w[2]).abs() < 1e-4, "{seen} instead of {} for {ggx:?}", w[2]);
            }
        }
    }

    #[test]
    fn pdf_is_the_density_of_the_samples() {
        let ggx = Ggx { alpha: [0.3, 0.7] };
        let wi = spherical(0.7, 0.5);
        // Mean of the x and z components of the mirrored direction, by sampling and by the density.
        let side = 400;
        let mut mean = [0.0; 3];
        for i in 0..side * side {
            let u = [(f64::from(i / side) + 0.5) / f64::from(side), (f64::from(i % side) + 0.5) / f64::from(side)];
            mean = add(mean, scale(reflect(wi, ggx.visible_normal(wi, u)), 1.0 / f64::from(side * side)));
        }
        for axis in 0..3 {
            let below = |w: Vec3| [w[0], w[1], -w[2]];
            let expected =
                integrate(|w| ggx.pdf(wi, w) * w[axis]) + integrate(|w| ggx.pdf(wi, below(w)) * below(w)[axis]);
            assert!((mean[axis] - expected).abs() < 2e-3, "axis {axis}: {} instead of {expected}", mean[axis]);
        }
    }
}
