//! Tests of OBJ and MTL.

use std::path::Path;

use lobe_mesh::{FormatError, Geometry, Group, Place, obj};
use lobe_testing::damage::{corrupt, truncate};
use lobe_testing::files::shared_file;

const TEXT: &str = "# a square and a triangle\nmtllib some.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0 # corner\nv 0 1 0 1.0 0.5 0.25\n\
    vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\no plate\nusemtl rough steel\nf 1/1/1 2/2/1 3/3/1 4/4/1\ng tip\n\
    usemtl felt\nv 0.5 2 0\nf -2//1 -3//1 -1//1\n";

fn parse(text: &str) -> Result<Geometry, FormatError> {
    obj::parse(Path::new("a.obj"), text.as_bytes())
}

#[test]
fn faces_become_triangles_in_groups() {
    let mesh = parse(TEXT).expect("a mesh");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6]]);
    assert_eq!(mesh.positions[6], [0.5, 2.0, 0.0]);
    assert_eq!(mesh.positions[4], [0.0, 1.0, 0.0]);
    assert_eq!(mesh.normals, Some(vec![[0.0, 0.0, 1.0]; 7]), "made of unit length");
    let uvs = mesh.uvs.as_ref().expect("texture coordinates");
    assert_eq!(uvs[2], [1.0, 1.0]);
    assert_eq!(uvs[4..], [[0.0; 2]; 3], "corners without any");
    let group =
        |name: &str, material: &str, triangles| Group { name: name.into(), material: Some(material.into()), triangles };
    assert_eq!(mesh.groups, [group("plate", "rough steel", 0..2), group("tip", "felt", 2..3)]);
    assert_eq!(parse(&TEXT.replace('\n', "\r\n")).expect("a mesh"), mesh);
}

