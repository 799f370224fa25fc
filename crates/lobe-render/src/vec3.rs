//! Vectors of three floats. No operations are fused or reassociated, so the bits are the same on every machine.

/// A point, a direction or a normal.
pub(crate) type Vec3 = [f32; 3];

pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(a: Vec3, s: f32) -> Vec3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

pub(crate) fn neg(a: Vec3) -> Vec3 {
    [-a[0], -a[1], -a[2]]
}

pub(crate) fn dot(a: Vec3, b: Vec3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: Vec3) -> f32 {
    dot(a, a).sqrt()
}

/// The unit vector along `a`; `None` if `a` has no direction.
pub(crate) fn unit(a: Vec3) -> Option<Vec3> {
    // Scaled by the largest component first, so that no square overflows or vanishes.
    let largest = a.iter().fold(0.0f32, |largest, c| largest.max(c.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let a = a.map(|c| c / largest);
    Some(scale(a, 1.0 / length(a)))
}

/// A unit vector perpendicular to the unit vector `n`.
pub(crate) fn perpendicular(n: Vec3) -> Vec3 {
    // The axis along which `n` is smallest, so that the cross product is never short.
    let [x, y, z] = n.map(f32::abs);
    let axis = if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let along = cross(n, axis);
    scale(along, 1.0 / length(along))
}
