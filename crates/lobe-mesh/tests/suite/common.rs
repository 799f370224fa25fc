//! Shared by the tests of meshes.

use std::collections::HashMap;

use glam::DVec3;
use lobe_mesh::Geometry;

pub fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}

/// Corners of a triangle.
pub fn corners(geometry: &Geometry, triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|index| wide(geometry.positions[index as usize]))
}

/// Edges that are not used exactly once in each direction: holes, and triangles of the wrong orientation. Vertices at
/// the same place count as one.
pub fn open_edges(geometry: &Geometry) -> usize {
    let place = |index: u32| geometry.positions[index as usize].map(|x| (x + 0.0).to_bits());
    let mut uses: HashMap<_, [u32; 2]> = HashMap::new();
    for &[a, b, c] in &geometry.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (place(from), place(to));
            let (key, way) = if from < to { ((from, to), 0) } else { ((to, from), 1) };
            uses.entry(key).or_default()[way] += 1;
        }
    }
    uses.values().filter(|&&uses| uses != [1, 1]).count()
}

/// Asserts that every triangle agrees with the normals and tangents of its corners: its normal, and dp/du and dp/dv
/// from its texture coordinates, point in their direction. `cosine` says how closely.
pub fn assert_frames(geometry: &Geometry, cosine: f64) {
    let normals = geometry.normals.as_ref().expect("normals");
    let tangents = geometry.tangents.as_ref().expect("tangents");
    let uvs = geometry.uvs.as_ref().expect("texture coordinates");
    for &triangle in &geometry.triangles {
        let [a, b, c] = corners(geometry, triangle);
        let [s, t, r] = triangle.map(|index| uvs[index as usize].map(f64::from));
        let (ab, ac) = (b - a, c - a);
        let [du1, dv1, du2, dv2] = [t[0] - s[0], t[1] - s[1], r[0] - s[0], r[1] - s[1]];
        let area = du1 * dv2 - du2 * dv1;
        let (along_u, along_v) = ((ab * dv2 - ac * dv1) / area, (ac * du1 - ab * du2) / area);
        for index in triangle {
            let normal = wide(normals[index as usize]);
            let [x, y, z, hand] = tangents[index as usize];
            let tangent = wide([x, y, z]);
            assert!(normal.dot(ab.cross(ac).normalize()) > cosine, "normal of {index} in {triangle:?}");
            assert!(normal.dot(tangent).abs() < 1e-5, "tangent of {index} is not in the surface");
            assert!(tangent.dot(along_u.normalize()) > cosine, "dp/du of {index} in {triangle:?}");
            let across = normal.cross(tangent) * f64::from(hand);
            assert!(across.dot(along_v.normalize()) > cosine, "dp/dv of {index} in {triangle:?}");
        }
    }
}
