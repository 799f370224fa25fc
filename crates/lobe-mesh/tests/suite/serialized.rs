//! Tests of Mitsuba's meshes.

use std::io::Write as _;
use std::path::Path;

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use lobe_files::FormatError;
use lobe_mesh::{Geometry, serialized};

/// The content of a shape.
#[derive(Clone, Copy)]
struct Made {
    version: u16,
    flags: u32,
    name: &'static str,
}

const TWO: Made = Made { version: 4, flags: 0x1000, name: "two" };
const POSITIONS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]];
const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

fn content(made: Made) -> Vec<u8> {
    let mut bytes = made.flags.to_le_bytes().to_vec();
    if made.version == 4 {
        bytes.extend(made.name.as_bytes());
        bytes.push(0);
    }
    bytes.extend(4_u64.to_le_bytes());
    bytes.extend(2_u64.to_le_bytes());
    let mut push = |number: f64| match made.flags & 0x2000 {
        0 => bytes.extend((number as f32).to_le_bytes()),
        _ => bytes.extend(number.to_le_bytes()),
    };
    POSITIONS.iter().flatten().for_each(|number| push(*number));
    if made.flags & 1 != 0 {
        (0..4).flat_map(|_| [0.0, 0.0, 2.0]).for_each(&mut push);
    }
    if made.flags & 2 != 0 {
        POSITIONS.iter().flat_map(|position| [position[0], position[1]]).for_each(&mut push);
    }
    if made.flags & 8 != 0 {
        (0..12).map(f64::from).for_each(&mut push);
    }
    bytes.extend(TRIANGLES.iter().flatten().flat_map(|corner| corner.to_le_bytes()));
    bytes
}

fn file(shapes: &[Made]) -> Vec<u8> {
    let (mut bytes, mut places) = (Vec::new(), Vec::new());
    for made in shapes {
        places.push(bytes.len());
        bytes.extend(0x041C_u16.to_le_bytes());
        bytes.extend(made.version.to_le_bytes());
        bytes.extend(packed(&content(*made)));
    }
    for place in places {
        match shapes[0].version {
            3 => bytes.extend((place as u32).to_le_bytes()),
            _ => bytes.extend((place as u64).to_le_bytes()),
        }
    }
    bytes.extend((shapes.len() as u32).to_le_bytes());
    bytes
}

fn parse(bytes: &[u8]) -> Result<Geometry, FormatError> {
    serialized::parse(Path::new("file"), bytes)
}

#[track_caller]
fn refused(bytes: &[u8], found: &str) {
    let error = parse(bytes).map(|_| ()).expect_err("a refusal").to_string();
    assert!(error.contains(found), "{error}");
}

#[test]
fn versions_precisions_and_attributes_are_read() {
    for version in [3, 4] {
        for precision in [0x1000, 0x2000] {
            for attributes in [0, 1, 2, 3, 8, 11] {
                let mesh = parse(&file(&[Made { version, flags: precision | attributes, ..TWO }]));
                let mesh = mesh.unwrap_or_else(|error| panic!("{version} {attributes}: {error}"));
                assert_eq!(mesh.positions, POSITIONS.map(|position| position.map(|c| c as f32)));
                assert_eq!(mesh.triangles, TRIANGLES);
                assert_eq!(mesh.normals.is_some(), attributes & 1 != 0);
                // Normals become unit vectors.
                assert!(mesh.normals.iter().flatten().all(|normal| *normal == [0.0, 0.0, 1.0]));
                assert_eq!(mesh.uvs.as_ref().map(|uvs| uvs[2]), (attributes & 2 != 0).then_some([1.0, 1.0]));
                assert_eq!(mesh.groups[0].name, if version == 4 { "two" } else { "" });
            }
        }
    }
}

#[test]
fn shapes_are_groups_and_flat_ones_keep_their_edges() {
    let flat = Made { flags: 0x1010, name: "flat", ..TWO };
    let mesh = parse(&file(&[TWO, flat, Made { flags: 0x1001, name: "smooth", ..TWO }])).expect("three shapes");
    let groups: Vec<_> = mesh.groups.iter().map(|group| (group.name.as_str(), group.triangles.clone())).collect();
    assert_eq!(groups, [("two", 0..2), ("flat", 2..4), ("smooth", 4..6)]);
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4 + 6 + 4, 6));
    let normals = mesh.normals.as_ref().expect("normals");
    assert_eq!(normals[4], [0.0, 0.0, 1.0]);
    let third = (1.0_f32 / 3.0).sqrt();
    assert!(
        normals[7].iter().zip([third, -third, third]).all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-6),
        "{:?}",
        normals[7]
    );
    // The first shape had no normals; they are smooth.
    assert!(normals[..4].iter().all(|normal| normal.iter().any(|c| *c != 0.0)));
}

