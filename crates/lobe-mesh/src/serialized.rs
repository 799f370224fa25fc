//! Reads Mitsuba's meshes (`.serialized`): versions 3 and 4, any number of shapes in a file.
//!
//! The format is little-endian. Each shape begins with `0x041C` and the version as 16-bit integers. A zlib stream
//! follows with flags (32 bits), in version 4 the name up to a zero byte, the numbers of vertices and triangles (64
//! bits), positions, normals, texture coordinates and colours as `f32` or `f64`, and indices. The file ends with the
//! offset of each shape (64 bits; 32 in version 3) and the number of shapes (32 bits). Colours are skipped. If a shape
//! asks for the normals of its faces, each triangle gets its own vertices.

use std::path::Path;

use lobe_files::{FormatError, Place, inflated};

use crate::geometry::{narrow, wide};
use crate::{Geometry, Group, Parts, file};

/// The first two bytes of a shape.
pub(crate) const MAGIC: [u8; 2] = 0x041C_u16.to_le_bytes();

const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLOURS: u32 = 0x0008;
const HAS_FACE_NORMALS: u32 = 0x0010;
const IS_SINGLE: u32 = 0x1000;
const IS_DOUBLE: u32 = 0x2000;
const KNOWN: u32 = HAS_NORMALS | HAS_UVS | HAS_COLOURS | HAS_FACE_NORMALS | IS_SINGLE | IS_DOUBLE;

/// Reads a file: its shapes become groups.
///
/// # Errors
/// The file cannot be read, is cut short, counts more than it can hold, or is not a valid mesh.
pub fn read(path: &Path) -> Result<Geometry, FormatError> {
    parse(path, &file::bytes(path)?)
}

/// Reads the content of a file; `path` is only for messages.
///
/// # Errors
/// The same as for [`read`], except those of the file system.
pub fn parse(path: &Path, bytes: &[u8]) -> Result<Geometry, FormatError> {
    let mut mesh = Parts { normals: Some(Vec::new()), uvs: Some(Vec::new()), ..Parts::default() };
    let mut has = Attributes::default();
    let Places { shapes, end } = places(path, bytes)?;
    for (number, &start) in shapes.iter().enumerate() {
        // Shapes do not lie in each other: a hostile file may nest them, each of which takes as long as all inside it.
        let next = shapes.get(number + 1).copied().unwrap_or(end);
        let shape = Shape::read(path, &bytes[..next], start)?;
        has.normals |= shape.normals.is_some();
        has.uvs |= shape.uvs.is_some();
        shape.add(path, start, &mut mesh)?;
    }
    // Attributes that some shapes lack are 0; such normals are computed.
    if !has.normals {
        mesh.normals = None;
    }
    if !has.uvs {
        mesh.uvs = None;
    }
    file::geometry(path, mesh)
}

/// Attributes that any shape of a file has.
#[derive(Default)]
struct Attributes {
    normals: bool,
    uvs: bool,
}

/// Where the shapes lie in a file.
struct Places {
    /// Where each begins, ascending.
    shapes: Vec<usize>,
    /// Where the last ends.
    end: usize,
}

fn places(path: &Path, bytes: &[u8]) -> Result<Places, FormatError> {
    let version = version(path, bytes, 0)?;
    let size = if version == 3 { 4 } else { 8 };
    let cut = |found: String| {
        let expected = "the places and the number of the shapes at the end: a whole file";
        FormatError::new(path, Place::Byte(bytes.len() as u64), found, expected)
    };
    let Some((rest, count)) = bytes.split_last_chunk::<4>() else {
        return Err(cut("the end of the file".into()));
    };
    let count = u32::from_le_bytes(*count) as usize;
    let list = count.checked_mul(size).and_then(|size| rest.len().checked_sub(size)).map(|at| &rest[at..]);
    let Some(list) = list.filter(|_| count > 0) else {
        return Err(cut(format!("{count} shapes")));
    };
    let mut places = Vec::with_capacity(count);
    for place in list.chunks_exact(size) {
        let mut number = [0; 8];
        number[..size].copy_from_slice(place);
        let number = u64::from_le_bytes(number);
        match usize::try_from(number).ok().filter(|at| at.saturating_add(4) < rest.len() - list.len()) {
            Some(at) => places.push(at),
            None => return Err(cut(format!("a shape at byte {number}"))),
        }
    }
    // A hostile file may name a shape many times, each of which takes memory.
    if places.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(cut("shapes out of order".into()));
    }
    Ok(Places { shapes: places, end: rest.len() - list.len() })
}

