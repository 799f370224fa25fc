//! Tests of glTF, as text and as a single binary file.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use lobe_mesh::{FormatError, Geometry, gltf};
use lobe_testing::damage::{corrupt, truncate};

/// A square in the plane z = 0: positions, normals, texture coordinates and indices.
fn buffer() -> Vec<u8> {
    let positions = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let uvs = [[0.0f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let numbers = positions.iter().flatten().chain([[0.0f32, 0.0, 1.0]; 4].as_flattened()).chain(uvs.as_flattened());
    let mut bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

/// The square twice: as it is, and under a parent node, twice as large, mirrored in x and moved to z = 5.
fn json(uri: Option<&str>) -> String {
    let uri = uri.map_or(String::new(), |uri| format!(r#""uri": "{uri}", "#));
    format!(
        r#"{{"asset": {{"version": "2.0"}},
"scene": 0, "scenes": [{{"nodes": [0, 1]}}],
"nodes": [{{"name": "first", "mesh": 0}},
 {{"translation": [0, 0, 5], "children": [2]}},
 {{"name": "second", "mesh": 0, "scale": [-2, 2, 2]}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}, "indices": 3, "material": 0}}]}}],
"materials": [{{"name": "felt"}}],
"accessors": [
 {{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
 {{"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC3"}},
 {{"bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 4, "type": "VEC2"}},
 {{"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}}],
"bufferViews": [{{"buffer": 0, "byteLength": 128}}, {{"buffer": 0, "byteOffset": 128, "byteLength": 12}}],
"buffers": [{{{uri}"byteLength": 140}}]}}"#
    )
}

fn text() -> String {
    json(Some(&format!("data:application/octet-stream;base64,{}", STANDARD.encode(buffer()))))
}

fn binary() -> Vec<u8> {
    let mut json = json(None).into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let buffer = buffer();
    let mut bytes = b"glTF".to_vec();
    let word = |bytes: &mut Vec<u8>, word: usize| bytes.extend((word as u32).to_le_bytes());
    word(&mut bytes, 2);
    word(&mut bytes, 12 + 8 + json.len() + 8 + buffer.len());
    word(&mut bytes, json.len());
    bytes.extend(b"JSON");
    bytes.extend(&json);
    word(&mut bytes, buffer.len());
    bytes.extend(b"BIN\0");
    bytes.extend(&buffer);
    bytes
}

fn parse(text: &str) -> Result<Geometry, FormatError> {
    gltf::parse(Path::new("a.gltf"), text.as_bytes())
}

#[test]
fn meshes_stand_where_their_nodes_put_them() {
    let mesh = parse(&text()).expect("a mesh");
    assert_eq!(mesh.positions[2], [1.0, 1.0, 0.0]);
    assert_eq!(mesh.positions[6], [-2.0, 2.0, 5.0]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]], "a reflection reverses triangles");
    assert_eq!(mesh.normals, Some(vec![[0.0, 0.0, 1.0]; 8]));
    assert_eq!(mesh.uvs.as_ref().expect("texture coordinates")[2], [1.0, 1.0], "v points up");
    let groups: Vec<_> = mesh.groups.iter().map(|group| (group.name.as_str(), group.material.as_deref())).collect();
    assert_eq!(groups, [("first", Some("felt")), ("second", Some("felt"))]);
    let complete = mesh.clone().complete();
    let tangents = complete.tangents.as_ref().expect("tangents");
    assert_eq!((tangents[0], tangents[4]), ([1.0, 0.0, 0.0, 1.0], [-1.0, 0.0, 0.0, -1.0]));
    assert_eq!(gltf::parse(Path::new("a.glb"), &binary()).expect("a binary"), mesh);
}

#[test]
fn buffers_may_be_files_next_to_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, json(Some("a%20buffer.bin"))).expect("a file");
    let missing = gltf::read(&path).expect_err("no buffer");
    assert!(missing.file.ends_with("a buffer.bin"), "{missing}");
    std::fs::write(folder.path().join("a buffer.bin"), &buffer()[..139]).expect("a file");
    assert!(gltf::read(&path).expect_err("too short").to_string().contains("139 bytes of buffer 0"));
    std::fs::write(folder.path().join("a buffer.bin"), buffer()).expect("a file");
    assert_eq!(gltf::read(&path).expect("a mesh"), parse(&text()).expect("a mesh"));
    for elsewhere in ["../a.bin", "/etc/passwd", "file:///etc/passwd", "https://example.org/a.bin"] {
        let error = parse(&json(Some(elsewhere))).expect_err(elsewhere);
        assert!(error.expected.contains("the same folder"), "{error}");
    }
}

#[test]
fn every_beginning_of_a_file_is_an_error() {
    let (text, binary) = (text(), binary());
    truncate("a.gltf", text.as_bytes(), text.len(), gltf::parse);
    truncate("a.glb", &binary, binary.len(), gltf::parse);
    corrupt(&binary, gltf::parse);
    corrupt(text.as_bytes(), gltf::parse);
}

#[test]
fn errors_say_what_is_wrong() {
    let cases = [
        (r#""children": [2]"#, r#""children": [1]"#, "node 1 in two places"),
        (r#""children": [2]"#, r#""children": [0]"#, "node 0 in two places"),
        (r#""children": [2]"#, r#""children": [7]"#, "node 7"),
        (r#""scene": 0"#, r#""scene": 4"#, "scene 4"),
        (r#""mesh": 0, "scale""#, r#""mesh": 3, "scale""#, "mesh 3"),
        (r#""material": 0"#, r#""material": 9"#, "material 9"),
        (r#""indices": 3"#, r#""indices": 30"#, "accessor 30"),
        (r#""indices": 3"#, r#""indices": 0"#, "component type 5126 in accessor 0"),
        (r#""NORMAL": 1"#, r#""NORMAL": 2"#, "VEC2 in accessor 2"),
        (r#""count": 6"#, r#""count": 600"#, "600 elements"),
        (r#""count": 6"#, r#""count": 18446744073709551615"#, "more vertices"),
        (r#""byteOffset": 96"#, r#""byteOffset": 18446744073709551615"#, "elements from byte 18446744073709551615"),
        (r#""byteLength": 128"#, r#""byteLength": 1280"#, "1280 bytes from 0"),
        (r#""buffer": 0, "byteLength": 128"#, r#""buffer": 2, "byteLength": 128"#, "buffer 2"),
        (r#""byteLength": 128"#, r#""byteLength": 128, "byteStride": 4"#, "byteStride of 4"),
        (r#""byteLength": 140"#, r#""byteLength": 141"#, "140 bytes of buffer 0"),
        (r#""version": "2.0""#, r#""version": "1.0""#, "glTF version 1.0"),
        (r#""scene": 0"#, r#""extensionsRequired": ["KHR_draco_mesh_compression"]"#, "KHR_draco_mesh_compression"),
        (r#""scale": [-2, 2, 2]"#, r#""scale": [1e300, 2, 2]"#, "inf in the position of vertex"),
        (r#""mesh": 0"#, r#""camera": 0"#, "no triangles"),
        (r#""version": "2.0""#, r#""version": "2.1", "minVersion": "2.1""#, "readers of version 2.1"),
        (r#""indices": 3"#, r#""indices": 3, "mode": 7"#, "mode 7"),
        (r#""count": 6"#, r#""count": 6, "normalized": true"#, "normalized indices in accessor 3"),
        (r#"{"bufferView": 0, "componentType""#, r#"{"componentType""#, "no positions in accessor 0"),
        (r#""mesh": 0, "scale""#, r#""skin": 0, "mesh": 0, "scale""#, "skin 0"),
        ("base64,", "base64,!", "the data uri of buffer 0"),
    ];
    for (from, to, found) in cases {
        let all = text().contains(from);
        assert!(all, "{from}");
        let error = parse(&text().replace(from, to)).expect_err(to);
        assert!(error.to_string().contains(found), "{error}");
    }
    let index = json(None).replace(
        r#""byteLength": 140"#,
        &format!(r#""byteLength": 140, "uri": "data:;base64,{}""#, {
            let mut buffer = buffer();
            buffer[138] = 4;
            STANDARD.encode(buffer)
        }),
    );
    assert!(parse(&index).expect_err("an index").to_string().contains("index 4 in accessor 3; expected less than 4"));
}

#[test]
fn a_small_file_cannot_ask_for_much() {
    // A square placed by a hundred thousand nodes, and an accessor of zeros that no buffer holds.
    let many: Vec<String> = (0..100_000).map(|_| r#"{"mesh": 0}"#.to_owned()).collect();
    let list: Vec<String> = (0..100_000).map(|i| i.to_string()).collect();
    let text = text();
    let nodes = text.find(r#""nodes": [{"name""#).expect("nodes")..text.find(r#""meshes""#).expect("meshes");
    let crowd = text.replace(&text[nodes], &format!(r#""nodes": [{}],"#, many.join(",")));
    let crowd = crowd.replace(r#"{"nodes": [0, 1]}"#, &format!(r#"{{"nodes": [{}]}}"#, list.join(",")));
    assert_eq!(parse(&crowd).expect("a crowd within bounds").triangles.len(), 200_000);
    let zeros = r#"{"componentType": 5126, "count": 900000000, "type": "VEC3"}"#;
    let zeros = text.replacen(r#"{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}"#, zeros, 1);
    assert!(parse(&zeros).expect_err("too much").to_string().contains("files of this size"));
}

#[test]
fn strips_fans_and_sparse_accessors() {
    let strip = text().replace(r#""indices": 3, "#, r#""mode": 5, "#);
    assert_eq!(parse(&strip).expect("a strip").triangles[..2], [[0, 1, 2], [1, 3, 2]]);
    let fan = text().replace(r#""indices": 3, "#, r#""mode": 6, "#);
    assert_eq!(parse(&fan).expect("a fan").triangles[..2], [[1, 2, 0], [2, 3, 0]]);
    // Vertex 1, named by the second index, moves to the first position of the buffer.
    let sparse = r#""count": 4, "sparse": {"count": 1, "indices": {"bufferView": 1, "byteOffset": 2, "componentType": 5123},
        "values": {"bufferView": 0, "byteOffset": 24}}, "type": "VEC3"}"#;
    let sparse = text().replacen(r#""count": 4, "type": "VEC3"}"#, sparse, 1);
    assert_eq!(parse(&sparse).expect("a sparse accessor").positions[..3], [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    let outside = sparse.replace(r#""byteOffset": 2,"#, r#""byteOffset": 128,"#);
    assert!(parse(&outside).is_err());
}

/// A morph target that moves the square by its own positions, and a skin of two joints.
#[test]
fn morph_targets_and_skins_are_applied_at_rest() {
    let targets = r#""indices": 3, "targets": [{"POSITION": 0}, {"POSITION": 1}]"#;
    let morphed = text().replace(r#""indices": 3"#, targets);
    let rest = parse(&text()).expect("a mesh");
    assert_eq!(parse(&morphed).expect("without weights"), rest);
    let of_mesh = morphed.replace(r#""meshes": [{"#, r#""meshes": [{"weights": [0.5, 2.0], "#);
    let mesh = parse(&of_mesh).expect("weights of the mesh");
    assert_eq!(mesh.positions[2], [1.5, 1.5, 2.0]);
    let of_node = of_mesh.replace(r#"{"name": "first", "#, r#"{"name": "first", "weights": [0.0, -1.0], "#);
    assert_eq!(parse(&of_node).expect("weights of a node").positions[2], [1.0, 1.0, -1.0]);

    // The first two vertices follow node 2, the others are halfway between it and the parent, node 1.
    let mut bytes = buffer();
    for joints in [[0u8, 0, 0, 0], [0, 0, 0, 0], [0, 1, 0, 0], [0, 1, 0, 0]] {
        bytes.extend(joints);
    }
    for weights in [[255u8, 0, 0, 0], [255, 0, 0, 0], [100, 100, 0, 0], [100, 100, 0, 0]] {
        bytes.extend(weights);
    }
    let uri = format!("data:;base64,{}", STANDARD.encode(&bytes));
    let skinned = json(Some(&uri))
        .replace(r#""byteLength": 140}]"#, r#""byteLength": 172}]"#)
        .replace(r#""byteOffset": 128, "byteLength": 12}"#, r#""byteOffset": 128, "byteLength": 44}"#)
        .replace(
            r#""count": 6, "type": "SCALAR"}"#,
            r#""count": 6, "type": "SCALAR"},
            {"bufferView": 1, "byteOffset": 12, "componentType": 5121, "count": 4, "type": "VEC4"},
            {"bufferView": 1, "byteOffset": 28, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4"}"#,
        )
        .replace(r#""TEXCOORD_0": 2"#, r#""TEXCOORD_0": 2, "JOINTS_0": 4, "WEIGHTS_0": 5"#)
        .replace(r#"{"name": "first", "#, r#"{"name": "first", "skin": 0, "translation": [9, 9, 9], "#)
        .replace(r#""materials""#, r#""skins": [{"joints": [2, 1]}], "materials""#);
    let mesh = parse(&skinned).expect("a skin");
    // Node 2: (-2x, 2y, 2z + 5). Node 1: (x, y, z + 5). The place of the mesh's own node does not count.
    assert_eq!(mesh.positions[..4], [[0.0, 0.0, 5.0], [-2.0, 0.0, 5.0], [-0.5, 1.5, 5.0], [0.0, 1.5, 5.0]]);
    assert_eq!(mesh.positions[4..], rest.positions[4..]);
    for (from, to, found) in [
        (r#""joints": [2, 1]"#, r#""joints": [2]"#, "joint 1 of vertex 2"),
        (r#""joints": [2, 1]"#, r#""joints": [2, 9]"#, "joint 9 of skin 0"),
        (r#", "WEIGHTS_0": 5"#, "", "a mesh of skin 0"),
        (r#""WEIGHTS_0": 5"#, r#""WEIGHTS_0": 5, "JOINTS_1": 4"#, "a mesh of skin 0"),
    ] {
        let error = parse(&skinned.replace(from, to)).expect_err(to);
        assert!(error.to_string().contains(found), "{error}");
    }
}
