//! A checked triangle mesh.

use std::ops::{Deref, Range};

use glam::DVec3;

/// A run of triangles with a name, and the material that its file names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Group {
    /// Name of the object or group, empty if the file has none.
    pub name: String,
    /// Name of the material, if the file has one.
    pub material: Option<String>,
    /// The triangles, as a range of indices into [`Parts::triangles`].
    pub triangles: Range<u32>,
}

/// The parts of a mesh, not yet checked; [`Geometry::new`] checks them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// Vertex positions.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one per vertex.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates (u, v), v up, one per vertex.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// Unit tangents along dp/du with the handedness (+1 or -1) in the fourth component, one per vertex.
    pub tangents: Option<Vec<[f32; 4]>>,
    /// Triangles: three vertex indices, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Groups, which divide the triangles in order and without gaps. If there are none, all triangles are in one group
    /// without a name.
    pub groups: Vec<Group>,
}

/// A triangle mesh. It dereferences to [`Parts`], through which its content is read.
///
/// All indices are in range, all numbers are finite, all attributes are as long as the positions, normals and tangents
/// are of unit length, and the groups divide the triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry(Parts);

/// The reason why parts do not make a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// An attribute is not as long as the positions.
    #[error("found {found} {attribute}; expected {expected}, one per vertex")]
    Length {
        /// Name of the attribute.
        attribute: &'static str,
        /// Its length.
        found: usize,
        /// Number of vertices.
        expected: usize,
    },
    /// A number is infinite or not a number.
    #[error("found {value} in the {attribute} of vertex {vertex}; expected finite numbers")]
    NotFinite {
        /// Name of the attribute.
        attribute: &'static str,
        /// Index of the vertex.
        vertex: usize,
        /// The number.
        value: f32,
    },
    /// A normal or a tangent is not of unit length.
    #[error("found length {length} of the {attribute} of vertex {vertex}; expected 1")]
    NotUnit {
        /// Name of the attribute.
        attribute: &'static str,
        /// Index of the vertex.
        vertex: usize,
        /// The length found.
        length: f64,
    },
    /// The fourth component of a tangent is neither +1 nor -1.
    #[error("found handedness {found} in the tangent of vertex {vertex}; expected 1 or -1")]
    Handedness {
        /// Index of the vertex.
        vertex: usize,
        /// The fourth component.
        found: f32,
    },
    /// A triangle refers to a vertex that is not there.
    #[error("found vertex {index} in triangle {triangle}; expected less than {vertices}, the number of vertices")]
    Index {
        /// Index of the triangle.
        triangle: usize,
        /// The vertex it refers to.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// More vertices or triangles than 32 bits can count.
    #[error("found {found} {what}; expected less than 2^32")]
    TooMany {
        /// `vertices` or `triangles`.
        what: &'static str,
        /// Their number.
        found: usize,
    },
    /// Groups have gaps, overlap, or are not in order.
    #[error("found triangles {found:?} in group {group}; expected a range from {start} to at most {triangles}")]
    Group {
        /// Index of the group.
        group: usize,
        /// Its range.
        found: Range<u32>,
        /// The triangle with which it should begin.
        start: u32,
        /// Number of triangles.
        triangles: usize,
    },
    /// Triangles after the last group.
    #[error("found groups up to triangle {found}; expected up to {triangles}, the number of triangles")]
    Ungrouped {
        /// End of the last group.
        found: u32,
        /// Number of triangles.
        triangles: usize,
    },
}

/// How far from 1 the square of the length of a normal may be: the rounding error of three bytes or half precision.
const UNIT: f64 = 4e-3;

impl Deref for Geometry {
    type Target = Parts;

    fn deref(&self) -> &Parts {
        &self.0
    }
}

impl Geometry {
    /// Checks parts and makes a mesh from them.
    ///
    /// # Errors
    /// The first fault found.
    pub fn new(mut parts: Parts) -> Result<Geometry, GeometryError> {
        let vertices = parts.positions.len();
        for (what, found) in [("vertices", vertices), ("triangles", parts.triangles.len())] {
            if u32::try_from(found).is_err() {
                return Err(GeometryError::TooMany { what, found });
            }
        }
        finite("position", &parts.positions, vertices)?;
        if let Some(normals) = &parts.normals {
            finite("normal", normals, vertices)?;
            unit("normal", normals.iter().copied())?;
        }
        if let Some(uvs) = &parts.uvs {
            finite("texture coordinates", uvs, vertices)?;
        }
        if let Some(tangents) = &parts.tangents {
            finite("tangent", tangents, vertices)?;
            unit("tangent", tangents.iter().map(|&[x, y, z, _]| [x, y, z]))?;
            if let Some(vertex) = tangents.iter().position(|tangent| tangent[3].abs() != 1.0) {
                return Err(GeometryError::Handedness { vertex, found: tangents[vertex][3] });
            }
        }
        for (triangle, corners) in parts.triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= vertices) {
                return Err(GeometryError::Index { triangle, index, vertices });
            }
        }
        if parts.groups.is_empty() {
            parts.groups.push(Group { triangles: 0..parts.triangles.len() as u32, ..Group::default() });
        }
        grouped(&parts.groups, parts.triangles.len())?;
        Ok(Geometry(parts))
    }

    /// Returns the parts, to change them.
    pub fn into_parts(self) -> Parts {
        self.0
    }

    /// Lowest and highest corner of the bounding box of all positions; `None` without vertices.
    pub fn bounds(&self) -> Option<([f32; 3], [f32; 3])> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(low, high), p| {
            (std::array::from_fn(|i| low[i].min(p[i])), std::array::from_fn(|i| high[i].max(p[i])))
        }))
    }

    /// Total area of all triangles.
    pub fn area(&self) -> f64 {
        self.triangles.iter().map(|&corners| cross(&self.positions, corners).length() / 2.0).sum()
    }
}

