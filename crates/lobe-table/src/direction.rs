//! Vector arithmetic in `f64` for the reference evaluators. Directions are unit vectors, the normal is +z.

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

/// The unit vector along `a`, or zero where `a` is zero.
pub(crate) fn normalize(a: Vector) -> Vector {
    let length = dot(a, a).sqrt();
    if length > 0.0 { scale(a, 1.0 / length) } else { [0.0; 3] }
}

/// The zenith angle of a unit vector: `2 asin(|d - n| / 2)`, which keeps its digits near the pole where `acos` loses them.
pub(crate) fn theta(d: Vector) -> f64 {
    let chord = (d[0] * d[0] + d[1] * d[1] + (d[2] - 1.0) * (d[2] - 1.0)).sqrt();
    2.0 * (0.5 * chord).min(1.0).asin()
}

/// The azimuth of a direction in `(-pi, pi]`, 0 at the pole.
pub(crate) fn phi(d: Vector) -> f64 {
    d[1].atan2(d[0])
}
