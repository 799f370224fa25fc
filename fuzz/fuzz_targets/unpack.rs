//! Files packed with gzip: unpacking, the recognition of their contents, and the readers.
#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("fuzz.gz");
    let _ = lobe_formats::from_bytes(bytes, path);
    let _ = lobe_formats::from_bytes(&lobe_fuzz::gzip(bytes), path);
    drop(lobe_files::content(bytes, path));
});
