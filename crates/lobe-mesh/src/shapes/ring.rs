//! A ring with a flat inside, which casts a caustic.

use glam::DVec3;

use super::{Builder, Vertex, turn};
use crate::Geometry;

/// A ring around the y axis with flat walls, given by its outer radius, the thickness of its wall, which is at most the
/// radius, and its height. u runs eastward once around on each of the four sides, v across them.
pub fn ring(radius: f32, thickness: f32, height: f32, segments: u32) -> Geometry {
    let columns = segments.max(3) as usize;
    let (outer, half) = (f64::from(radius), f64::from(height) / 2.0);
    let inner = outer - f64::from(thickness.min(radius));
    let mut builder = Builder::default();
    // Outside, top, inside, bottom: radius and height at v = 0 and at v = 1.
    let sides = [
        [(outer, -half), (outer, half)],
        [(outer, half), (inner, half)],
        [(inner, half), (inner, -half)],
        [(inner, -half), (outer, -half)],
    ];
    for [from, to] in sides {
        builder.patch(columns, 1, |i, j| {
            let [sine, cosine] = turn(i, columns);
            let (radius, height) = if j == 0 { from } else { to };
            // A quarter turn from the direction across; on the outside it points outward.
            let [along, up] = [to.0 - from.0, to.1 - from.1];
            let normal = DVec3::new(up * sine, -along, up * cosine).normalize_or(DVec3::Y);
            Vertex {
                position: DVec3::new(radius * sine, height, radius * cosine),
                normal,
                tangent: DVec3::new(cosine, 0.0, -sine),
                uv: [i as f64 / columns as f64, j as f64],
            }
        });
    }
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_has_its_volume_and_normals_point_outward() {
        let ring = ring(2.0, 0.5, 0.6, 512);
        let corner = |index: u32| DVec3::from(ring.positions[index as usize].map(f64::from));
        let mut volume = 0.0;
        for triangle in &ring.triangles {
            let [a, b, c] = triangle.map(corner);
            volume += a.dot(b.cross(c)) / 6.0;
            let facet = (b - a).cross(c - a);
            let normal = DVec3::from(ring.normals.as_ref().unwrap()[triangle[0] as usize].map(f64::from));
            assert!(facet.normalize().dot(normal) > 0.99, "{a} {b} {c}: {normal}");
        }
        let expected = std::f64::consts::PI * (4.0 - 1.5 * 1.5) * 0.6;
        assert!((volume / expected - 1.0).abs() < 1e-3, "{volume}, not {expected}");
    }
}
