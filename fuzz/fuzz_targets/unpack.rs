//! Anything packed with gzip, what it is, and readers of what was in it.
#![no_main]

use std::io::Write as _;
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("fuzz.gz");
    let _ = lobe_formats::from_bytes(bytes, path);
    let mut encoder = GzEncoder::new(Vec::new(), Compression::none());
    encoder.write_all(bytes).expect("memory");
    let _ = lobe_formats::from_bytes(&encoder.finish().expect("memory"), path);
    drop(lobe_files::content(bytes, path));
});
