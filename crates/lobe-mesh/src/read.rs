//! Opening a mesh whatever its format.

use std::path::Path;

use lobe_files::FormatError;

use crate::{Geometry, file, gltf, obj, ply};

/// Reads a mesh: PLY and binary glTF by their first bytes, glTF and OBJ by the name of the file (`.gltf`, `.obj`).
///
/// Normals and tangents that the file has not are not added; [`Geometry::complete`] does.
///
/// # Errors
/// The file cannot be read, is of another format, or is wrong; the error says where and what was expected.
pub fn read(path: &Path) -> Result<Geometry, FormatError> {
    let bytes = file::bytes(path)?;
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    if bytes.starts_with(b"ply") {
        ply::parse(path, &bytes)
    } else if bytes.starts_with(b"glTF") || extension == "gltf" {
        gltf::parse(path, &bytes)
    } else if extension == "obj" {
        obj::parse(path, &bytes)
    } else {
        Err(file::wrong(path, "a file of another kind", "PLY, OBJ (.obj) or glTF (.gltf, .glb)"))
    }
}
