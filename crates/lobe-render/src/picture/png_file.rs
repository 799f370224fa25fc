//! Writes PNG, tone-mapped, with 8 bits per channel.

use std::path::Path;

use super::{PictureError, ToneMap, replace};
use crate::film::Film;
use crate::transport::Transport;

/// Encodes pixels in sRGB as PNG: one byte each for red, green and blue, row by row from the top.
///
/// # Panics
/// If a side is 0, or there are not three `bytes` per pixel.
pub fn encode_rgb(width: u32, height: u32, bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    // Pictures are written once and viewed often.
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("a picture with pixels");
    writer.write_image_data(bytes).expect("three bytes per pixel");
    writer.finish().expect("writing to memory");
    out
}

/// The quantity that a PNG shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shown {
    /// The colour of light.
    #[default]
    Colour,
    /// The degree of linear polarisation, from black to white.
    Degree,
    /// The angle of linear polarisation from the right of the picture as a hue, as bright as the degree.
    Angle,
}

/// Encodes a film as PNG.
pub fn encode_png(film: &Film, tone: ToneMap) -> Vec<u8> {
    encode_png_in(film, &(), tone, Shown::Colour)
}

/// Like [`encode_png`], for a film in these channels. Unpolarised light is black in views of polarisation.
pub fn encode_png_in<T: Transport>(film: &Film<T>, basis: &T::Basis, tone: ToneMap, shown: Shown) -> Vec<u8> {
    let plain = ToneMap { exposure: 0.0 };
    let polarisation = |pixel| T::linear_polarisation(basis, film.radiance(pixel)).unwrap_or_default();
    let bytes: Vec<u8> = match shown {
        Shown::Colour => film.colours_in(basis).flat_map(|colour| colour.map(|radiance| tone.byte(radiance))).collect(),
        Shown::Degree => {
            let byte = |degree: f32| (degree.clamp(0.0, 1.0) * 255.0).round() as u8;
            (0..film.pixels().len()).flat_map(|pixel| [byte(polarisation(pixel)[0]); 3]).collect()
        }
        Shown::Angle => (0..film.pixels().len())
            .flat_map(|pixel| {
                let [degree, angle] = polarisation(pixel);
                hue(angle / std::f32::consts::PI).map(|c| plain.byte(c * degree.clamp(0.0, 1.0)))
            })
            .collect(),
    };
    encode_rgb(film.window().width, film.window().height, &bytes)
}

/// A colour of the colour wheel, from red through green and blue back to red.
fn hue(turn: f32) -> [f32; 3] {
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|at| {
        let away = (turn - at).rem_euclid(1.0);
        (2.0 - 6.0 * away.min(1.0 - away)).clamp(0.0, 1.0)
    })
}

/// Writes a film as PNG.
///
/// # Errors
/// If the file cannot be written.
pub fn write_png(path: &Path, film: &Film, tone: ToneMap) -> Result<(), PictureError> {
    replace(path, &encode_png(film, tone))
}

/// Like [`write_png`], for a film in these channels.
///
/// # Errors
/// The same as for [`write_png`].
pub fn write_png_in<T: Transport>(
    path: &Path,
    film: &Film<T>,
    basis: &T::Basis,
    tone: ToneMap,
    shown: Shown,
) -> Result<(), PictureError> {
    replace(path, &encode_png_in(film, basis, tone, shown))
}
