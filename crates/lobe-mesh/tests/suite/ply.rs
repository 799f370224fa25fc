//! Tests of reading and writing PLY.

use std::path::Path;

use lobe_mesh::{Geometry, Group, Parts, Place, generate, ply, shapes};
use lobe_testing::damage::{corrupt, truncate};
use lobe_testing::files::shared_file;

const TEXT: &str = "ply\nformat ascii 1.0\ncomment a square and a triangle\nelement vertex 5\nproperty float x\n\
    property float y\nproperty double z\nproperty float s\nproperty float t\nproperty uchar red\nelement face 2\n\
    property list uchar int vertex_indices\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n\
    0 0 0 0 0 255\n1 0 0 1 0 255\n1 1 0 1 1 0\n0 1 0 0 1 0\n5e-1 2 0 0.5 2 9\n4 0 1 2 3\n3 3 2 4\n0 1\n";

/// The same file in binary, with indices of type `index` (2 or 4 bytes).
fn binary(big: bool, index: usize) -> Vec<u8> {
    let kind = if index == 2 { "ushort" } else { "int" };
    let order = if big { "big" } else { "little" };
    let header = TEXT[..TEXT.find("0 0 0 0").expect("the first vertex")]
        .replace("ascii", &format!("binary_{order}_endian"))
        .replace("list uchar int", &format!("list uchar {kind}"));
    let mut bytes = header.into_bytes();
    let mut write = |mut little: Vec<u8>| {
        if big {
            little.reverse();
        }
        bytes.append(&mut little);
    };
    for line in TEXT.lines().skip_while(|line| *line != "end_header").skip(1).take(5) {
        for (i, word) in line.split(' ').enumerate() {
            match i {
                2 => write(word.parse::<f64>().expect("a number").to_le_bytes().into()),
                5 => write(vec![word.parse().expect("a number")]),
                _ => write(word.parse::<f32>().expect("a number").to_le_bytes().into()),
            }
        }
    }
    for face in [vec![0u32, 1, 2, 3], vec![3, 2, 4]] {
        write(vec![face.len() as u8]);
        face.iter().for_each(|corner| write(corner.to_le_bytes()[..index].into()));
    }
    [0u32, 1].iter().for_each(|end| write(end.to_le_bytes().into()));
    bytes
}

fn parse(bytes: &[u8]) -> Result<Geometry, lobe_mesh::FormatError> {
    ply::parse(Path::new("a.ply"), bytes)
}

fn error(text: &str) -> lobe_mesh::FormatError {
    parse(text.as_bytes()).expect_err("a wrong file")
}

#[test]
fn all_encodings_give_the_same_mesh() {
    let text = parse(TEXT.as_bytes()).expect("text");
    assert_eq!(text.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 4]]);
    assert_eq!(text.positions[4], [0.5, 2.0, 0.0]);
    assert_eq!(text.uvs.as_ref().expect("texture coordinates")[2], [1.0, 1.0]);
    assert!(text.normals.is_none());
    for big in [false, true] {
        for index in [2, 4] {
            assert_eq!(parse(&binary(big, index)).expect("binary"), text);
        }
    }
    assert_eq!(parse(TEXT.replace('\n', "\r\n").as_bytes()).expect("text of another system"), text);
}

#[test]
fn every_beginning_of_a_file_is_an_error() {
    // Without the line feed, or without the unused edge's last digit, the text still holds the mesh.
    truncate("a.ply", TEXT.as_bytes(), TEXT.len() - 1, ply::parse);
    for big in [false, true] {
        let bytes = binary(big, 4);
        truncate("a.ply", &bytes, bytes.len(), ply::parse);
    }
    corrupt(TEXT.as_bytes(), ply::parse);
    corrupt(&binary(false, 2), ply::parse);
}

