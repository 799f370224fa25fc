//! Water with small waves.

use glam::DVec3;

use super::{Builder, Vertex, direction};
use crate::Geometry;

/// Directions in the plane, lengths and heights of the waves, for a square of side 1.
const WAVES: [[f64; 5]; 7] = [
    [0.94, 0.34, 0.31, 0.0042, 0.13],
    [-0.50, 0.87, 0.23, 0.0031, 0.71],
    [0.17, -0.98, 0.187, 0.0024, 0.37],
    [-0.87, -0.50, 0.141, 0.0016, 0.05],
    [0.64, 0.77, 0.113, 0.0011, 0.59],
    [-0.26, 0.97, 0.083, 0.0006, 0.83],
    [0.99, -0.14, 0.061, 0.0004, 0.29],
];

/// A square of side `size` around the plane y = 0, facing +y, whose height is the sum of a few waves, with `segments`
/// by `segments` cells. u runs along +x, v along -z.
pub fn waves(size: f32, segments: u32) -> Geometry {
    let (cells, size) = (segments.max(1) as usize, f64::from(size));
    let mut builder = Builder::default();
    builder.patch(cells, cells, |i, j| {
        let [u, v] = [i, j].map(|k| k as f64 / cells as f64);
        let (x, z) = (u - 0.5, 0.5 - v);
        let (mut height, mut slope) = (0.0, [0.0; 2]);
        for [along, across, length, amplitude, phase] in WAVES {
            let [sine, cosine] = direction((along * x + across * z) / length + phase);
            height += amplitude * sine;
            let steep = amplitude * cosine * std::f64::consts::TAU / length;
            slope = [slope[0] + along * steep, slope[1] + across * steep];
        }
        Vertex {
            position: DVec3::new(x, height, z) * size,
            normal: DVec3::new(-slope[0], 1.0, -slope[1]).normalize(),
            tangent: DVec3::new(1.0, slope[0], 0.0).normalize(),
            uv: [u, v],
        }
    });
    builder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_agree_with_the_surface() {
        let waves = waves(3.0, 200);
        let normals = waves.normals.as_ref().unwrap();
        for triangle in &waves.triangles {
            let [a, b, c] = triangle.map(|index| DVec3::from(waves.positions[index as usize].map(f64::from)));
            let facet = (b - a).cross(c - a).normalize();
            let normal = DVec3::from(normals[triangle[0] as usize].map(f64::from));
            assert!(facet.dot(normal) > 0.99, "{facet}, {normal}");
        }
    }
}
