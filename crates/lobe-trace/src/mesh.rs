//! Triangles as supplied by a user.

/// The largest magnitude of a coordinate of a vertex, of a ray's origin, and the bounds of a ray's direction
/// (`1 / LIMIT ..= LIMIT` for its largest component): within these bounds, no intermediate result overflows an `f32`.
pub const LIMIT: f32 = 1_099_511_627_776.0;

/// An invalid mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A coordinate is NaN, infinite or beyond [`LIMIT`].
    #[error("vertex {vertex} has {found} as its coordinate {axis}, expected a number of magnitude up to {LIMIT:e}")]
    Coordinate {
        /// The index of the vertex.
        vertex: usize,
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// The coordinate.
        found: f32,
    },
    /// A corner names a vertex that does not exist.
    #[error("corner {corner} of triangle {triangle} is vertex {found}, expected one below {vertices}")]
    Index {
        /// The index of the triangle.
        triangle: usize,
        /// 0, 1 or 2.
        corner: usize,
        /// The index.
        found: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// More triangles than lane integers can count.
    #[error("{found} triangles in one mesh, expected at most {}", Mesh::MAX_TRIANGLES)]
    TooMany {
        /// The number of triangles.
        found: usize,
    },
}

/// An indexed triangle mesh whose numbers have been checked. Zero-area triangles are allowed; no ray hits them.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The most triangles of one mesh that a leaf reference of the tree can count.
    pub const MAX_TRIANGLES: usize = 1 << 28;

    /// A mesh of vertices `[x, y, z]` and triangles of three vertex indices each.
    ///
    /// # Errors
    /// If a coordinate is NaN or beyond [`LIMIT`], or an index is out of range.
    pub fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        for (vertex, position) in positions.iter().enumerate() {
            for (axis, &found) in position.iter().enumerate() {
                if found.is_nan() || found.abs() > LIMIT {
                    return Err(MeshError::Coordinate { vertex, axis, found });
                }
            }
        }
        if triangles.len() > Self::MAX_TRIANGLES {
            return Err(MeshError::TooMany { found: triangles.len() });
        }
        let vertices = positions.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            for (corner, &found) in corners.iter().enumerate() {
                if found as usize >= vertices {
                    return Err(MeshError::Index { triangle, corner, found, vertices });
                }
            }
        }
        Ok(Mesh { positions, triangles })
    }

    /// The vertices.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// The triangles, as indices of vertices.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The three vertices of a triangle.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[inline]
    pub fn corners(&self, triangle: usize) -> [[f32; 3]; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }
}