fn version(path: &Path, bytes: &[u8], start: usize) -> Result<u16, FormatError> {
    let error = |found: String, expected: &str| FormatError::new(path, Place::Byte(start as u64), found, expected);
    let head = bytes.get(start..).and_then(<[u8]>::first_chunk::<4>);
    let Some([a, b, c, d]) = head.copied() else {
        return Err(error("the end of the file".into(), "a Mitsuba shape"));
    };
    if [a, b] != MAGIC {
        return Err(error(format!("{a:02x} {b:02x}"), "the signature 1c 04 of a Mitsuba shape"));
    }
    match u16::from_le_bytes([c, d]) {
        version @ (3 | 4) => Ok(version),
        other => Err(error(format!("version {other}"), "version 3 or 4")),
    }
}

/// A shape as it is stored.
struct Shape {
    name: String,
    positions: Vec<[f32; 3]>,
    normals: Option<Vec<[f32; 3]>>,
    uvs: Option<Vec<[f32; 2]>>,
    triangles: Vec<[u32; 3]>,
    is_flat: bool,
}

impl Shape {
    fn read(path: &Path, bytes: &[u8], start: usize) -> Result<Self, FormatError> {
        let version = version(path, bytes, start)?;
        let content = inflated(&bytes[start + 4..], start as u64 + 4, path)?;
        let mut stream = Stream { path, start, content: &content, at: 0 };
        let flags = u32::from_le_bytes(stream.array("flags")?);
        if flags & !KNOWN != 0 {
            return Err(
                stream.error(format!("flags {flags:#x}"), "only flags for normals, texture coordinates and colours")
            );
        }
        let is_double = match flags & (IS_SINGLE | IS_DOUBLE) {
            IS_SINGLE => false,
            IS_DOUBLE => true,
            other => {
                return Err(stream.error(format!("flags {other:#x}"), "single (0x1000) or double (0x2000) precision"));
            }
        };
        let name = if version == 4 { stream.name()? } else { String::new() };
        let vertices = u64::from_le_bytes(stream.array("the number of vertices")?);
        let triangles = u64::from_le_bytes(stream.array("the number of triangles")?);
        let Ok(vertices) = u32::try_from(vertices) else {
            return Err(stream.error(format!("{vertices} vertices"), "fewer than 2^32"));
        };
        let vertices = vertices as usize;
        let positions = stream.vectors(vertices, is_double, "positions")?;
        let normals = match flags & HAS_NORMALS {
            0 => None,
            _ => Some(stream.vectors(vertices, is_double, "normals")?),
        };
        let uvs = match flags & HAS_UVS {
            0 => None,
            _ => Some(stream.vectors(vertices, is_double, "texture coordinates")?),
        };
        if flags & HAS_COLOURS != 0 {
            stream.vectors::<3>(vertices, is_double, "colours")?;
        }
        let triangles = usize::try_from(triangles).ok().and_then(|count| count.checked_mul(12));
        let (indices, _) = stream.take(triangles.unwrap_or(usize::MAX), "indices")?.as_chunks::<12>();
        let corner = |triangle: &[u8; 12], at: usize| {
            u32::from_le_bytes([triangle[at], triangle[at + 1], triangle[at + 2], triangle[at + 3]])
        };
        let triangles: Vec<[u32; 3]> =
            indices.iter().map(|triangle| [0, 4, 8].map(|at| corner(triangle, at))).collect();
        if let Some(corner) = triangles.iter().flatten().find(|corner| **corner as usize >= vertices) {
            return Err(stream.error(format!("vertex {corner} of {vertices}"), "indices of vertices"));
        }
        Ok(Shape { name, positions, normals, uvs, triangles, is_flat: flags & HAS_FACE_NORMALS != 0 })
    }

