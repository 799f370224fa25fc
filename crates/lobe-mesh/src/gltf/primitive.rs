//! Reads one primitive of a mesh (section 3.7.2).

use lobe_files::FormatError;

use super::document::{Primitive, Target};
use super::{Budget, Source};
use crate::Parts;
use crate::file::wrong;

impl Source<'_> {
    /// The parts of a primitive in its own coordinates, with its morph targets added in these shares; `None` for points
    /// and lines.
    pub fn primitive(
        &self,
        primitive: &Primitive,
        shares: &[f64],
        budget: &mut Budget<'_>,
    ) -> Result<Option<Parts>, FormatError> {
        let mode = primitive.mode.unwrap_or(4);
        if mode < 4 {
            return Ok(None);
        }
        if mode > 6 {
            return Err(wrong(self.path, format!("mode {mode} of a primitive"), "0 to 6"));
        }
        let Some(position) = primitive.attributes.position else { return Ok(None) };
        let positions: Vec<[f32; 3]> = self.vectors(position, budget)?;
        // The specification says zeros, but they are no mesh: its values are in an extension.
        let accessor = self.item(&self.document.accessors, position, "accessor")?;
        if accessor.buffer_view.is_none() && accessor.sparse.is_none() {
            let found = format!("no positions in accessor {position}");
            return Err(wrong(self.path, found, "a bufferView: export the mesh without compression"));
        }
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
        let mut parts = Parts {
            normals: self.attribute(attributes.normal, &positions, budget)?,
            uvs,
            tangents: self.attribute(attributes.tangent, &positions, budget)?,
            triangles: triangles(&corners, mode),
            positions,
            groups: Vec::new(),
        };
        for (target, &share) in primitive.targets.iter().zip(shares).filter(|(_, share)| **share != 0.0) {
            self.morph(&mut parts, target, share as f32, budget)?;
        }
        Ok(Some(parts))
    }

    /// Adds a share of the displacements of a morph target.
    fn morph(
        &self,
        parts: &mut Parts,
        target: &Target,
        share: f32,
        budget: &mut Budget<'_>,
    ) -> Result<(), FormatError> {
        let add = |to: &mut [f32], by: [f32; 3]| to.iter_mut().zip(by).for_each(|(to, by)| *to += share * by);
        if let Some(by) = self.attribute(target.position, &parts.positions, budget)? {
            parts.positions.iter_mut().zip(by).for_each(|(to, by)| add(to, by));
        }
        if let Some(by) = self.attribute(target.normal, &parts.positions, budget)? {
            parts.normals.iter_mut().flatten().zip(by).for_each(|(to, by)| add(to, by));
        }
        if let Some(by) = self.attribute(target.tangent, &parts.positions, budget)? {
            parts.tangents.iter_mut().flatten().zip(by).for_each(|(to, by)| add(&mut to[..3], by));
        }
        Ok(())
    }

    /// An attribute, checked to be as long as the positions.
    pub fn attribute<const N: usize>(
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
