//! Computes tangents from texture coordinates by MikkTSpace, as most other programs do.
//!
//! Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008; glTF 2.0 requires the same algorithm.

use std::collections::HashMap;

use bevy_mikktspace::{Ops, TangentSpace, generate_tangents};

use crate::geometry::{Parts, narrow, wide};
use crate::{Geometry, Shading};

impl Geometry {
    /// The mesh with missing attributes added: smooth normals, then tangents if there are texture coordinates.
    pub fn complete(self) -> Geometry {
        let geometry = if self.normals.is_some() { self } else { self.with_normals(Shading::Smooth) };
        if geometry.tangents.is_some() || geometry.uvs.is_none() { geometry } else { geometry.with_tangents() }
    }

    /// The mesh with tangents recomputed from its texture coordinates and normals (smooth ones if it has none).
    ///
    /// A vertex at which texture coordinates are mirrored has two tangents and is duplicated. Without texture
    /// coordinates there are no tangents.
    pub fn with_tangents(self) -> Geometry {
        let geometry = if self.normals.is_some() { self } else { self.with_normals(Shading::Smooth) };
        let mut parts = geometry.into_parts();
        parts.tangents = None;
        if let Some(corners) = corners(&parts) {
            assign(&mut parts, &corners);
        }
        Geometry::new(parts).expect("unit tangents, and vertices duplicated with all their attributes")
    }
}

/// The elementary functions of MikkTSpace, the same on every machine.
struct Portable;

impl Ops for Portable {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        libm::acos(x.into()) as f32
    }
}

/// The input of MikkTSpace, and its output: a tangent for every corner of every triangle.
struct Corners<'a> {
    triangles: &'a [[u32; 3]],
    positions: &'a [[f32; 3]],
    normals: &'a [[f32; 3]],
    uvs: &'a [[f32; 2]],
    tangents: Vec<[Option<[f32; 4]>; 3]>,
}

impl bevy_mikktspace::Geometry<Portable> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.positions[self.triangles[face][corner] as usize]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.normals[self.triangles[face][corner] as usize]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.uvs[self.triangles[face][corner] as usize]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        self.tangents[face][corner] = space.map(|space| space.tangent_encoded());
    }
}

/// The tangent of every corner; `None` without texture coordinates or normals.
fn corners(parts: &Parts) -> Option<Vec<[Option<[f32; 4]>; 3]>> {
    let (normals, uvs) = (parts.normals.as_ref()?, parts.uvs.as_ref()?);
    let tangents = vec![[None; 3]; parts.triangles.len()];
    let mut corners = Corners { triangles: &parts.triangles, positions: &parts.positions, normals, uvs, tangents };
    // The error type has no values today, but may have some in later versions.
    generate_tangents(&mut corners).ok()?;
    Some(corners.tangents)
}

/// Assigns the tangents of corners to vertices, and duplicates vertices that have several.
fn assign(parts: &mut Parts, corners: &[[Option<[f32; 4]>; 3]]) {
    let normals = parts.normals.as_mut().expect("with_tangents computes them first");
    let mut tangents: Vec<Option<[f32; 4]>> = vec![None; parts.positions.len()];
    let mut doubles = HashMap::new();
    for (triangle, corners) in parts.triangles.iter_mut().zip(corners) {
        for (index, corner) in triangle.iter_mut().zip(corners) {
            let vertex = *index as usize;
            let Some(tangent) = corner.and_then(|tangent| upright(tangent, normals[vertex])) else { continue };
            match tangents[vertex] {
                None => tangents[vertex] = Some(tangent),
                Some(other) if other == tangent => {}
                Some(_) => {
                    *index = *doubles.entry((vertex, tangent.map(f32::to_bits))).or_insert_with(|| {
                        parts.positions.push(parts.positions[vertex]);
                        normals.push(normals[vertex]);
                        if let Some(uvs) = &mut parts.uvs {
                            uvs.push(uvs[vertex]);
                        }
                        tangents.push(Some(tangent));
                        tangents.len() as u32 - 1
                    });
                }
            }
        }
    }
    let tangent = |(tangent, normal): (Option<[f32; 4]>, &[f32; 3])| tangent.unwrap_or_else(|| any(*normal));
    parts.tangents = Some(tangents.into_iter().zip(&*normals).map(tangent).collect());
}

