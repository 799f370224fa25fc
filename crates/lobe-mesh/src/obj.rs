//! Reads Wavefront OBJ, and the material libraries (MTL) next to it.
//!
//! `v`, `vt`, `vn`, `f`, `o`, `g`, `usemtl` and `mtllib` are read; lines, points, curves and smoothing groups are
//! skipped. A line that ends in `\` continues on the next line, and lines may end in a line feed, a carriage return, or
//! both. Polygons of any shape become triangles. A group of the mesh is a run of faces of one object or group and one
//! material.

mod line;
mod mtl;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use lobe_files::FormatError;

use crate::file;
use crate::{Geometry, Group, Parts, polygon};
use line::Line;
pub use mtl::{Material, materials};

/// Reads the mesh of an OBJ file. Material libraries are not opened; groups name their materials.
///
/// # Errors
/// The file cannot be read, a line is wrong, or there is no triangle.
pub fn read(path: &Path) -> Result<Geometry, FormatError> {
    parse(path, &file::bytes(path)?)
}

/// Reads the mesh of an OBJ file and the libraries that it names, which lie next to it.
///
/// # Errors
/// The same as for [`read`], for each of the files.
pub fn read_with_materials(path: &Path) -> Result<(Geometry, Vec<Material>), FormatError> {
    let bytes = file::bytes(path)?;
    let reader = read_lines(path, &bytes)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut found = Vec::new();
    for library in &reader.libraries {
        found.extend(materials(&folder.join(library))?);
    }
    Ok((reader.finish(path)?, found))
}

/// Reads the content of an OBJ file; `path` is only for messages.
///
/// # Errors
/// The same as for [`read`], except those of the file system.
pub fn parse(path: &Path, bytes: &[u8]) -> Result<Geometry, FormatError> {
    read_lines(path, bytes)?.finish(path)
}

fn read_lines(path: &Path, bytes: &[u8]) -> Result<Reader, FormatError> {
    let mut reader = Reader::default();
    for (number, bytes) in line::whole(bytes) {
        reader.line(&mut Line::new(path, number, &bytes))?;
    }
    Ok(reader)
}

/// Corner of a face: indices of position, texture coordinates and normal.
type Corner = (u32, Option<u32>, Option<u32>);

/// The content read so far.
#[derive(Default)]
struct Reader {
    positions: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    /// Vertices of the mesh, one for each distinct corner, in order of appearance.
    corners: Vec<Corner>,
    /// Their indices.
    places: Vec<[f32; 3]>,
    known: HashMap<Corner, u32>,
    triangles: Vec<[u32; 3]>,
    groups: Vec<Group>,
    name: String,
    material: Option<String>,
    libraries: Vec<PathBuf>,
}

impl Reader {
    fn line(&mut self, line: &mut Line<'_>) -> Result<(), FormatError> {
        match line.word() {
            Some("v") => self.positions.push(line.numbers("x, y and z")?),
            Some("vt") => self.uvs.push(line.coordinates()?),
            Some("vn") => self.normals.push(line.numbers("the three components of a normal")?),
            Some("f") => self.face(line)?,
            Some("o" | "g") => self.name = line.name()?,
            Some("usemtl") => self.material = Some(line.name()?).filter(|name| !name.is_empty()),
            Some("mtllib") => self.libraries.push(line.name()?.into()),
            _ => {}
        }
        Ok(())
    }

    fn face(&mut self, line: &mut Line<'_>) -> Result<(), FormatError> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let mut polygon = Vec::new();
        while let Some(corner) = line.corner(counts)? {
            let next = self.corners.len() as u32;
            let vertex = *self.known.entry(corner).or_insert(next);
            if vertex == next {
                self.corners.push(corner);
                self.places.push(self.positions[corner.0 as usize]);
            }
            polygon.push(vertex);
        }
        if polygon.len() < 3 {
            return Err(line.wrong(format!("a face of {} corners", polygon.len()), "3 corners or more"));
        }
        let start = self.triangles.len() as u32;
        polygon::triangulate(&self.places, &polygon, &mut self.triangles).map_err(|polygon::TooMany| {
            let expected = format!("at most {} corners of a face that is not convex", polygon::MOST);
            line.wrong(format!("{} of them", polygon.len()), expected)
        })?;
        let end = self.triangles.len() as u32;
        match self.groups.last_mut() {
            Some(group) if group.name == self.name && group.material == self.material => group.triangles.end = end,
            _ => self.groups.push(Group {
                name: self.name.clone(),
                material: self.material.clone(),
                triangles: start..end,
            }),
        }
        Ok(())
    }

    /// The finished mesh. If a file has texture coordinates or normals for some corners only, the others get (0, 0) or
    /// the smooth normal.
    fn finish(self, path: &Path) -> Result<Geometry, FormatError> {
        let uv = |&(_, uv, _): &Corner| uv.map_or([0.0; 2], |index| self.uvs[index as usize]);
        let normal = |&(_, _, normal): &Corner| normal.map_or([0.0; 3], |index| self.normals[index as usize]);
        let (textured, shaded) = (
            self.corners.iter().any(|corner| corner.1.is_some()),
            self.corners.iter().any(|corner| corner.2.is_some()),
        );
        let parts = Parts {
            uvs: textured.then(|| self.corners.iter().map(uv).collect()),
            normals: shaded.then(|| self.corners.iter().map(normal).collect()),
            positions: self.places,
            tangents: None,
            triangles: self.triangles,
            groups: self.groups,
        };
        file::geometry(path, parts)
    }
}
