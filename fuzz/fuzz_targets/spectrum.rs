//! Spectra in text files, and their values in bands.
#![no_main]

use std::path::Path;
use std::sync::OnceLock;

use lobe_spectrum::{Bands, Spectrum};

static BANDS: OnceLock<Bands> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(spectrum) = Spectrum::parse(&String::from_utf8_lossy(bytes), Path::new("fuzz")) else { return };
    let bands = BANDS.get_or_init(|| Bands::uniform(8).expect("bands"));
    assert_eq!(bands.mean(&spectrum).len(), 8);
    assert_eq!(bands.at(&spectrum).len(), 8);
    for nm in [f64::NEG_INFINITY, 0.0, 380.0, 555.5, 1e9] {
        assert!(!spectrum.at(nm).is_nan(), "{nm} nm");
    }
});
