//! Cuts triangles into smaller ones that follow the smooth surface implied by their normals.
//!
//! Vlachos, Peters, Boyd and Mitchell, "Curved PN Triangles", 2001: each triangle becomes a cubic patch, which meets
//! its neighbours because each border depends only on the two corners at its ends.

use std::collections::HashMap;

use glam::DVec3;

use crate::geometry::{narrow, wide};
use crate::normals::unit;
use crate::{Geometry, GeometryError, Group, Parts, Shading};

impl Geometry {
    /// The mesh with each triangle cut into `pieces * pieces`, curved as its normals imply; a mesh without normals
    /// counts as smooth. Normals, texture coordinates and tangents are interpolated.
    ///
    /// Two triangles with different normals at a common vertex (a hard edge) curve apart and leave a gap.
    ///
    /// # Errors
    /// If there are more triangles than 32 bits can count, or a position becomes infinite.
    pub fn refined(self, pieces: u32) -> Result<Geometry, GeometryError> {
        let pieces = pieces.max(1);
        let found = (self.triangles.len() as u64).saturating_mul(u64::from(pieces).pow(2));
        if u32::try_from(found).is_err() {
            return Err(GeometryError::TooMany { what: "triangles", found: found as usize });
        }
        let mesh = if self.normals.is_some() { self } else { self.with_normals(Shading::Smooth) };
        if pieces == 1 || mesh.triangles.is_empty() {
            return Ok(mesh);
        }
        let mut refined = Refined { edges: HashMap::new(), parts: mesh.clone().into_parts(), pieces, mesh: &mesh };
        refined.parts.triangles.clear();
        for &corners in &mesh.triangles {
            refined.triangle(corners);
        }
        let square = pieces * pieces;
        for Group { triangles, .. } in &mut refined.parts.groups {
            *triangles = triangles.start * square..triangles.end * square;
        }
        Geometry::new(refined.parts)
    }
}

/// A mesh that grows from another, whose vertices come first.
struct Refined<'a> {
    mesh: &'a Parts,
    parts: Parts,
    pieces: u32,
    /// The first of the vertices between two others, which are in the order of their positions.
    edges: HashMap<[u32; 2], u32>,
}

impl Refined<'_> {
    fn triangle(&mut self, corners: [u32; 3]) {
        let n = self.pieces;
        let [a, b, c] = corners;
        let edges = [self.edge(a, b), self.edge(a, c), self.edge(b, c)];
        let inside = self.parts.positions.len() as u32;
        let patch = Patch::new(corners.map(|corner| self.corner(corner)));
        for j in 1..n {
            for i in 1..n - j {
                let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(n));
                let weights = [1.0 - u - v, u, v];
                self.push(patch.at(weights), corners, weights);
            }
        }
        // The vertex that is i steps of n toward b and j toward c.
        let at = |i: u32, j: u32| match (i, j) {
            (0, 0) => a,
            (i, 0) if i == n => b,
            (0, j) if j == n => c,
            (i, 0) => along(edges[0], i, n),
            (0, j) => along(edges[1], j, n),
            (i, j) if i + j == n => along(edges[2], j, n),
            // Rows of n - 2, n - 3, ...
            (i, j) => inside + (j - 1) * (2 * n - 2 - j) / 2 + i - 1,
        };
        for j in 0..n {
            for i in 0..n - j {
                self.parts.triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    self.parts.triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }

    /// The vertices between two others: the index of the first, and `true` if they go from `a` to `b`.
    fn edge(&mut self, a: u32, b: u32) -> (u32, bool) {
        // By position: at a seam of the texture coordinates two edges have the same position, and computing from the
        // same end gives the same bits.
        let place = |end: u32| (self.mesh.positions[end as usize], end);
        let forward = place(a) <= place(b);
        let ends @ [from, to] = if forward { [a, b] } else { [b, a] };
        if let Some(&first) = self.edges.get(&ends) {
            return (first, forward);
        }
        let first = self.parts.positions.len() as u32;
        // The common border of all patches at this edge.
        let corners = [from, to, to];
        let patch = Patch::new(corners.map(|end| self.corner(end)));
        for k in 1..self.pieces {
            let t = f64::from(k) / f64::from(self.pieces);
            let weights = [1.0 - t, t, 0.0];
            self.push(patch.at(weights), corners, weights);
        }
        self.edges.insert(ends, first);
        (first, forward)
    }

    fn corner(&self, index: u32) -> (DVec3, DVec3) {
        let normals = self.mesh.normals.as_ref().expect("normals were made");
        (wide(self.mesh.positions[index as usize]), wide(normals[index as usize]))
    }

    /// Adds a vertex whose attributes are weighted means of those of three others.
    fn push(&mut self, position: DVec3, corners: [u32; 3], weights: [f64; 3]) {
        let Parts { positions, normals, uvs, tangents, .. } = &mut self.parts;
        let blend = |of: &dyn Fn(usize) -> DVec3| -> DVec3 {
            corners.iter().zip(weights).map(|(&corner, weight)| of(corner as usize) * weight).sum()
        };
        positions.push(narrow(position));
        let normals = normals.as_mut().expect("normals were made");
        let normal = unit(blend(&|corner| wide(normals[corner])));
        normals.push(narrow(normal));
        if let Some(uvs) = uvs {
            let uv = blend(&|corner| DVec3::new(uvs[corner][0].into(), uvs[corner][1].into(), 0.0));
            uvs.push([uv.x as f32, uv.y as f32]);
        }
        if let Some(tangents) = tangents {
            let tangent = blend(&|corner| {
                let [x, y, z, _] = tangents[corner];
                wide([x, y, z])
            });
            let flat = tangent - normal * tangent.dot(normal);
            let [x, y, z] = narrow(flat.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector()));
            tangents.push([x, y, z, tangents[corners[0] as usize][3]]);
        }
    }
}

