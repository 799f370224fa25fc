//! Meshes in PLY, OBJ and glTF, and what is computed from them. Mitsuba meshes have their own target.
#![no_main]

use std::path::Path;

use lobe_mesh::{gltf, obj, ply};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("fuzz");
    let mesh = match bytes {
        [b'p', b'l', b'y', ..] => ply::parse(path, bytes),
        [b'g', b'l', b'T', b'F', ..] | [b'{', ..] => gltf::parse(path, bytes),
        _ => obj::parse(path, bytes),
    };
    if let Ok(mesh) = mesh {
        let mesh = mesh.complete();
        assert!(mesh.normals.is_some());
        if mesh.triangles.len() < 1000 {
            let _ = mesh.refined(2);
        }
    }
});