    /// Adds the shape to a mesh as a group.
    fn add(mut self, path: &Path, start: usize, mesh: &mut Parts) -> Result<(), FormatError> {
        if self.is_flat {
            self.flatten();
        }
        let too_many = |_| {
            FormatError::new(
                path,
                Place::Byte(start as u64),
                "more than 2^32 vertices or triangles",
                "fewer in all shapes",
            )
        };
        let first = u32::try_from(mesh.positions.len()).map_err(too_many)?;
        u32::try_from(mesh.positions.len() + self.positions.len()).map_err(too_many)?;
        let from = u32::try_from(mesh.triangles.len()).map_err(too_many)?;
        let to = u32::try_from(mesh.triangles.len() + self.triangles.len()).map_err(too_many)?;
        let vertices = self.positions.len();
        mesh.positions.append(&mut self.positions);
        mesh.normals.get_or_insert_default().extend(self.normals.unwrap_or_else(|| vec![[0.0; 3]; vertices]));
        mesh.uvs.get_or_insert_default().extend(self.uvs.unwrap_or_else(|| vec![[0.0; 2]; vertices]));
        mesh.triangles.extend(self.triangles.iter().map(|triangle| triangle.map(|corner| corner + first)));
        mesh.groups.push(Group { name: self.name, material: None, triangles: from..to });
        Ok(())
    }

    /// Gives each triangle its own vertices, with its normal.
    fn flatten(&mut self) {
        let corners: Vec<usize> = self.triangles.iter().flatten().map(|corner| *corner as usize).collect();
        let mut normals = Vec::with_capacity(corners.len());
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|corner| wide(self.positions[corner as usize]));
            let normal = (b - a).cross(c - a).try_normalize().map_or([0.0; 3], narrow);
            normals.extend([normal; 3]);
        }
        self.positions = corners.iter().map(|corner| self.positions[*corner]).collect();
        self.uvs = self.uvs.take().map(|uvs| corners.iter().map(|corner| uvs[*corner]).collect());
        self.normals = Some(normals);
        self.triangles = (0..self.triangles.len() as u32).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]).collect();
    }
}

/// The decompressed content of a shape.
struct Stream<'a> {
    path: &'a Path,
    /// Where the shape begins in the file.
    start: usize,
    content: &'a [u8],
    at: usize,
}

impl<'a> Stream<'a> {
    fn error(&self, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        let found = format!("{} (in the shape, byte {} after decompression)", found.into(), self.at);
        FormatError::new(self.path, Place::Byte(self.start as u64), found, expected)
    }

    fn take(&mut self, size: usize, what: &str) -> Result<&'a [u8], FormatError> {
        let rest = &self.content[self.at..];
        let Some(taken) = rest.get(..size) else {
            return Err(self.error(format!("{} bytes", rest.len()), format!("{what}, {size} bytes")));
        };
        self.at += size;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], FormatError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, what)?);
        Ok(array)
    }

    /// A text up to a zero byte.
    fn name(&mut self) -> Result<String, FormatError> {
        let rest = &self.content[self.at..];
        let Some(length) = rest.iter().position(|byte| *byte == 0) else {
            return Err(self.error("an unterminated name", "a zero byte after it"));
        };
        self.at += length + 1;
        Ok(String::from_utf8_lossy(&rest[..length]).into_owned())
    }

    /// `count` vectors of `N` numbers.
    fn vectors<const N: usize>(
        &mut self,
        count: usize,
        is_double: bool,
        what: &str,
    ) -> Result<Vec<[f32; N]>, FormatError> {
        let size = if is_double { 8 } else { 4 };
        let bytes = self.take(count.saturating_mul(N * size), what)?;
        let number = |bytes: &[u8]| match *bytes {
            [a, b, c, d] => f32::from_le_bytes([a, b, c, d]),
            [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]) as f32,
            _ => f32::NAN,
        };
        let vector = |bytes: &[u8]| std::array::from_fn(|axis| number(&bytes[axis * size..][..size]));
        Ok(bytes.chunks_exact(N * size).map(vector).collect())
    }
}
