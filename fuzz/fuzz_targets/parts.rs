//! Parts of pictures: reads their headers and sums, merges them, and writes the result.
#![no_main]

use std::path::Path;

use lobe_render::picture::{Shown, ToneMap, encode_png_in, inspect};
use lobe_render::{Bands, Rgb, Stokes16, StokesRgb, Transport, merge_in};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    lobe_fuzz::in_file(bytes, |path| {
        let Ok(found) = inspect(path) else { return };
        let Ok(bands) = found.light.bands() else { return };
        match bands {
            None if found.light.stokes => merged::<StokesRgb>(path, &()),
            None => merged::<Rgb>(path, &()),
            Some(bands) if found.light.stokes => merged::<Stokes16>(path, &bands),
            Some(bands) if bands.count() <= 8 => merged::<Bands<8>>(path, &bands),
            Some(bands) if bands.count() <= 16 => merged::<Bands<16>>(path, &bands),
            Some(bands) => merged::<Bands<32>>(path, &bands),
        }
    });
});

fn merged<T: Transport>(path: &Path, basis: &T::Basis) {
    let _ = merge_in::<T>(&[path], false, basis);
    let Ok((film, meta)) = merge_in::<T>(&[path], true, basis) else { return };
    let tone = ToneMap { exposure: meta.exposure };
    let _ = encode_png_in(&film, basis, tone, Shown::Colour);
}
