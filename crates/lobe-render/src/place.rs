//! Where a mesh stands in the world.

use std::collections::BTreeMap;

use lobe_mesh::Geometry;

use crate::vec3::{Vec3, add, cross, dot, scale, sub, unit};
use crate::world::Shape;

/// Scaled and turned, then moved.
pub(crate) struct Place {
    /// Images of the axes, equally long and perpendicular.
    pub axes: [Vec3; 3],
    pub translate: Vec3,
}

impl Place {
    /// The axes of something that stands as it was made.
    pub const UPRIGHT: [Vec3; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn direction(&self, [x, y, z]: Vec3) -> Vec3 {
        let [a, b, c] = self.axes;
        add(add(scale(a, x), scale(b, y)), scale(c, z))
    }

    /// Triangles of a mesh that has normals and tangents, with the vertices that they need.
    pub fn shape(&self, geometry: &Geometry, triangles: Vec<[u32; 3]>) -> Shape {
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        let mut shape = Shape::default();
        let (normals, tangents) = (geometry.normals.as_deref(), geometry.tangents.as_deref());
        for corners in triangles {
            shape.triangles.push(corners.map(|old| {
                *numbers.entry(old).or_insert_with(|| {
                    let at = old as usize;
                    let normal = normals.map_or([0.0, 0.0, 1.0], |normals| normals[at]);
                    let normal = unit(self.direction(normal)).unwrap_or(normal);
                    let [x, y, z, w] = tangents.map_or([1.0, 0.0, 0.0, 1.0], |tangents| tangents[at]);
                    let along = self.direction([x, y, z]);
                    let [x, y, z] = unit(sub(along, scale(normal, dot(along, normal))))
                        .unwrap_or_else(|| cross(normal, [normal[1], normal[2], normal[0]]));
                    shape.positions.push(add(self.direction(geometry.positions[at]), self.translate));
                    shape.normals.push(normal);
                    shape.tangents.push([x, y, z, w]);
                    shape.positions.len() as u32 - 1
                })
            }));
        }
        shape
    }
}
