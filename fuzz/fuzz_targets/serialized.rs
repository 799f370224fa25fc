//! Meshes of Mitsuba: the bytes as a file, and as the decompressed content of a shape.
#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("fuzz");
    // It does not matter here if the file is valid.
    let _ = lobe_mesh::serialized::parse(path, bytes);
    let mut file = vec![0x1c, 4, 4, 0];
    file.extend(lobe_fuzz::zlib(bytes));
    file.extend([0; 8]);
    file.extend(1_u32.to_le_bytes());
    let _ = lobe_mesh::serialized::parse(path, &file);
});
