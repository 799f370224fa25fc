//! Images of environments: OpenEXR and Radiance HDR.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{ReadChannels, ReadLayers};

use super::PictureError;
use super::exr_file::{check_size, content};
use crate::light::Environment;

/// What the first bytes of an OpenEXR file are.
const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Reads an image of longitude and latitude, turned about +y by an angle in radians, every radiance multiplied by
/// `scale`. Negative radiances, which resampling leaves in such files, count as 0.
///
/// # Errors
/// If the file cannot be read, is damaged, or has radiances that are not finite numbers.
pub fn read_environment(path: &Path, turn: f32, scale: f32) -> Result<Environment, PictureError> {
    let bytes = lobe_files::bytes(path).map_err(|error| PictureError::Io { file: path.into(), error })?;
    let (width, height, texels) = if bytes.starts_with(&EXR) { exr(path, &bytes)? } else { hdr(path, &bytes)? };
    let texels = texels.into_iter().map(|texel| texel.map(|x| (x * scale).max(if x.is_nan() { x } else { 0.0 })));
    Environment::image(width, height, texels.collect(), turn)
        .map_err(|error| content(path, error, "an image of an environment"))
}

type Texels = (usize, usize, Vec<[f32; 3]>);

fn exr(path: &Path, bytes: &[u8]) -> Result<Texels, PictureError> {
    check_size(path, bytes)?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.0, vec![[0.0f32; 3]; size.area()]),
            |(width, texels), at, (r, g, b, _): (f32, f32, f32, f32)| texels[at.1 * *width + at.0] = [r, g, b],
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| content(path, error, "an EXR file with the channels R, G and B"))?;
    let layer = image.layer_data;
    let (width, texels) = layer.channel_data.pixels;
    Ok((width, layer.size.1, texels))
}

fn hdr(path: &Path, bytes: &[u8]) -> Result<Texels, PictureError> {
    const EXPECTED: &str = "an OpenEXR or Radiance HDR file";
    let wrong = |error: zune_hdr::HdrDecodeErrors| content(path, format!("{error:?}"), EXPECTED);
    let mut decoder = zune_hdr::HdrDecoder::new(zune_core::bytestream::ZCursor::new(bytes));
    decoder.decode_headers().map_err(wrong)?;
    let (width, height) = decoder.dimensions().ok_or_else(|| content(path, "no size", EXPECTED))?;
    // Four runs of one byte take eight bytes for at most 127 texels.
    if width.saturating_mul(height) / 16 > bytes.len() {
        return Err(content(path, format!("{width} x {height} texels in {} bytes", bytes.len()), EXPECTED));
    }
    let values = decoder.decode().map_err(wrong)?;
    Ok((width, height, values.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect()))
}
