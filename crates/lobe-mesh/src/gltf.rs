//! Reads glTF 2.0, as text (`.gltf` with its buffers) and as a single binary file (`.glb`).
//!
//! All meshes of the scene become one mesh, each placed by its node; a group is one primitive of one node, named after
//! the node. Triangles, strips and fans are read, with positions, normals, tangents and the first set of texture
//! coordinates, whose v is turned to point up. Morph targets and skins are applied as the file is at rest: with the weights
//! and the joints of its nodes, without animations. Points and lines are left out. Integers in place of floats
//! (`KHR_mesh_quantization`) are read; compressed meshes are refused.
//!
//! Section numbers in this module refer to the glTF 2.0 specification.

mod accessor;
mod buffers;
mod document;
mod primitive;
mod scene;
mod skin;

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use lobe_files::{FormatError, Place};

use crate::Geometry;
use crate::file::{self, wrong};
use document::Document;

/// Extensions that a file may require, because they say nothing about shapes or are supported.
const KNOWN: [&str; 4] = ["KHR_materials_", "KHR_texture_", "KHR_lights_punctual", "KHR_mesh_quantization"];

/// Reads the meshes of the scene of a glTF file, with the buffers that it names.
///
/// # Errors
/// A file cannot be read, is cut short, refers to something that is missing, or needs more memory than its size
/// justifies.
pub fn read(path: &Path) -> Result<Geometry, FormatError> {
    parse(path, &file::bytes(path)?)
}

/// Reads the content of a glTF file; buffers outside it are looked for next to `path`.
///
/// # Errors
/// The same as for [`read`].
pub fn parse(path: &Path, bytes: &[u8]) -> Result<Geometry, FormatError> {
    let (json, binary) = if bytes.starts_with(b"glTF") { chunks(path, bytes)? } else { (bytes, None) };
    let document: Document = serde_json::from_slice(json).map_err(|error| {
        // A binary file has no lines that an editor would show.
        let place =
            if json.len() == bytes.len() { Place::Line(error.line()) } else { Place::Byte(20 + error.column() as u64) };
        FormatError::new(path, place, error.to_string(), "glTF 2.0 as JSON")
    })?;
    if !document.asset.version.starts_with("2.") {
        return Err(wrong(path, format!("glTF version {}", document.asset.version), "2.0"));
    }
    if let Some(least) = document.asset.min_version.as_deref().filter(|least| *least != "2.0") {
        return Err(wrong(path, format!("glTF for readers of version {least}"), "2.0"));
    }
    let unknown = |name: &&String| !KNOWN.iter().any(|known| name.starts_with(known));
    if let Some(extension) = document.extensions_required.iter().find(unknown) {
        return Err(wrong(path, format!("the required extension {extension}"), "a file without it"));
    }
    let buffers = buffers::load(path, &document, binary)?;
    let distinct: HashMap<*const u8, usize> = buffers.iter().map(|bytes| (bytes.as_ptr(), bytes.len())).collect();
    let size = bytes.len() + distinct.values().sum::<usize>();
    let source = Source { path, document: &document, buffers: &buffers };
    scene::assemble(&source, Budget::of(path, size))
}

/// Splits a binary file into its JSON and its buffer (section 4.4).
fn chunks<'a>(path: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), FormatError> {
    let at =
        |byte: usize, found: String, expected: &str| FormatError::new(path, Place::Byte(byte as u64), found, expected);
    let word = |offset: usize| Some(u32::from_le_bytes(bytes.get(offset..offset + 4)?.try_into().ok()?));
    let cut = || at(bytes.len(), "the end of the file".into(), "a header of 12 bytes and chunks");
    let (version, length) = (word(4).ok_or_else(cut)?, word(8).ok_or_else(cut)? as usize);
    if version != 2 {
        return Err(at(4, format!("version {version}"), "2"));
    }
    if length > bytes.len() {
        return Err(at(8, format!("a length of {length}"), &format!("at most {}, the size of the file", bytes.len())));
    }
    let chunk = |offset: usize, kind: &'static [u8; 4]| {
        let size = word(offset).ok_or_else(cut)? as usize;
        let found = bytes.get(offset + 4..offset + 8).ok_or_else(cut)?;
        if found != kind {
            return Err(at(
                offset + 4,
                format!("a chunk {}", found.escape_ascii()),
                &format!("{}", kind.escape_ascii()),
            ));
        }
        let content = bytes[offset + 8..].get(..size);
        content.ok_or_else(|| {
            let room = bytes.len() - offset - 8;
            at(offset, format!("a chunk of {size} bytes"), &format!("at most {room}, what is left of the file"))
        })
    };
    let json = chunk(12, b"JSON")?;
    let second = 20 + json.len();
    let binary = if second < length { Some(chunk(second, b"BIN\0")?) } else { None };
    Ok((json, binary))
}

/// A file with all its parts.
struct Source<'a> {
    path: &'a Path,
    document: &'a Document,
    buffers: &'a [Rc<[u8]>],
}

/// Memory that may still be used. Without this limit, a small file could place one mesh a million times.
struct Budget<'a> {
    path: &'a Path,
    whole: usize,
    left: usize,
}

impl<'a> Budget<'a> {
    /// The memory that a file of `size` bytes justifies.
    fn of(path: &'a Path, size: usize) -> Self {
        let whole = size.saturating_mul(64).saturating_add(1 << 24);
        Budget { path, whole, left: whole }
    }

    /// Takes `count` times `bytes` from what is left.
    fn take(&mut self, count: usize, bytes: usize) -> Result<(), FormatError> {
        match count.checked_mul(bytes).and_then(|bytes| self.left.checked_sub(bytes)) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(wrong(
                self.path,
                "more vertices, indices and instances than files of this size hold",
                format!("meshes of at most {} bytes", self.whole),
            )),
        }
    }
}
