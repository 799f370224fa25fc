//! Reads one primitive of a mesh (section 3.7.2).

use lobe_files::FormatError;

use super::document::Primitive;
use super::{Budget, Source};
use crate::Parts;
use crate::file::wrong;

impl Source<'_> {
    /// The parts of a primitive in its own coordinates; `None` for points and lines.
    pub fn primitive(&self, primitive: &Primitive, budget: &mut Budget<'_>) -> Result<Option<Parts>, FormatError> {
        let mode = primitive.mode.unwrap_or(4);
        if mode < 4 {
            return Ok(None);
        }
        let Some(position) = primitive.attributes.position else { return Ok(None) };
        let positions: Vec<[f32; 3]> = self.vectors(position, budget)?;
        let corners = match primitive.indices {
            Some(indices) => self.indices(indices, budget)?,
            None => {
                budget.take(positions.len(), size_of::<u32>())?;
                (0..positions.len() as u32).collect()
            }
        };
        if let Some(corner) = corners.iter().find(|&&corner| corner as usize >= positions.len()) {
            return Err(wrong(
                self.path,
                format!("index {corner} in accessor {}", primitive.indices.unwrap_or_default()),
                format!("less than {}, the number of vertices of accessor {position}", positions.len()),
            ));
        }
        budget.take(corners.len(), size_of::<[u32; 3]>())?;
        let attributes = &primitive.attributes;
        // v points up here, and downward in glTF.
        let uvs = self.attribute(attributes.texcoord, &positions, budget)?;
        let uvs = uvs.map(|uvs| uvs.into_iter().map(|[u, v]: [f32; 2]| [u, 1.0 - v]).collect());
        Ok(Some(Parts {
            normals: self.attribute(attributes.normal, &positions, budget)?,
            uvs,
            tangents: self.attribute(attributes.tangent, &positions, budget)?,
            triangles: triangles(&corners, mode),
            positions,
            groups: Vec::new(),
        }))
    }

    /// An attribute, checked to be as long as the positions.
    fn attribute<const N: usize>(
        &self,
        accessor: Option<usize>,
        positions: &[[f32; 3]],
        budget: &mut Budget<'_>,
    ) -> Result<Option<Vec<[f32; N]>>, FormatError> {
        let Some(accessor) = accessor else { return Ok(None) };
        let vectors = self.vectors(accessor, budget)?;
        if vectors.len() != positions.len() {
            let found = format!("{} elements in accessor {accessor}", vectors.len());
            return Err(wrong(self.path, found, format!("{}, one per vertex", positions.len())));
        }
        Ok(Some(vectors))
    }
}

/// Triangles of a list (mode 4), a strip (5) or a fan (6). Leftover corners are ignored, as the specification requires.
fn triangles(corners: &[u32], mode: u32) -> Vec<[u32; 3]> {
    let count = corners.len().saturating_sub(2);
    match mode {
        // Every second triangle of a strip has the opposite orientation.
        5 => (0..count).map(|i| [corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]]).collect(),
        6 => (0..count).map(|i| [corners[i + 1], corners[i + 2], corners[0]]).collect(),
        _ => corners.as_chunks().0.to_vec(),
    }
}