#[test]
fn lines_end_and_continue_as_the_format_says() {
    let mesh = parse(TEXT).expect("a mesh");
    assert_eq!(parse(&TEXT.replace('\n', "\r")).expect("carriage returns only"), mesh);
    let continued = TEXT.replace("f 1/1/1 2/2/1 3/3/1 4/4/1", "f \\\n1/1/1 2/2/1 \\\n  3/3/1\\\n4/4/1");
    assert_eq!(parse(&continued).expect("a continued line"), mesh);
    assert_eq!(parse(&continued.replace('\n', "\r\n")).expect("a continued line"), mesh);
    // A comment ends with its line, whatever its last character is.
    let comment = TEXT.replace("# corner", "# from C:\\models\\");
    assert_eq!(parse(&comment).expect("a comment"), mesh);
    let error = parse("v 0 0 0\nv 1 0 \\\n0\nv 0 1 \\\nup\n").expect_err("a word that is not a number");
    assert_eq!(error.place, Place::Line(4), "{error}");
    assert!(parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 \\").is_ok(), "nothing to continue with");
    let bytes = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 \xff 4\n";
    let error = obj::parse(Path::new("a.obj"), bytes).expect_err("bytes that are not text");
    assert_eq!(error.place, Place::Line(5), "{error}");
}

#[test]
fn faces_that_are_not_convex_are_filled() {
    let vertices = "v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\n";
    let mesh = parse(&format!("{vertices}f 1 2 3 4 5 6\n")).expect("a mesh");
    assert_eq!((mesh.triangles.len(), mesh.area()), (4, 3.0));
    let mesh = parse(&format!("{vertices}f 6 5 4 3 2 1 6\ng next\nf 1 2 3\n")).expect("a mesh");
    assert_eq!((mesh.area(), mesh.groups[1].triangles.clone()), (3.5, 4..5));
    // Corners at the same place with different texture coordinates are one corner of the shape.
    let seam = "vt 0 0\nvt 1 1\nf 1/1 1/2 2/1 3/1 4/1 5/1 6/1\n";
    assert_eq!(parse(&format!("{vertices}{seam}")).expect("a mesh").area(), 3.0);
}

#[test]
fn missing_normals_become_smooth_ones() {
    let text = TEXT.replace("-2//1 -3//1 -1//1", "-2 -3 -1");
    let mesh = parse(&text).expect("a mesh");
    assert_eq!(mesh.normals.as_ref().expect("normals")[6], [0.0, 0.0, 1.0]);
}

#[test]
fn every_beginning_of_a_file_is_a_mesh_or_an_error() {
    let first_face = TEXT.find("f 1/1/1 2/2/1 3").expect("a face") + 15;
    truncate("a.obj", TEXT.as_bytes(), first_face, obj::parse);
    corrupt(TEXT.as_bytes(), obj::parse);
}

#[test]
fn errors_say_where_and_what() {
    let cases = [
        ("v 1 0 0", "v 1 0 O", 4, "`O`", "a finite number"),
        ("v 1 0 0", "v 1 0", 4, "the end of the line", "3 numbers"),
        ("v 1 0 0", "v 1 nan 0", 4, "`nan`", "a finite number"),
        ("vt 1 1", "vt", 9, "the end of the line", "u and v"),
        ("3/3/1 4", "5/3/1 4", 14, "vertex `5`", "1 to 4"),
        ("3/3/1 4", "3/5/1 4", 14, "texture coordinates `5`", "1 to 4"),
        ("3/3/1 4", "3/3/2 4", 14, "normal `2`", "1 or -1"),
        ("3/3/1 4", "0/3/1 4", 14, "vertex `0`", "1 to 4"),
        ("3/3/1 4", "/3/1 4", 14, "`/3/1`", "the index of a vertex"),
        ("3/3/1 4", "3/3/1/1 4", 14, "`3/3/1/1`", "three indices"),
        ("-1//1", "-9223372036854775808//1", 18, "vertex `-9223372036854775808`", "-1 to -5"),
        ("-1//1", "99999999999999999999//1", 18, "vertex", "1 to 5"),
        ("f -2//1 -3//1 -1//1", "f -2//1 -3//1", 18, "a face of 2 corners", "3 corners"),
    ];
    for (from, to, line, found, expected) in cases {
        let error = parse(&TEXT.replacen(from, to, 1)).expect_err(to);
        assert_eq!(error.place, Place::Line(line), "{error}");
        assert!(error.found.contains(found) && error.expected.contains(expected), "{error}");
    }
    for (text, expected) in [
        ("f 1 2 3\nv 0 0 0\n", "none, as no such line comes before"),
        ("v 0 0 0\nf 1 2 1\n", "1 or -1"),
        ("v 0 0 0\nf 1//1 1//1 1//1\n", "none, as no such line"),
    ] {
        let error = parse(text).expect_err(text);
        assert!(error.expected.contains(expected), "{error}");
    }
    assert!(parse("v 0 0 0\n").expect_err("no face").found.contains("no triangles"));
    let long = TEXT.replace("rough steel", &"steel".repeat(1000));
    assert_eq!(parse(&long).expect_err("a long name").place, Place::Line(13));
}

#[test]
fn materials_come_from_the_library_next_to_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.obj");
    std::fs::write(&path, TEXT).expect("a file");
    let missing = obj::read_with_materials(&path).expect_err("no library");
    assert!(missing.file.ends_with("some.mtl"), "{missing}");
    let library = folder.path().join("some.mtl");
    let text =
        "newmtl rough steel\nKd 0.5 0.25 0.125\nKs 1\nNs 20\nmap_Kd -s 1 1 1 steel.png\n# end\nnewmtl felt\nTr 0.25\n";
    std::fs::write(&library, text).expect("a file");
    let (mesh, materials) = obj::read_with_materials(&path).expect("both");
    assert_eq!(mesh.triangles.len(), 3);
    assert_eq!(materials.len(), 2);
    assert_eq!(materials[0].name, "rough steel");
    assert_eq!(materials[0].diffuse, Some([0.5, 0.25, 0.125]));
    assert_eq!(materials[0].specular, Some([1.0; 3]));
    assert_eq!(materials[0].diffuse_map.as_deref(), Some(Path::new("steel.png")));
    assert_eq!(materials[1].opacity, Some(0.75));
    for (wrong, line) in [("newmtl a\nKd 0.5 0.5", 2), ("newmtl a\nKd", 2), ("Kd 1 1 1", 1), ("newmtl a\nNs many", 2)] {
        std::fs::write(&library, wrong).expect("a file");
        assert_eq!(obj::materials(&library).expect_err(wrong).place, Place::Line(line), "{wrong}");
    }
}

#[test]
fn shared_files_have_their_counts() {
    let files = [
        ("bunny.obj", 6598, false),
        ("spot.obj", 23062, false),
        ("lionstatue.obj", 63338, false),
        ("dragon.obj", 46540, false),
        ("cloth_tshirt2iso_uv.obj", 6514, true),
        ("cloth_robe.obj", 940, true),
    ];
    for (name, triangles, textured) in files {
        let Some(path) = shared_file(&format!("data/geometry/{name}")) else { continue };
        let mesh = lobe_mesh::read(&path).expect(name);
        println!("{name}: {} vertices, {} groups", mesh.positions.len(), mesh.groups.len());
        assert_eq!(mesh.triangles.len(), triangles, "{name}");
        assert_eq!(mesh.uvs.is_some(), textured, "{name}");
        let mesh = mesh.complete();
        assert!(mesh.normals.is_some() && mesh.tangents.is_some() == textured, "{name}");
    }
}