/// The vertex at step `k` of `n` along an edge, given the index of the first vertex of the edge and the direction in
/// which they go.
fn along((first, forward): (u32, bool), k: u32, n: u32) -> u32 {
    first + if forward { k } else { n - k } - 1
}

/// The control point of an edge next to `from`: a third of the way, projected onto the plane given by the normal there.
fn toward(from: (DVec3, DVec3), to: (DVec3, DVec3)) -> DVec3 {
    let way = to.0 - from.0;
    from.0 + (way - from.1 * way.dot(from.1)) / 3.0
}

/// The control points of a triangle: its corners, two for each edge in order from its first corner, and the middle.
struct Patch {
    corners: [DVec3; 3],
    edges: [[DVec3; 2]; 3],
    middle: DVec3,
}

impl Patch {
    fn new(corners: [(DVec3, DVec3); 3]) -> Patch {
        let edges = [0, 1, 2].map(|k| {
            let [from, to] = [corners[k], corners[(k + 1) % 3]];
            [toward(from, to), toward(to, from)]
        });
        let corners = corners.map(|(position, _)| position);
        let rim: DVec3 = edges.iter().flatten().sum::<DVec3>() / 6.0;
        let centre: DVec3 = corners.iter().sum::<DVec3>() / 3.0;
        Patch { corners, edges, middle: rim + (rim - centre) / 2.0 }
    }

