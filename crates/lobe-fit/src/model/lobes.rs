//! Empirical lobes, as in `lobe_model`.

use std::f64::consts::{LN_2, PI, TAU};

use super::microfacet::turned;
use crate::geometry::Geometry;
use crate::real::Real;

pub(super) fn phong<T: Real>(geometry: &Geometry, exponent: T) -> T {
    let Geometry { wi, wo, .. } = geometry;
    let cos = (wi[2] * wo[2] - wi[0] * wo[0] - wi[1] * wo[1]).max(0.0);
    (exponent + 2.0) / TAU * T::of(cos).powf(exponent)
}

pub(super) fn blinn<T: Real>(geometry: &Geometry, exponent: T) -> T {
    let n = exponent;
    let normalisation = (n + 2.0) * (n + 4.0) / (((n * (-0.5 * LN_2)).exp() + n) * (8.0 * PI));
    normalisation * T::of(geometry.h[2]).powf(n)
}

pub(super) fn ward<T: Real>(geometry: &Geometry, [x, y]: [T; 2], rotation: T) -> T {
    let h = [0, 1, 2].map(|axis| geometry.wi[axis] + geometry.wo[axis]);
    let square: f64 = h.iter().map(|c| c * c).sum();
    let [along, across] = turned(h, rotation);
    let slope2 = ((along / x).square() + (across / y).square()) / (h[2] * h[2]);
    (-slope2).exp() * (square / (PI * h[2].powi(4))) / (x * y)
}
