//! Computes normals for files without them.

use std::collections::HashMap;

use glam::DVec3;

use crate::Geometry;
use crate::geometry::{Parts, cross, narrow, wide};

/// How edges are treated when normals are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Edges are smoothed away: the normal of a vertex is the mean of its triangles' normals, each weighted by its
    /// angle at the vertex (Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998).
    #[default]
    Smooth,
    /// Every triangle keeps its own normal; no two triangles share vertices afterwards.
    Flat,
}

impl Geometry {
    /// The mesh with recomputed normals. Tangents are dropped, because they belong to the old normals.
    pub fn with_normals(self, shading: Shading) -> Geometry {
        let mut parts = self.into_parts();
        parts.tangents = None;
        match shading {
            Shading::Smooth => parts.normals = Some(smooth(&parts.positions, &parts.triangles)),
            Shading::Flat => separate(&mut parts),
        }
        Geometry::new(parts).expect("computed normals are unit vectors, and separate corners are in range")
    }
}

/// Angle-weighted normals. Vertices at the same place share one, so that the seams of texture coordinates do not show.
pub(crate) fn smooth(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
    let mut places = HashMap::new();
    let place: Vec<usize> = positions
        .iter()
        .map(|position| {
            let next = places.len();
            // Adding zero turns -0 into +0.
            *places.entry(position.map(|x| (x + 0.0).to_bits())).or_insert(next)
        })
        .collect();
    let mut sums = vec![DVec3::ZERO; places.len()];
    for &corners in triangles {
        let normal = direction(cross(positions, corners));
        let p = corners.map(|index| wide(positions[index as usize]));
        for i in 0..3 {
            let (a, b) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
            sums[place[corners[i] as usize]] += normal * libm::atan2(a.cross(b).length(), a.dot(b));
        }
    }
    place.into_iter().map(|index| narrow(unit(sums[index]))).collect()
}

/// Gives every triangle its own three vertices, with its normal.
fn separate(parts: &mut Parts) {
    let corners: Vec<usize> = parts.triangles.iter().flatten().map(|&index| index as usize).collect();
    let normals = parts.triangles.iter().map(|&corners| narrow(unit(cross(&parts.positions, corners))));
    parts.normals = Some(normals.flat_map(|normal| [normal; 3]).collect());
    parts.positions = corners.iter().map(|&index| parts.positions[index]).collect();
    parts.uvs = parts.uvs.take().map(|uvs| corners.iter().map(|&index| uvs[index]).collect());
    parts.triangles = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
}

/// The unit vector along `v`; zero if `v` has no direction.
fn direction(v: DVec3) -> DVec3 {
    v.try_normalize().unwrap_or(DVec3::ZERO)
}

/// The unit vector along `v`; +z for a vertex without area, which has no normal.
pub(crate) fn unit(v: DVec3) -> DVec3 {
    v.try_normalize().unwrap_or(DVec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn smooth_normals_of_a_sphere_point_outward_across_the_seam() {
        let mut parts = shapes::sphere(2.0, 48).into_parts();
        parts.normals = None;
        let sphere = Geometry::new(parts).expect("a mesh").with_normals(Shading::Smooth);
        let normals = sphere.normals.as_ref().expect("normals");
        for (p, n) in sphere.positions.iter().zip(normals) {
            let cosine = wide(*p).normalize().dot(wide(*n));
            assert!(cosine > 0.9999, "{cosine} at {p:?}");
        }
    }

    #[test]
    fn weights_are_angles() {
        // A corner of a cube with one face cut in two: the cut must not pull the normal towards that face.
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
        let normals = smooth(&positions, &triangles);
        let third = 1.0 / 3f32.sqrt();
        for component in normals[0] {
            assert!((component - third).abs() < 1e-6, "{:?}", normals[0]);
        }
    }

    #[test]
    fn flat_triangles_share_nothing() {
        let cube = shapes::cuboid([1.0; 3], 2).with_normals(Shading::Flat);
        assert_eq!(cube.positions.len(), 3 * cube.triangles.len());
        let normals = cube.normals.as_ref().expect("normals");
        for &corners in &cube.triangles {
            let normal = cross(&cube.positions, corners).normalize();
            for index in corners {
                assert!((wide(normals[index as usize]) - normal).length() < 1e-6);
            }
        }
    }

    #[test]
    fn triangles_without_area_do_not_panic() {
        let parts = Parts { positions: vec![[1.0; 3]; 3], triangles: vec![[0, 1, 2]], ..Parts::default() };
        let point = Geometry::new(parts).expect("a mesh").with_normals(Shading::Smooth);
        assert_eq!(point.normals, Some(vec![[0.0, 0.0, 1.0]; 3]));
        let huge = [[f32::MAX, 0.0, 0.0], [0.0, f32::MAX, 0.0], [-f32::MAX, 0.0, f32::MAX]];
        let parts = Parts { positions: huge.into(), triangles: vec![[0, 1, 2]], ..Parts::default() };
        let huge = Geometry::new(parts).expect("a mesh").with_normals(Shading::Flat);
        assert_eq!(huge.triangles.len(), 1);
    }
}
