//! A table with its options: the text of a sidecar up to a zero byte, then the table.
#![no_main]

use std::path::Path;

// What counts memory.
use lobe_fuzz as _;

use lobe_formats::{Format, sidecar};
use lobe_testing::probe::probe_with;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let at = bytes.iter().position(|byte| *byte == 0).unwrap_or(0);
    let (said, table) = bytes.split_at(at);
    let Ok(options) = sidecar::parse(&String::from_utf8_lossy(said), Path::new("said")) else { return };
    // The written options must mean the same.
    let text = sidecar::to_text(&options, "fuzz");
    assert_eq!(sidecar::parse(&text, Path::new("said")).as_ref(), Ok(&options), "{text}");
    let _ = probe_with(Format::Goniometer, table.strip_prefix(b"\0").unwrap_or(table), Path::new("fuzz"), &options);
});
