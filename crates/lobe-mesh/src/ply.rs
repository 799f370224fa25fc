//! PLY, the Stanford polygon format: reads text and binary of both byte orders, writes little-endian binary.
//!
//! Vertices have `x y z`, and may have `nx ny nz`, texture coordinates (`u v`, `s t`, `texture_u texture_v` or
//! `texture_s texture_t`) and tangents (`tx ty tz tw`); faces have `vertex_indices` or `vertex_index`. Polygons of any
//! shape become triangles. `tristrips`, as files of scanned models have them, are strips of triangles in such a list,
//! each ended by -1. Everything else is skipped.
//!
//! PLY has no groups. The writer gives every face a property `group`, and names them in comments: `group 0 NAME`,
//! `material 0 NAME`. The reader sorts faces by it.

mod elements;
mod write;

use std::collections::HashMap;
use std::path::Path;

use lobe_files::{FormatError, Place};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, PropertyAccess, PropertyType, ScalarType};

use crate::file::{self, wrong};
use crate::{Geometry, Group, Parts, polygon};
use elements::{Face, Skipped, Strips, Vertex};
pub use write::{to_bytes, write};

/// Reads a PLY file.
///
/// # Errors
/// The file cannot be read, is cut short, counts more than it can hold, or is not a valid mesh.
pub fn read(path: &Path) -> Result<Geometry, FormatError> {
    parse(path, &file::bytes(path)?)
}

/// Reads the content of a PLY file; `path` is only for messages.
///
/// # Errors
/// The same as for [`read`], except those of the file system.
pub fn parse(path: &Path, bytes: &[u8]) -> Result<Geometry, FormatError> {
    let mut file = File { path, bytes, reader: Reader::new(bytes) };
    let header = Parser::<Skipped>::new()
        .read_header(&mut file.reader)
        .map_err(|error| file.error(&error, true, "a PLY header"))?;
    let (mut vertices, mut faces, mut strips) = (None, None, None);
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => vertices = Some((file.elements::<Vertex>(&header, element)?, element)),
            "face" => faces = Some(file.elements::<Face>(&header, element)?),
            "tristrips" => strips = Some(file.elements::<Strips>(&header, element)?),
            _ => _ = file.elements::<Skipped>(&header, element)?,
        }
    }
    let Some((vertices, element)) = vertices else { return Err(wrong(path, "no vertices", "an element vertex")) };
    if faces.is_none() && strips.is_none() {
        return Err(wrong(path, "no faces", "an element face or tristrips"));
    }
    let mut parts = attributes(path, element, &vertices)?;
    connect(path, &header, faces.unwrap_or_default(), &mut parts)?;
    unroll(path, &strips.unwrap_or_default(), &mut parts)?;
    file::geometry(path, parts)
}

/// A file being read.
struct File<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    reader: Reader<&'a [u8]>,
}

impl File<'_> {
    /// Reads all elements of one kind, after checking that the rest of the file can hold so many.
    fn elements<E: PropertyAccess>(&mut self, header: &Header, element: &ElementDef) -> Result<Vec<E>, FormatError> {
        let text = header.encoding == Encoding::Ascii;
        let rest = self.reader.get_ref().len();
        let least = element.properties.values().map(|property| if text { 2 } else { size(&property.data_type) }).sum();
        // The last line of a text file may end without a line feed.
        let room = (rest + usize::from(text)).checked_div(least).unwrap_or(0);
        if element.count > room {
            let found = format!("{} of {} in the {rest} bytes after it", element.count, element.name);
            let expected = format!("at most {room}, of {least} bytes or more each");
            return Err(FormatError::new(self.path, Place::Line(self.header_line(&element.name)), found, expected));
        }
        let expected = format!("{} of {}", element.count, element.name);
        let elements = Parser::<E>::new().read_payload_for_element(&mut self.reader, element, header);
        elements.map_err(|error| self.error(&error, text, &expected))
    }

    /// The line of the header that declares an element.
    fn header_line(&self, element: &str) -> usize {
        let declares = |line: &[u8]| {
            let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            words.next() == Some(b"element") && words.next() == Some(element.as_bytes())
        };
        self.bytes.split(|&byte| byte == b'\n').position(declares).map_or(1, |line| line + 1)
    }

    /// An error of the parser with its place: a line of a text file, a byte of a binary one.
    fn error(&self, error: &ParseError, text: bool, expected: &str) -> FormatError {
        let byte = (self.bytes.len() - self.reader.get_ref().len()) as u64;
        let place = match error.line() {
            Some(line) if text => Place::Line(line),
            _ => Place::Byte(byte),
        };
        let message = error.to_string();
        let message = message.strip_prefix(&format!("Line {}: ", error.line().unwrap_or(0))).unwrap_or(&message);
        let words: Vec<&str> = message.split_whitespace().take(24).collect();
        FormatError::new(self.path, place, words.join(" "), expected)
    }
}