/// Cross product of two edges of a triangle: its normal, with a length of twice its area.
pub(crate) fn cross(positions: &[[f32; 3]], corners: [u32; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|index| wide(positions[index as usize]));
    (b - a).cross(c - a)
}

/// A vector in double precision.
pub(crate) fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::new(v[0].into(), v[1].into(), v[2].into())
}

/// A vector rounded to single precision.
pub(crate) fn narrow(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

fn finite<const N: usize>(attribute: &'static str, values: &[[f32; N]], vertices: usize) -> Result<(), GeometryError> {
    if values.len() != vertices {
        return Err(GeometryError::Length { attribute, found: values.len(), expected: vertices });
    }
    for (vertex, value) in values.iter().enumerate() {
        if let Some(&value) = value.iter().find(|number| !number.is_finite()) {
            return Err(GeometryError::NotFinite { attribute, vertex, value });
        }
    }
    Ok(())
}

fn unit(attribute: &'static str, vectors: impl Iterator<Item = [f32; 3]>) -> Result<(), GeometryError> {
    for (vertex, vector) in vectors.enumerate() {
        let square = wide(vector).length_squared();
        if (square - 1.0).abs() > UNIT {
            return Err(GeometryError::NotUnit { attribute, vertex, length: square.sqrt() });
        }
    }
    Ok(())
}

fn grouped(groups: &[Group], triangles: usize) -> Result<(), GeometryError> {
    let mut start = 0;
    for (group, Group { triangles: range, .. }) in groups.iter().enumerate() {
        if range.start != start || range.end < range.start || range.end as usize > triangles {
            return Err(GeometryError::Group { group, found: range.clone(), start, triangles });
        }
        start = range.end;
    }
    if start as usize != triangles {
        return Err(GeometryError::Ungrouped { found: start, triangles });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Parts {
        Parts {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Parts::default()
        }
    }

    #[test]
    fn a_square_has_its_area_and_bounds() {
        let square = Geometry::new(square()).expect("a mesh");
        assert_eq!(square.area(), 1.0);
        assert_eq!(square.bounds(), Some(([0.0; 3], [1.0, 1.0, 0.0])));
        assert_eq!(square.groups, [Group { triangles: 0..2, ..Group::default() }]);
        assert_eq!(Geometry::new(Parts::default()).expect("an empty mesh").bounds(), None);
    }

    #[test]
    fn every_fault_has_its_own_error() {
        let fault = |change: &dyn Fn(&mut Parts)| {
            let mut parts = square();
            change(&mut parts);
            Geometry::new(parts).expect_err("a fault")
        };
        let group = |triangles| Group { triangles, ..Group::default() };
        assert_eq!(
            fault(&|p| p.normals = Some(vec![[0.0, 0.0, 1.0]; 3])),
            GeometryError::Length { attribute: "normal", found: 3, expected: 4 }
        );
        assert!(
            matches!(fault(&|p| p.positions[2][1] = f32::NAN), GeometryError::NotFinite { vertex: 2, .. }),
            "not a number"
        );
        assert!(matches!(
            fault(&|p| p.uvs = Some(vec![[f32::INFINITY, 0.0]; 4])),
            GeometryError::NotFinite { attribute: "texture coordinates", vertex: 0, .. }
        ));
        assert_eq!(
            fault(&|p| p.normals = Some(vec![[0.0, 0.0, 2.0]; 4])),
            GeometryError::NotUnit { attribute: "normal", vertex: 0, length: 2.0 }
        );
        assert_eq!(
            fault(&|p| p.tangents = Some(vec![[1.0, 0.0, 0.0, 0.0]; 4])),
            GeometryError::Handedness { vertex: 0, found: 0.0 }
        );
        assert_eq!(fault(&|p| p.triangles[1][2] = 4), GeometryError::Index { triangle: 1, index: 4, vertices: 4 });
        assert_eq!(
            fault(&|p| p.groups = vec![group(0..1), group(0..2)]),
            GeometryError::Group { group: 1, found: 0..2, start: 1, triangles: 2 }
        );
        assert!(matches!(fault(&|p| p.groups = vec![group(0..3)]), GeometryError::Group { .. }));
        assert_eq!(fault(&|p| p.groups = vec![group(0..1)]), GeometryError::Ungrouped { found: 1, triangles: 2 });
    }
}