/// The tangent made exactly perpendicular to the normal, if that is possible.
fn upright([x, y, z, w]: [f32; 4], normal: [f32; 3]) -> Option<[f32; 4]> {
    let (tangent, normal) = (wide([x, y, z]), wide(normal));
    let [x, y, z] = narrow((tangent - normal * tangent.dot(normal)).try_normalize()?);
    Some([x, y, z, w])
}

/// An arbitrary tangent, for vertices whose texture coordinates do not determine one.
fn any(normal: [f32; 3]) -> [f32; 4] {
    let [x, y, z] = narrow(wide(normal).any_orthonormal_vector());
    [x, y, z, 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    fn plain(geometry: Geometry) -> Geometry {
        let mut parts = geometry.into_parts();
        parts.tangents = None;
        Geometry::new(parts).expect("a mesh")
    }

    #[test]
    fn tangents_of_a_sphere_run_along_its_parallels() {
        let exact = shapes::sphere(1.0, 64);
        let made = plain(exact.clone()).complete();
        let (exact, tangents) = (exact.tangents.as_ref().expect("tangents"), made.tangents.as_ref().expect("tangents"));
        assert_eq!(exact.len(), tangents.len(), "a sphere has no mirrored texture");
        for ((p, exact), made) in made.positions.iter().zip(exact).zip(tangents) {
            // Toward the poles triangles get so thin that the mean of their tangents deviates from the parallel.
            if p[1].abs() < 0.9 {
                let cosine = wide([exact[0], exact[1], exact[2]]).dot(wide([made[0], made[1], made[2]]));
                assert!(cosine > 0.999, "{cosine} at {p:?}");
            }
            assert_eq!(made[3], 1.0);
        }
    }

    #[test]
    fn a_mirrored_texture_changes_handedness_and_duplicates_the_seam() {
        // Two unit squares side by side; u runs from both sides to the middle.
        let parts = Parts {
            positions: vec![
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [2.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [1.0, 1.0, 0.0],
                [2.0, 1.0, 0.0],
            ],
            uvs: Some(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.0, 1.0]]),
            triangles: vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]],
            ..Parts::default()
        };
        let made = Geometry::new(parts).expect("a mesh").complete();
        assert_eq!(made.positions.len(), 8);
        let tangents = made.tangents.as_ref().expect("tangents");
        for (triangle, expected) in made.triangles.iter().zip([1.0, 1.0, -1.0, -1.0]) {
            for &index in triangle {
                assert_eq!(tangents[index as usize], [expected, 0.0, 0.0, expected]);
            }
        }
    }

    #[test]
    fn texture_coordinates_without_area_give_some_frame() {
        let mut parts = plain(shapes::plane(1.0, 2)).into_parts();
        parts.uvs = Some(vec![[0.5; 2]; parts.positions.len()]);
        let made = Geometry::new(parts).expect("a mesh").complete();
        let (normals, tangents) = (made.normals.as_ref().expect("normals"), made.tangents.as_ref().expect("tangents"));
        for (n, t) in normals.iter().zip(tangents) {
            assert!(wide(*n).dot(wide([t[0], t[1], t[2]])).abs() < 1e-6);
        }
    }

    #[test]
    fn extreme_numbers_do_not_panic() {
        let huge = f32::MAX;
        let parts = Parts {
            positions: vec![[huge, 0.0, -huge], [0.0, huge, 1.0], [-huge, 1e-40, huge], [1e-40; 3]],
            uvs: Some(vec![[huge, -huge], [-huge, huge], [0.0, 1e-40], [huge, huge]]),
            triangles: vec![[0, 1, 2], [2, 1, 3], [3, 3, 3], [0, 3, 1]],
            ..Parts::default()
        };
        assert!(Geometry::new(parts).expect("a mesh").complete().tangents.is_some());
    }
}
