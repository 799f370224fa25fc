//! The position and orientation of a mesh in the world.

use lobe_mesh::Geometry;

use crate::vec3::{Vec3, add, dot, perpendicular, scale, sub, unit};
use crate::world::Shape;

/// Scales and rotates, then moves.
pub(crate) struct Transform {
    /// Images of the axes, equally long and perpendicular.
    pub axes: [Vec3; 3],
    pub translate: Vec3,
}

impl Transform {
    /// The identity.
    pub const IDENTITY: [Vec3; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn direction(&self, [x, y, z]: Vec3) -> Vec3 {
        let [a, b, c] = self.axes;
        add(add(scale(a, x), scale(b, y)), scale(c, z))
    }

    /// Triangles of a mesh that has normals and tangents, with the vertices that they need.
    pub fn shape(&self, geometry: &Geometry, triangles: Vec<[u32; 3]>) -> Shape {
        const NONE: u32 = u32::MAX;
        let mut numbers = vec![NONE; geometry.positions.len()];
        let mut shape = Shape::default();
        for corners in triangles {
            let corners = corners.map(|old| {
                let number = &mut numbers[old as usize];
                if *number == NONE {
                    *number = shape.positions.len() as u32;
                    self.vertex(geometry, old as usize, &mut shape);
                }
                *number
            });
            shape.triangles.push(corners);
        }
        shape
    }

    /// Adds a vertex of a mesh to a shape.
    fn vertex(&self, geometry: &Geometry, at: usize, shape: &mut Shape) {
        let normal = geometry.normals.as_ref().map_or([0.0, 0.0, 1.0], |normals| normals[at]);
        let normal = unit(self.direction(normal)).unwrap_or(normal);
        let [x, y, z, w] = geometry.tangents.as_ref().map_or([1.0, 0.0, 0.0, 1.0], |tangents| tangents[at]);
        let along = self.direction([x, y, z]);
        let flat = sub(along, scale(normal, dot(along, normal)));
        let [x, y, z] = unit(flat).unwrap_or_else(|| perpendicular(normal));
        shape.positions.push(add(self.direction(geometry.positions[at]), self.translate));
        shape.normals.push(normal);
        shape.tangents.push([x, y, z, w]);
    }
}
