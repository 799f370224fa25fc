//! PNG, 8 bits a channel, tone-mapped.

use std::path::Path;

use super::{PictureError, ToneMap, replace};
use crate::film::Film;

/// The PNG file of a film.
pub fn encode_png(film: &Film<3>, tone: ToneMap) -> Vec<u8> {
    let bytes: Vec<u8> =
        film.pixels().iter().flat_map(|pixel| pixel.mean_radiance().map(|radiance| tone.byte(radiance))).collect();
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, film.window().width, film.window().height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    // Pictures are written once and looked at often.
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("writing to memory");
    writer.write_image_data(&bytes).expect("as many bytes as the header says");
    writer.finish().expect("writing to memory");
    out
}

/// Writes a film as PNG.
///
/// # Errors
/// Where the system refuses.
pub fn write_png(path: &Path, film: &Film<3>, tone: ToneMap) -> Result<(), PictureError> {
    replace(path, &encode_png(film, tone))
}
