//! Images of environments: OpenEXR and Radiance HDR.
#![no_main]

use lobe_render::picture::read_environment;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    // Whether it is a valid file does not matter here.
    lobe_fuzz::in_file(bytes, |path| drop(read_environment(path, 0.5, 2.0)));
});
