//! Builds meshes from patches: grids of vertices over a rectangle of (u, v).

use glam::DVec3;

use crate::geometry::{narrow, wide};
use crate::{Geometry, Group, Parts};

/// A vertex before rounding.
pub(crate) struct Vertex {
    pub position: DVec3,
    pub normal: DVec3,
    /// Along dp/du.
    pub tangent: DVec3,
    pub uv: [f64; 2],
}

/// A mesh that grows patch by patch.
#[derive(Default)]
pub(crate) struct Builder {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    tangents: Vec<[f32; 4]>,
    uvs: Vec<[f32; 2]>,
    triangles: Vec<[u32; 3]>,
    groups: Vec<Group>,
}

impl Builder {
    /// Adds a grid of `columns` by `rows` cells with corners `vertex(i, j)`; i grows with u and j with v, and dp/du x
    /// dp/dv points outward. Triangles without area, such as those at poles, are left out.
    pub fn patch(&mut self, columns: usize, rows: usize, vertex: impl Fn(usize, usize) -> Vertex) {
        let first = self.positions.len();
        for j in 0..=rows {
            for i in 0..=columns {
                let Vertex { position, normal, tangent, uv } = vertex(i, j);
                let [x, y, z] = narrow(tangent);
                self.positions.push(narrow(position));
                self.normals.push(narrow(normal));
                self.tangents.push([x, y, z, 1.0]);
                self.uvs.push(uv.map(|x| x as f32));
            }
        }
        let index = |i: usize, j: usize| (first + j * (columns + 1) + i) as u32;
        for j in 0..rows {
            for i in 0..columns {
                let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
                for triangle in [[a, b, c], [a, c, d]] {
                    let [p, q, r] = triangle.map(|index| wide(self.positions[index as usize]));
                    if p != q && q != r && r != p {
                        self.triangles.push(triangle);
                    }
                }
            }
        }
    }

    /// Ends a group: it gets all triangles since the end of the last one.
    pub fn group(&mut self, name: &str) {
        let start = self.groups.last().map_or(0, |group| group.triangles.end);
        let triangles = start..self.triangles.len() as u32;
        self.groups.push(Group { name: name.into(), material: Some(name.into()), triangles });
    }

    /// The finished mesh.
    pub fn finish(self) -> Geometry {
        Geometry::new(Parts {
            positions: self.positions,
            normals: Some(self.normals),
            uvs: Some(self.uvs),
            tangents: Some(self.tangents),
            triangles: self.triangles,
            groups: self.groups,
        })
        .expect("shapes of finite size are sound")
    }
}