    fn at(&self, weights: [f64; 3]) -> DVec3 {
        let mut point = self.middle * (6.0 * weights[0] * weights[1] * weights[2]);
        for k in 0..3 {
            let [a, b] = [weights[k], weights[(k + 1) % 3]];
            point += self.corners[k] * (a * a * a);
            point += self.edges[k][0] * (3.0 * a * a * b) + self.edges[k][1] * (3.0 * a * b * b);
        }
        point
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    /// The largest distance between the centre of a triangle and the unit sphere.
    fn depth(mesh: &Geometry) -> f64 {
        let middle =
            |corners: &[u32; 3]| corners.iter().map(|&c| wide(mesh.positions[c as usize])).sum::<DVec3>() / 3.0;
        mesh.triangles.iter().map(|corners| (1.0 - middle(corners).length()).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_coarse_sphere_becomes_round() {
        let coarse = shapes::sphere(1.0, 16);
        for pieces in [2, 3, 5] {
            let fine = coarse.clone().refined(pieces).expect("a sphere");
            let square = (pieces * pieces) as usize;
            assert_eq!(fine.triangles.len(), square * coarse.triangles.len());
            // The error of a chord falls with the square of its length; a hundredth of it is left to the cubic.
            assert!(
                depth(&fine) < 1.2 * depth(&coarse) / square as f64 + 2e-3,
                "{} of {}",
                depth(&fine),
                depth(&coarse)
            );
            for (position, normal) in fine.positions.iter().zip(fine.normals.as_ref().expect("normals")) {
                assert!(wide(*position).normalize().dot(wide(*normal)) > 0.9999, "{position:?} {normal:?}");
            }
            let area = 4.0 * std::f64::consts::PI;
            assert!((fine.area() - area).abs() < (coarse.area() - area).abs() / 2.0);
        }
    }

    #[test]
    fn neighbours_stay_connected() {
        // Every edge of a closed surface has two triangles, which pass it in opposite directions; vertices at the same
        // place count as one, such as those at the seam of texture coordinates.
        let fine = shapes::torus_knot(2, 3, 0.2, 40, 8).refined(4).expect("a knot");
        let place = |index: u32| fine.positions[index as usize].map(|x| (x + 0.0).to_bits());
        let mut edges = HashMap::new();
        for corners in &fine.triangles {
            for k in 0..3 {
                let [a, b] = [place(corners[k]), place(corners[(k + 1) % 3])];
                *edges.entry(if a < b { [a, b] } else { [b, a] }).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|&count| count == 0));
    }

    #[test]
    fn copies_of_an_edge_have_the_same_bits() {
        // As at a seam: two triangles that share no vertices and number the ends of their common edge in opposite
        // orders.
        let ([a, b], [m, n]) = ([[0.13, 0.71, -0.29], [1.37, -0.23, 0.41]], [[0.6, 0.8, 0.0], [0.0, 0.6, 0.8]]);
        for pieces in 2..20 {
            let parts = Parts {
                positions: vec![a, b, [0.3, 0.9, 1.1], b, a, [0.9, -0.7, -1.3]],
                normals: Some(vec![m, n, m, n, m, n]),
                triangles: vec![[0, 1, 2], [3, 4, 5]],
                ..Parts::default()
            };
            let fine = Geometry::new(parts).expect("two triangles").refined(pieces).expect("more of them");
            let places: std::collections::HashSet<_> = fine.positions.iter().map(|p| p.map(f32::to_bits)).collect();
            assert_eq!(places.len(), fine.positions.len() - (pieces as usize + 1), "{pieces} pieces");
        }
    }

    #[test]
    fn a_flat_mesh_stays_as_it_is() {
        let plane = shapes::plane(2.0, 2);
        let fine = plane.clone().refined(3).expect("a plane");
        assert!((fine.area() - plane.area()).abs() < 1e-6);
        let (uvs, tangents) = (fine.uvs.as_ref().expect("uvs"), fine.tangents.as_ref().expect("tangents"));
        for ((p, uv), tangent) in fine.positions.iter().zip(uvs).zip(tangents) {
            assert_eq!(*tangent, [1.0, 0.0, 0.0, 1.0]);
            assert!(
                (uv[0] - (p[0] + 1.0) / 2.0).abs() < 1e-6 && (uv[1] - (1.0 - p[2]) / 2.0).abs() < 1e-6,
                "{p:?} {uv:?}"
            );
        }
        assert_eq!(fine.groups[0].triangles, 0..fine.triangles.len() as u32);
        assert_eq!(plane.clone().refined(1).expect("the same"), plane);
        let nothing = Geometry::new(Parts::default()).expect("an empty mesh");
        assert!(nothing.refined(u32::MAX).expect("nothing").triangles.is_empty());
    }

    #[test]
    fn too_many_triangles_are_refused() {
        let error = shapes::sphere(1.0, 64).refined(2000).expect_err("more than 32 bits can count");
        assert!(matches!(error, GeometryError::TooMany { what: "triangles", .. }), "{error}");
    }
}
