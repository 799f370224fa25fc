//! Scatter of smooth optics, by the distance from the mirror direction in direction cosines.

use std::f64::consts::PI;

use super::{amplitude, shape, width};
use crate::geometry::Geometry;
use crate::parameter::Parameter;
use crate::real::Real;

pub(super) const ABG: &[Parameter] = &[
    width("B", "distance from the mirror direction to the power g at which the shoulder is", [1e-16, 1e2]),
    shape("g", "negative slope of the tail", [0.05, 8.0]),
    amplitude("A", "scale, in 1/sr", [1e-16, 1e6]),
];

pub(super) const HARVEY_SHACK: &[Parameter] = &[
    width("l", "distance from the mirror direction at which the shoulder is", [1e-6, 10.0]),
    shape("s", "slope of the tail", [-8.0, -0.05]),
    amplitude("b0", "value in the mirror direction, in 1/sr", [1e-12, 1e12]),
];

pub(super) const K_CORRELATION: &[Parameter] = &[
    width("B", "correlation length of the surface, in micrometres", [1e-2, 1e6]),
    shape("s", "negative slope of the power spectrum", [2.001, 8.0]),
    amplitude("sigma", "roughness (root mean square) of a perfectly reflecting surface, in nm", [1e-6, 1e6]),
];

/// `A / (B + |beta - beta_0|^g)`.
pub(super) fn abg<T: Real>(geometry: &Geometry, [a, b, g]: [T; 3]) -> T {
    a / (b + T::of(geometry.off_mirror()).powf(g))
}

/// J. E. Harvey, *Light-scattering characteristics of optical surfaces*, 1976.
pub(super) fn harvey_shack<T: Real>(geometry: &Geometry, [b0, l, s]: [T; 3]) -> T {
    let shoulder = (l.recip() * geometry.off_mirror()).square() + 1.0;
    b0 * shoulder.powf(s * 0.5)
}

/// The generalised Harvey-Shack theory for smooth surfaces, `f = (4 pi^2 / lambda^4) (cos_i + cos_o)^2 S(f)` (A.
/// Krywonos, J. E. Harvey and N. Choi, JOSA A 28(6), 2011) with the two-dimensional K-correlation spectrum
/// `S = sigma^2 (s - 2) B^2 / (2 pi) (1 + (B f)^2)^(-s/2)`, whose integral is `sigma^2`, at
/// `f = |beta - beta_0| / lambda`.
pub(super) fn k_correlation<T: Real>(geometry: &Geometry, nm: f64, [sigma, b, s]: [T; 3]) -> T {
    let micrometres = 1e-3 * nm;
    let spectrum = (sigma * 1e-3).square() * (s - 2.0) * b.square() / (2.0 * PI);
    let shoulder = (b * (geometry.off_mirror() / micrometres)).square() + 1.0;
    let cosines = (geometry.cos_i() + geometry.cos_o()).powi(2);
    spectrum * shoulder.powf(s * -0.5) * (4.0 * PI * PI * cosines / micrometres.powi(4))
}
