//! GGX facets, as in `lobe_model::Ggx`.

use std::f64::consts::PI;

use crate::geometry::Geometry;
use crate::real::Real;

/// The components of a vector along x and y axes that are rotated by an angle in degrees.
pub(super) fn turned<T: Real>(w: [f64; 3], degrees: T) -> [T; 2] {
    let angle = degrees.value().to_radians();
    let (sin, cos) = angle.sin_cos();
    let sine = degrees.chain(sin, cos * PI / 180.0);
    let cosine = degrees.chain(cos, -sin * PI / 180.0);
    [cosine * w[0] + sine * w[1], cosine * w[1] - sine * w[0]]
}

/// Schlick's reflectance of a facet.
pub(super) fn schlick<T: Real>(cos: f64, f0: T) -> T {
    f0 + f0.rest() * (1.0 - cos).powi(5)
}

/// The reflectance of a facet with the complex refractive index `n + ik` for unpolarised light; `k` is above 0.
pub(super) fn fresnel<T: Real>(cos: f64, n: T, k: T) -> T {
    let sin2 = 1.0 - cos * cos;
    let difference = n.square() - k.square() - sin2;
    let both = (difference.square() + (n * k).square() * 4.0).sqrt();
    // Two forms of the same number, of which one keeps its digits.
    let square =
        if difference.value() > 0.0 { (both + difference) * 0.5 } else { (n * k).square() * 2.0 / (both - difference) };
    let real = square.sqrt() * (2.0 * cos);
    let across = (both + cos * cos - real) / (both + cos * cos + real);
    let (sum, mixed) = (both * (cos * cos) + sin2 * sin2, real * sin2);
    across * ((sum - mixed) / (sum + mixed) + 1.0) * 0.5
}

fn lambda<T: Real>(w: [f64; 3], [x, y]: [T; 2], rotation: T) -> T {
    let [along, across] = turned(w, rotation);
    let tan2 = ((along * x).square() + (across * y).square()) / (w[2] * w[2]);
    ((tan2 + 1.0).sqrt() - 1.0) * 0.5
}

/// The BRDF of facets that are perfect mirrors, with height-correlated masking.
pub(super) fn mirrors<T: Real>(geometry: &Geometry, alpha: [T; 2], rotation: T) -> T {
    let Geometry { wi, wo, h, .. } = *geometry;
    let [x, y] = alpha;
    let [along, across] = turned(h, rotation);
    let q = (along / x).square() + (across / y).square() + h[2] * h[2];
    let distribution = (x * y * q.square() * PI).recip();
    let masking = lambda(wi, alpha, rotation) + lambda(wo, alpha, rotation) + 1.0;
    distribution / (masking * (4.0 * wi[2] * wo[2]))
}
