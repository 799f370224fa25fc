//! Sidecars: if one is valid, writing and parsing it again must give the same options. The target `import` reads tables
//! with them.
#![no_main]

use std::path::Path;

use lobe_formats::sidecar;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("fuzz");
    if let Ok(options) = sidecar::parse(&String::from_utf8_lossy(bytes), path) {
        let text = sidecar::to_text(&options, "fuzz");
        assert_eq!(sidecar::parse(&text, path).as_ref(), Ok(&options), "{text}");
    }
});