#[test]
fn every_reader_opens_them_compressed_or_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let bytes = file(&[TWO]);
    for name in ["mesh.serialized", "mesh.bin"] {
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).expect("a file");
        assert_eq!(lobe_mesh::read(&path).expect("a mesh").triangles, TRIANGLES, "{name}");
    }
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("memory");
    let path = folder.path().join("triangle.obj.gz");
    std::fs::write(&path, encoder.finish().expect("memory")).expect("a file");
    assert_eq!(lobe_mesh::read(&path).expect("a mesh").triangles, [[0, 1, 2]]);
    let path = folder.path().join("page.obj");
    std::fs::write(&path, "<!DOCTYPE html><html>").expect("a file");
    let error = lobe_mesh::read(&path).map(|_| ()).expect_err("a web page").to_string();
    assert!(error.contains("found a web page (HTML); expected a mesh"), "{error}");
}

/// A hostile file may put a shape into another, and both into a third: each would take as long as all within it.
#[test]
fn shapes_do_not_lie_in_each_other() {
    let inner = [&[0x1c, 4, 4, 0], &packed(&content(TWO))[..]].concat();
    let outer = {
        // Stored as it is, after the content of its own.
        let mut encoder = ZlibEncoder::new(vec![0x1c, 4, 4, 0], Compression::none());
        encoder.write_all(&content(TWO)).expect("memory");
        encoder.write_all(&inner).expect("memory");
        encoder.finish().expect("memory")
    };
    let place = outer.windows(4).skip(4).position(|window| window == [0x1c, 4, 4, 0]).expect("the inner one") + 4;
    let with = |places: &[usize]| {
        let mut bytes = outer.clone();
        places.iter().for_each(|place| bytes.extend((*place as u64).to_le_bytes()));
        bytes.extend((places.len() as u32).to_le_bytes());
        bytes
    };
    assert_eq!(parse(&with(&[0])).expect("the outer one").triangles, TRIANGLES);
    assert_eq!(parse(&with(&[place])).expect("the inner one").triangles, TRIANGLES);
    refused(&with(&[0, place]), "packed data that are cut short");
    refused(&with(&[0, 2]), "the end of the file");
}

#[test]
fn damage_is_refused_with_its_place() {
    let whole = file(&[TWO, Made { flags: 0x2003, ..TWO }]);
    assert!(parse(&whole).is_ok());
    for end in 0..whole.len() {
        let error = parse(&whole[..end]).map(|_| ()).expect_err("cut short");
        assert!(error.file == Path::new("file") && !error.found.is_empty(), "{end}: {error}");
    }
    let with = |at: usize, bytes: &[u8]| {
        let mut damaged = whole.clone();
        damaged[at..][..bytes.len()].copy_from_slice(bytes);
        damaged
    };
    refused(&with(0, &[1]), "01 04");
    refused(&with(2, &[9]), "version 9");
    refused(&with(40, &[0xff; 8]), "packed data");
    refused(&with(whole.len() - 4, &[0, 0, 0, 0]), "0 shapes");
    refused(&with(whole.len() - 4, &[0xff; 4]), "4294967295 shapes");
    refused(&with(whole.len() - 12, &[0xff; 8]), "a shape at byte 18446744073709551615");
    refused(&with(whole.len() - 12, &[0; 8]), "shapes out of order");
    let shape = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut content = content(TWO);
        change(&mut content);
        let mut bytes = [0x1c, 4, 4, 0].to_vec();
        bytes.extend(packed(&content));
        bytes.extend([0; 8]);
        bytes.extend(1_u32.to_le_bytes());
        bytes
    };
    refused(&shape(&|content| content[0] = 0x40), "flags 0x1040");
    refused(&shape(&|content| content[1] = 0), "flags 0x0");
    refused(&shape(&|content| content[8..16].fill(0xff)), "18446744073709551615 vertices");
    refused(&shape(&|content| content[16..24].fill(0xff)), "expected indices");
    refused(&shape(&|content| content[8] = 200), "expected positions");
    refused(&shape(&|content| *content.last_mut().expect("bytes") = 1), "vertex 16777219 of 4");
    refused(&shape(&|content| content[24..28].copy_from_slice(&f32::NAN.to_le_bytes())), "NaN");
}
