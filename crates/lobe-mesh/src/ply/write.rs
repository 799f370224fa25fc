//! Writes little-endian PLY.

use std::path::Path;

use lobe_files::{FormatError, write_whole};

use crate::Geometry;

/// Writes a mesh with all of its attributes. Indices take two bytes each if they fit.
///
/// The file is written completely or not at all. Line feeds in names of groups and materials become spaces.
///
/// # Errors
/// Those of the file system.
pub fn write(path: &Path, geometry: &Geometry) -> Result<(), FormatError> {
    write_whole(path, &to_bytes(geometry))
}

/// The content of the file that [`write()`] writes.
pub fn to_bytes(geometry: &Geometry) -> Vec<u8> {
    let mut out = header(geometry).into_bytes();
    for vertex in 0..geometry.positions.len() {
        let mut put = |numbers: &[f32]| out.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        put(&geometry.positions[vertex]);
        if let Some(normals) = &geometry.normals {
            put(&normals[vertex]);
        }
        if let Some(uvs) = &geometry.uvs {
            put(&uvs[vertex]);
        }
        if let Some(tangents) = &geometry.tangents {
            put(&tangents[vertex]);
        }
    }
    let narrow = narrow(geometry);
    for (number, group) in geometry.groups.iter().enumerate() {
        for corners in &geometry.triangles[group.triangles.start as usize..group.triangles.end as usize] {
            out.push(3);
            for index in corners {
                let bytes = index.to_le_bytes();
                out.extend(if narrow { &bytes[..2] } else { &bytes });
            }
            if grouped(geometry) {
                let bytes = (number as u32).to_le_bytes();
                out.extend(if few(geometry) { &bytes[..1] } else { &bytes });
            }
        }
    }
    out
}

fn header(geometry: &Geometry) -> String {
    let mut lines = vec!["ply".to_owned(), "format binary_little_endian 1.0".to_owned()];
    if grouped(geometry) {
        let line = |name: &str| name.replace(['\n', '\r'], " ");
        for (number, group) in geometry.groups.iter().enumerate() {
            lines.push(format!("comment group {number} {}", line(&group.name)));
            lines.extend(group.material.iter().map(|name| format!("comment material {number} {}", line(name))));
        }
    }
    let mut properties = vec!["x", "y", "z"];
    properties.extend(geometry.normals.iter().flat_map(|_| ["nx", "ny", "nz"]));
    properties.extend(geometry.uvs.iter().flat_map(|_| ["u", "v"]));
    properties.extend(geometry.tangents.iter().flat_map(|_| ["tx", "ty", "tz", "tw"]));
    lines.push(format!("element vertex {}", geometry.positions.len()));
    lines.extend(properties.into_iter().map(|name| format!("property float {name}")));
    lines.push(format!("element face {}", geometry.triangles.len()));
    let index = if narrow(geometry) { "ushort" } else { "uint" };
    lines.push(format!("property list uchar {index} vertex_indices"));
    if grouped(geometry) {
        lines.push(format!("property {} group", if few(geometry) { "uchar" } else { "uint" }));
    }
    lines.push("end_header\n".to_owned());
    lines.join("\n")
}

/// `true` if indices fit in two bytes.
fn narrow(geometry: &Geometry) -> bool {
    geometry.positions.len() <= 1 << 16
}

/// `true` if the number of a group fits in a byte.
fn few(geometry: &Geometry) -> bool {
    geometry.groups.len() <= 1 << 8
}

/// `true` if the groups carry any information.
fn grouped(geometry: &Geometry) -> bool {
    geometry.groups.len() > 1 || geometry.groups.iter().any(|group| !group.name.is_empty() || group.material.is_some())
}
