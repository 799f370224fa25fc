//! Opens a mesh of any supported format.

use std::path::Path;

use lobe_files::{FormatError, Unpacked, beginning, content, is_web_page, unpacked};

use crate::{Geometry, file, gltf, obj, ply, serialized};

/// Reads a mesh. PLY, binary glTF and Mitsuba's meshes (`.serialized`) are recognised by their first bytes, glTF and
/// OBJ by the name of the file (`.gltf`, `.obj`). All of them may be compressed with gzip.
///
/// Missing normals and tangents are not added; [`Geometry::complete`] adds them.
///
/// # Errors
/// The file cannot be read, is of another format, or is wrong; the error says where and what was expected.
pub fn read(path: &Path) -> Result<Geometry, FormatError> {
    let packed = file::bytes(path)?;
    let Unpacked { bytes, name } = unpacked(&packed, path)?;
    let extension = name.extension().unwrap_or_default().to_ascii_lowercase();
    let is_page = is_web_page(&bytes);
    if bytes.starts_with(b"ply") {
        ply::parse(path, &bytes)
    } else if bytes.starts_with(&serialized::MAGIC) {
        serialized::parse(path, &bytes)
    } else if bytes.starts_with(b"glTF") || extension == "gltf" {
        gltf::parse(path, &bytes)
    } else if extension == "obj" && !is_page && !bytes.starts_with(b"version https://git-lfs") {
        obj::parse(path, &bytes)
    } else {
        const EXPECTED: &str = "a mesh: PLY, OBJ (.obj), glTF (.gltf, .glb) or Mitsuba (.serialized)";
        Err(match content(&bytes, &name) {
            Some(content) => file::wrong(path, content.what.as_str(), content.expected(EXPECTED)),
            None => file::wrong(path, format!("a file of another kind, {}", beginning(&bytes)), EXPECTED),
        })
    }
}
