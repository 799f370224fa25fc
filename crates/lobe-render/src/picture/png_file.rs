//! PNG, 8 bits per channel, tone-mapped.

use std::path::Path;

use super::{PictureError, ToneMap, replace};
use crate::film::Film;

/// The PNG file of pixels in sRGB: a byte each for red, green and blue, row by row from the top.
///
/// # Panics
/// If a side is 0, or `bytes` are not three per pixel.
pub fn encode_rgb(width: u32, height: u32, bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    // Pictures are written once and looked at often.
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("a picture with pixels");
    writer.write_image_data(bytes).expect("three bytes a pixel");
    writer.finish().expect("writing to memory");
    out
}

/// The PNG file of a film.
pub fn encode_png(film: &Film, tone: ToneMap) -> Vec<u8> {
    let bytes: Vec<u8> = film.colours().flat_map(|colour| colour.map(|radiance| tone.byte(radiance))).collect();
    encode_rgb(film.window().width, film.window().height, &bytes)
}

/// Writes a film as PNG.
///
/// # Errors
/// If the system refuses.
pub fn write_png(path: &Path, film: &Film, tone: ToneMap) -> Result<(), PictureError> {
    replace(path, &encode_png(film, tone))
}
