//! The few vector operations that directions need.

/// A direction or point.
pub(crate) type Vec3 = [f64; 3];

#[inline]
pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline]
pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline]
pub(crate) fn scale(a: Vec3, s: f64) -> Vec3 {
    a.map(|x| x * s)
}

#[inline]
pub(crate) fn normalize(a: Vec3) -> Vec3 {
    scale(a, 1.0 / dot(a, a).sqrt())
}

/// The mirror image of `d` about the unit vector `n`, both pointing away from the surface.
#[inline]
pub(crate) fn reflect(d: Vec3, n: Vec3) -> Vec3 {
    add(scale(n, 2.0 * dot(d, n)), scale(d, -1.0))
}

/// The unit vector at polar angle `theta` from `+z` and azimuth `phi` from `+x`, in radians.
pub(crate) fn spherical(theta: f64, phi: f64) -> Vec3 {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// An orthonormal frame: tangent, bitangent, normal.
pub(crate) struct Frame(pub [Vec3; 3]);

impl Frame {
    /// The vector `v` of the outer frame, seen from this one.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        self.0.map(|axis| dot(axis, v))
    }

    /// The vector `v` of this frame, seen from the outer one.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        let [t, b, n] = self.0;
        add(add(scale(t, v[0]), scale(b, v[1])), scale(n, v[2]))
    }
}
