//! PNG, 8 bits a channel, tone-mapped.

use std::path::Path;

use super::{PictureError, ToneMap, replace};
use crate::film::Film;

/// The PNG file of pixels in sRGB: a byte each for red, green and blue, row by row from the top.
///
/// # Panics
/// Where a side is 0, or `bytes` are not three a pixel.
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
pub fn encode_png(film: &Film<3>, tone: ToneMap) -> Vec<u8> {
    let bytes: Vec<u8> =
        film.pixels().iter().flat_map(|pixel| pixel.mean_radiance().map(|radiance| tone.byte(radiance))).collect();
    encode_rgb(film.window().width, film.window().height, &bytes)
}

/// Writes a film as PNG.
///
/// # Errors
/// Where the system refuses.
pub fn write_png(path: &Path, film: &Film<3>, tone: ToneMap) -> Result<(), PictureError> {
    replace(path, &encode_png(film, tone))
}
