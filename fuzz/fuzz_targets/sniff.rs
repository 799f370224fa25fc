//! Any file: its format is detected, and the reader of that format reads it.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Some(format) = lobe_formats::sniff(bytes) {
        lobe_fuzz::read(format, bytes);
    }
});
