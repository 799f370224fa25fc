//! Shared by all readers: reading a whole file, and reporting what is wrong with it.

use std::path::Path;

pub(crate) use lobe_files::read as bytes;
use lobe_files::{FormatError, Place};

use crate::geometry::{narrow, wide};
use crate::{Geometry, Parts, normals};

/// An error about the file as a whole.
pub(crate) fn wrong(path: &Path, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
    FormatError::new(path, Place::File, found, expected)
}

/// Makes a mesh of the content of a file. Normals become unit vectors, and a smooth normal replaces one without
/// direction; tangents that do not form a frame are dropped, to be computed later.
pub(crate) fn geometry(path: &Path, mut parts: Parts) -> Result<Geometry, FormatError> {
    if parts.triangles.is_empty() {
        return Err(wrong(path, "no triangles", "a mesh with at least one"));
    }
    // Taken out while positions and triangles are checked, because their replacements are computed from those.
    let (file_normals, file_tangents) = (parts.normals.take(), parts.tangents.take());
    let mut parts = Geometry::new(parts).map_err(|error| unsound(path, &error))?.into_parts();
    if let Some(file_normals) = file_normals {
        let units: Vec<Option<[f32; 3]>> = file_normals.into_iter().map(unit).collect();
        let smooth =
            if units.contains(&None) { normals::smooth(&parts.positions, &parts.triangles) } else { Vec::new() };
        let normal = |(i, unit): (usize, Option<[f32; 3]>)| unit.or(smooth.get(i).copied()).unwrap_or_default();
        parts.normals = Some(units.into_iter().enumerate().map(normal).collect());
        parts.tangents = file_tangents.and_then(|tangents| tangents.into_iter().map(frame).collect());
    }
    Geometry::new(parts).map_err(|error| unsound(path, &error))
}

/// Turns an error of a mesh into an error of its file.
fn unsound(path: &Path, error: &crate::GeometryError) -> FormatError {
    let text = error.to_string();
    let (found, expected) = text.split_once("; expected ").unwrap_or((&text, "a sound mesh"));
    wrong(path, found.trim_start_matches("found "), expected)
}

/// Normalises a vector, if it has a direction. A vector that is already of unit length, up to rounding, stays as it is.
fn unit(vector: [f32; 3]) -> Option<[f32; 3]> {
    let square = wide(vector).length_squared();
    if (square - 1.0).abs() < 1e-6 { Some(vector) } else { wide(vector).try_normalize().map(narrow) }
}

/// A tangent of unit length with its handedness, if it is a valid one.
fn frame([x, y, z, w]: [f32; 4]) -> Option<[f32; 4]> {
    let [x, y, z] = unit([x, y, z])?;
    (w == 1.0 || w == -1.0).then_some([x, y, z, w])
}