/// The least number of bytes that a property takes.
fn size(property: &PropertyType) -> usize {
    let (PropertyType::Scalar(scalar) | PropertyType::List(scalar, _)) = property;
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

/// The attributes of all vertices.
fn attributes(path: &Path, element: &ElementDef, vertices: &[Vertex]) -> Result<Parts, FormatError> {
    let present = Vertex::present(element.properties.keys().map(String::as_str));
    let has = |slots: std::ops::Range<usize>| present[slots].iter().all(|&there| there);
    if !has(0..3) {
        let names: Vec<&str> = element.properties.keys().map(String::as_str).collect();
        return Err(wrong(path, format!("vertices with {}", names.join(" ")), "x, y and z"));
    }
    let positions = vertices.iter().map(|vertex| vertex.slots(0)).collect();
    let normals = has(3..6).then(|| vertices.iter().map(|vertex| vertex.slots::<3>(3)).collect());
    let uvs = has(6..8).then(|| vertices.iter().map(|vertex| vertex.slots::<2>(6)).collect());
    let tangents = has(8..12).then(|| vertices.iter().map(|vertex| vertex.slots::<4>(8)).collect());
    Ok(Parts { positions, normals, uvs, tangents, ..Parts::default() })
}

/// Turns faces into triangles and groups.
fn connect(path: &Path, header: &Header, mut faces: Vec<Face>, parts: &mut Parts) -> Result<(), FormatError> {
    for (number, face) in faces.iter().enumerate() {
        let vertices = parts.positions.len();
        if face.corners.len() < 3 {
            let found = format!("{} usable vertices in face {number}", face.corners.len());
            return Err(wrong(path, found, "3 or more whole indices that are not negative"));
        }
        if let Some(corner) = face.corners.iter().find(|&&corner| corner as usize >= vertices) {
            let found = format!("vertex {corner} in face {number}");
            return Err(wrong(path, found, format!("less than {vertices}, the number of vertices")));
        }
    }
    faces.sort_by_key(|face| face.group);
    let names: HashMap<(&str, u32), &str> = header.comments.iter().filter_map(|comment| named(comment)).collect();
    for same in faces.chunk_by(|a, b| a.group == b.group) {
        let start = parts.triangles.len() as u32;
        for Face { corners, .. } in same {
            polygon::triangulate(&parts.positions, corners, &mut parts.triangles).map_err(|polygon::TooMany| {
                let expected = format!("at most {} corners of a face that is not convex", polygon::MOST);
                wrong(path, format!("{} of them", corners.len()), expected)
            })?;
        }
        parts.groups.push(Group {
            name: names.get(&("group", same[0].group)).copied().unwrap_or_default().into(),
            material: names.get(&("material", same[0].group)).map(|&name| name.into()),
            triangles: start..parts.triangles.len() as u32,
        });
    }
    Ok(())
}

/// Strips to triangles, which are a group of their own.
fn unroll(path: &Path, strips: &[Strips], parts: &mut Parts) -> Result<(), FormatError> {
    let start = parts.triangles.len() as u32;
    for (number, strip) in strips.iter().enumerate() {
        if !strip.is_sound {
            let found = format!("no usable list in tristrips {number}");
            return Err(wrong(path, found, "`vertex_indices` that are whole numbers"));
        }
        let vertices = parts.positions.len();
        if let Some(corner) = strip.corners.iter().flatten().find(|&&corner| corner as usize >= vertices) {
            let found = format!("vertex {corner} in tristrips {number}");
            return Err(wrong(path, found, format!("less than {vertices}, the number of vertices")));
        }
        parts.triangles.extend(strip.triangles());
    }
    let end = parts.triangles.len() as u32;
    if end > start {
        parts.groups.push(Group { name: String::new(), material: None, triangles: start..end });
    }
    Ok(())
}

/// Kind, group and name of a comment `KIND GROUP NAME`.
fn named(comment: &str) -> Option<((&str, u32), &str)> {
    let mut words = comment.trim().splitn(3, ' ');
    let (kind, group, name) = (words.next()?, words.next()?, words.next()?);
    Some(((kind, group.parse().ok()?), name))
}