#[test]
fn errors_say_where_and_what() {
    let wrong = error(&TEXT.replace("1 1 0 1 1 0", "1 one 0 1 1 0"));
    assert_eq!(wrong.place, Place::Line(19));
    assert!(wrong.found.contains("one"), "{wrong}");
    assert!(
        error(&TEXT.replace("3 3 2 4", "3 3 2 5"))
            .to_string()
            .contains("found vertex 5 in face 1; expected less than 5")
    );
    assert!(error(&TEXT.replace("3 3 2 4", "3 3 2 -1")).to_string().contains("face 1"));
    assert!(error(&TEXT.replace("3 3 2 4", "2 3 2")).to_string().contains("2 usable vertices in face 1"));
    let wrong = error(&TEXT.replace("5e-1 2 0", "nan 2 0"));
    assert_eq!(wrong.place, Place::Line(21));
    assert!(error(&TEXT.replace("5e-1 2 0", "5e99 2 0")).found.contains("inf in the position of vertex 4"));
    let mut bytes = binary(false, 4);
    let first = bytes.len() - 5 * (4 * 4 + 8 + 1) - (1 + 16) - (1 + 12) - 8;
    bytes[first..first + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(parse(&bytes).expect_err("not a number").found.contains("NaN in the position of vertex 0"));
    assert!(error(&TEXT.replace("property float y", "property float why")).to_string().contains("x, y and z"));
    assert!(error(&TEXT.replace("element face", "element polygon")).to_string().contains("element face"));
    let missing = ply::read(Path::new("no/such/file.ply")).expect_err("no file");
    assert!(missing.to_string().starts_with("no/such/file.ply: found "), "{missing}");
    assert!(ply::read(Path::new(env!("CARGO_MANIFEST_DIR"))).expect_err("a folder").to_string().contains("folder"));
}

#[test]
fn absurd_counts_are_refused_before_anything_is_allocated() {
    for count in ["4000000000", "18446744073709551615", "99999999999999999999999"] {
        let text = TEXT.replace("element vertex 5", &format!("element vertex {count}"));
        assert!(error(&text).to_string().starts_with("a.ply:"), "{count}");
        let bytes = String::from_utf8_lossy(&binary(false, 4)).replace("vertex 5", &format!("vertex {count}"));
        assert!(error(&bytes).to_string().starts_with("a.ply:"), "{count}");
    }
    assert!(error(&TEXT.replace("4 0 1 2 3", "4000000000 0 1 2 3")).found.contains("4000000000 list elements"));
    let wrong = error(&TEXT.replace("element vertex 5", "element vertex 4000000000"));
    assert_eq!(wrong.place, Place::Line(4));
    // There could be any number of elements without size.
    let nothing = TEXT.replace("format ascii 1.0", "format binary_little_endian 1.0\nelement nothing 4000000000");
    assert!(error(&nothing).to_string().contains("4000000000 of nothing"));
}

#[test]
fn a_written_mesh_is_read_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mesh.ply");
    let plain = Geometry::new(Parts {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.25]],
        triangles: vec![[0, 1, 2]],
        ..Parts::default()
    });
    let named = |name: &str, material: Option<&str>, triangles| Group {
        name: name.into(),
        material: material.map(Into::into),
        triangles,
    };
    let mut grouped = shapes::cuboid([1.0; 3], 1).into_parts();
    grouped.groups = vec![named("top of it", Some("felt"), 0..4), named("", None, 4..7), named("rest", None, 7..12)];
    let meshes =
        [plain.expect("a mesh"), Geometry::new(grouped).expect("a mesh"), generate::ball(), shapes::sphere(1.0, 500)];
    for mesh in meshes {
        ply::write(&path, &mesh).expect("a file");
        // Not assert_eq, which would print the meshes.
        assert!(ply::read(&path).expect("the file") == mesh, "{} vertices", mesh.positions.len());
    }
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1, "no temporary files remain");
    assert!(ply::write(&folder.path().join("no/folder.ply"), &shapes::plane(1.0, 1)).is_err());
}

#[test]
fn shared_files_have_their_counts() {
    let files = [
        ("teapot.ply", 1177, 2256),
        ("dragon_scene_Mesh005.ply", 2354, 4704),
        ("dragon_scene_Mesh009.ply", 3371, 6738),
        ("dragon_scene_Mesh010.ply", 10072, 20128),
    ];
    for (name, vertices, triangles) in files {
        let Some(path) = shared_file(&format!("data/geometry/{name}")) else { continue };
        let mesh = lobe_mesh::read(&path).expect(name);
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (vertices, triangles), "{name}");
        assert_eq!(mesh.normals.is_some(), name != "teapot.ply", "{name}");
        assert!(mesh.complete().normals.is_some());
    }
    for name in ["luxball-cloth.ply", "luxball-inner.ply", "luxcore_ellipse.ply"] {
        let Some(path) = shared_file(&format!("data/geometry/{name}")) else { continue };
        let mesh = lobe_mesh::read(&path).expect(name).complete();
        println!("{name}: {} vertices, {} triangles", mesh.positions.len(), mesh.triangles.len());
    }
}

#[test]
fn faces_that_are_not_convex_are_filled() {
    let l = "2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n";
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n\
         property list uchar int vertex_indices\nend_header\n{l}6 0 1 2 3 4 5\n3 0 1 2\n"
    );
    let mesh = parse(text.as_bytes()).expect("a mesh");
    assert_eq!((mesh.triangles.len(), mesh.area()), (5, 3.5));
}

/// A mesh in strips: a header and the vertices of two squares, then the list of strips.
fn strips(kind: &str, list: &str) -> String {
    format!(
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n\
         property list int {kind} vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 0 0\n3 0 0\n2 1 0\n3 1 0\n{list}\n"
    )
}

#[test]
fn strips_of_triangles_are_unrolled() {
    for (kind, list, triangles) in [
        ("int", "5 0 1 2 3 -1", 2),
        ("int", "9 0 1 2 3 -1 4 5 6 7", 4),
        ("short", "11 -1 0 1 2 3 -1 -1 4 5 6 -1", 3),
        // Equal corners lead from one strip to the next; the second begins at an even place.
        ("uint", "10 0 1 2 3 3 4 4 5 6 7", 4),
        ("int", "3 -1 -1 -1", 0),
    ] {
        let mesh = parse(strips(kind, list).as_bytes());
        if triangles == 0 {
            assert!(mesh.expect_err("no triangles").found.contains("no triangles"));
            continue;
        }
        let mesh = mesh.unwrap_or_else(|error| panic!("{list}: {error}"));
        assert_eq!((mesh.triangles.len(), mesh.area()), (triangles, triangles as f64 / 2.0), "{list}");
        // All are seen from the same side.
        for triangle in &mesh.triangles {
            let [a, b, c] = crate::common::corners(&mesh, *triangle);
            assert!((b - a).cross(c - a).z > 0.0, "{list}: {triangle:?}");
        }
    }
    // Faces and strips in one file.
    let both = strips("int", "5 4 5 6 7 -1\n3 0 1 2")
        .replace("end_header", "element face 1\nproperty list uchar int vertex_indices\nend_header");
    assert_eq!(parse(both.as_bytes()).expect("a mesh").triangles.len(), 3);
    for (kind, list, expected) in
        [("int", "4 0 1 2 8", "vertex 8 in tristrips 0"), ("float", "4 0 1 2 3", "no usable list in tristrips 0")]
    {
        let error = error(&strips(kind, list)).to_string();
        assert!(error.contains(expected), "{list}: {error}");
    }
}
