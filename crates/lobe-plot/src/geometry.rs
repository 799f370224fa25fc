//! Directions of the figures. Unit vectors away from the surface, normal on +z.

use lobe::Scatter;
use lobe::Side;

/// The z of a hemisphere: 1 above, -1 below.
pub(crate) fn sign(side: Side) -> f64 {
    match side {
        Side::Front => 1.0,
        Side::Back => -1.0,
    }
}

/// The z of the hemisphere that light from `side` leaves into.
pub(crate) fn outgoing_sign(side: Side, scatter: Scatter) -> f64 {
    match scatter {
        Scatter::Reflection => sign(side),
        Scatter::Transmission => -sign(side),
    }
}

/// `wi` at the polar angle `sigma` from the normal of the lit side, at the azimuth `psi`; radians.
pub fn incident(side: Side, sigma: f64, psi: f64) -> [f64; 3] {
    [sigma.sin() * psi.cos(), sigma.sin() * psi.sin(), sign(side) * sigma.cos()]
}

/// `wo` in the plane of incidence: `theta` from the normal in radians, positive away from the light. The mirror
/// direction and the straight-through ray are at `theta = sigma`.
pub fn in_plane(side: Side, scatter: Scatter, theta: f64, psi: f64) -> [f64; 3] {
    let across = -theta.sin();
    [across * psi.cos(), across * psi.sin(), outgoing_sign(side, scatter) * theta.cos()]
}

/// The direction at a point of the unit disk, by Lambert's equal-area projection of the hemisphere `side` of `z`;
/// `None` outside the disk. The light is on the left: a positive `x` points away from it. `y` is up. Both hemispheres
/// are seen from the lit side.
///
/// `r = sqrt(2) sin(theta / 2)`: equal areas are equal solid angles (J. P. Snyder, "Map Projections: A Working Manual",
/// 1987, equation 24-3).
pub fn from_disk(side: Side, scatter: Scatter, psi: f64, x: f64, y: f64) -> Option<[f64; 3]> {
    let square = x * x + y * y;
    if square >= 1.0 {
        return None;
    }
    // cos(theta) = 1 - r^2, and sin(theta) / r = sqrt(2 - r^2).
    let (along, across) = (x * (2.0 - square).sqrt(), y * (2.0 - square).sqrt());
    let (sin, cos) = psi.sin_cos();
    // Seen from below, left and right are unchanged relative to the light, and the azimuth turns the other way.
    let across = across * sign(side);
    Some([-along * cos + across * sin, -along * sin - across * cos, outgoing_sign(side, scatter) * (1.0 - square)])
}

/// The point of a direction on the unit disk: the inverse of [`from_disk`]. `psi` is the azimuth of the light in
/// radians.
pub fn to_disk(side: Side, psi: f64, direction: [f64; 3]) -> [f64; 2] {
    let [x, y, z] = direction;
    let (sin, cos) = psi.sin_cos();
    let scale = 1.0 / (1.0 + z.abs()).sqrt();
    let (along, across) = (-(x * cos + y * sin), x * sin - y * cos);
    [along * scale, across * sign(side) * scale]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn normalise(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|c| c / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f64; 3], b: [f64; 3]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn the_mirror_and_the_straight_ray_are_at_sigma() {
        for side in [Side::Front, Side::Back] {
            let [x, y, z] = incident(side, 0.7, 0.3);
            assert!(near(in_plane(side, Scatter::Reflection, 0.7, 0.3), [-x, -y, z]));
            assert!(near(in_plane(side, Scatter::Transmission, 0.7, 0.3), [-x, -y, -z]));
            assert!(near(in_plane(side, Scatter::Reflection, -0.7, 0.3), [x, y, z]));
        }
    }

    #[test]
    fn the_disk_preserves_areas_and_has_an_inverse() {
        for side in [Side::Front, Side::Back] {
            for (x, y) in [(0.0, 0.0), (0.5, 0.0), (-0.3, 0.8), (0.0, -0.999)] {
                let d = from_disk(side, Scatter::Transmission, 1.1, x, y).unwrap();
                assert!((dot(d, d) - 1.0).abs() < 1e-12);
                let [u, v] = to_disk(side, 1.1, d);
                assert!((u - x).abs() < 1e-12 && (v - y).abs() < 1e-12, "{x} {y}: {u} {v}");
            }
            // Half the solid angle of the hemisphere is within 60 degrees, and half the disk within sqrt(1/2).
            let d = from_disk(side, Scatter::Reflection, 0.0, 0.5_f64.sqrt(), 0.0).unwrap();
            assert!((d[2].abs() - 0.5).abs() < 1e-12);
            // The light is on the left.
            assert!(to_disk(side, 0.4, incident(side, 0.9, 0.4))[0] < -0.3);
        }
        assert!(from_disk(Side::Front, Scatter::Reflection, 0.0, 0.8, 0.7).is_none());
    }
}
