//! Vector arithmetic in `f64` for the reference evaluators. Directions are unit vectors, the normal is +z.

use std::f64::consts::TAU;

/// A vector or direction in the local frame of the surface.
pub(crate) type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn scale(a: Vector, s: f64) -> Vector {
    [a[0] * s, a[1] * s, a[2] * s]
}

pub(crate) fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector along `a`, or zero if `a` is zero.
pub(crate) fn normalize(a: Vector) -> Vector {
    let length = dot(a, a).sqrt();
    if length > 0.0 { scale(a, 1.0 / length) } else { [0.0; 3] }
}

/// The direction with zenith angle `theta` and azimuth `phi`.
pub(crate) fn spherical(theta: f64, phi: f64) -> Vector {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// The zenith angle of a unit vector: `2 asin(|d - n| / 2)`, which keeps its digits near the pole where `acos` loses
/// them.
pub(crate) fn theta(d: Vector) -> f64 {
    let chord = (d[0] * d[0] + d[1] * d[1] + (d[2] - 1.0) * (d[2] - 1.0)).sqrt();
    2.0 * (0.5 * chord).min(1.0).asin()
}

/// The azimuth of a direction in `[-pi, pi]`, with the sign of y; 0 at the pole, whatever the signs of its zeros.
pub(crate) fn phi(d: Vector) -> f64 {
    if d[0] == 0.0 && d[1] == 0.0 { 0.0 } else { d[1].atan2(d[0]) }
}

/// A direction rotated about the normal by `angle`.
pub(crate) fn rotate_z([x, y, z]: Vector, angle: f64) -> Vector {
    let (sin, cos) = angle.sin_cos();
    [cos * x - sin * y, sin * x + cos * y, z]
}

/// An azimuth moved into `[0, 2 pi)`.
pub(crate) fn wrap(phi: f64) -> f64 {
    let wrapped = phi.rem_euclid(TAU);
    // A tiny negative angle rounds up to the full turn.
    if wrapped < TAU { wrapped } else { 0.0 }
}

/// The coordinates of Rusinkiewicz, "A New Change of Variables for Efficient BRDF Representation", 1998: the zenith
/// angle of the half vector, and zenith angle and azimuth in `(-pi, pi]` of `wi` in the frame of the half vector.
///
/// If the half vector is the normal, its azimuth is 0; if `wi` is the half vector, `phi_d` is 0.
pub(crate) fn half_difference(wi: Vector, wo: Vector) -> (f64, f64, f64) {
    let h = normalize(add(wi, wo));
    let (sin, cos) = ((h[0] * h[0] + h[1] * h[1]).sqrt(), h[2]);
    let (cos_phi, sin_phi) = if sin > 0.0 { (h[0] / sin, h[1] / sin) } else { (1.0, 0.0) };
    // Rotated about the normal by -phi_h, then about y by -theta_h, which moves h to the pole.
    let (x, y) = (cos_phi * wi[0] + sin_phi * wi[1], cos_phi * wi[1] - sin_phi * wi[0]);
    let d = [cos * x - sin * wi[2], y, sin * x + cos * wi[2]];
    (theta(h), theta(d), phi(d))
}
