//! Reads images of environments: OpenEXR and Radiance HDR.

mod open_exr;
mod radiance;

use std::path::Path;

use lobe_colour::Primaries;

use super::PictureError;
use super::exr_file::content;
use crate::channels::Channels;
use crate::light::Environment;

/// The first bytes of an OpenEXR file.
const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Reads an image of longitude and latitude, rotates it about +y by an angle in radians, and multiplies every radiance
/// by `scale`. Negative radiances, which resampling leaves in such files, count as 0.
///
/// The header of the file is taken into account: the exposures, colour corrections and order of lines of Radiance HDR,
/// the windows of OpenEXR, and the primaries of both. An image is refused if its header says that it is not a view of
/// all directions in longitude and latitude.
///
/// # Errors
/// If the file cannot be read, is damaged, has radiances that are not finite numbers, or has a header that is not
/// supported.
pub fn read_environment(path: &Path, turn: f32, scale: f32) -> Result<Environment, PictureError> {
    read_environment_as(path, turn, scale, |texel| texel)
}

/// Like [`read_environment`], with `emission` applied to every radiance.
///
/// # Errors
/// The same as for [`read_environment`].
pub fn read_environment_as<S: Channels>(
    path: &Path,
    turn: f32,
    scale: f32,
    emission: impl Fn([f32; 3]) -> S,
) -> Result<Environment<S>, PictureError> {
    let bytes = lobe_files::bytes(path).map_err(|error| PictureError::Io { file: path.into(), error })?;
    let picture = if bytes.starts_with(&EXR) { open_exr::read(path, &bytes)? } else { radiance::read(path, &bytes)? };
    // The environment refuses values that are not numbers, with their place.
    let scaled = |x: f32| if x.is_finite() { (x * scale).max(0.0) } else { x };
    let wrong = |texel: &&[f32; 3]| !texel.iter().all(|x| x.is_finite());
    if let Some(texel) = picture.texels.iter().find(wrong) {
        // Searched for again to report its place.
        Environment::image(picture.width, picture.height, picture.texels.clone(), turn)
            .map_err(|error| content(path, error, "an image of an environment"))?;
        return Err(content(path, format!("{texel:?}"), "an image of an environment"));
    }
    let texels = picture.texels.into_iter().map(|texel| emission(texel.map(scaled))).collect();
    Environment::image(picture.width, picture.height, texels, turn)
        .map_err(|error| content(path, error, "an image of an environment"))
}

/// Radiances in linear sRGB, in rows from the top, from the left.
struct Picture {
    width: usize,
    height: usize,
    texels: Vec<[f32; 3]>,
}

impl Picture {
    /// The image in linear sRGB, if it has other primaries.
    fn of_primaries(mut self, path: &Path, primaries: &Primaries) -> Result<Picture, PictureError> {
        if primaries.is_srgb() {
            return Ok(self);
        }
        let Some(matrix) = primaries.to_srgb() else {
            let found = format!("the primaries {primaries:?}");
            return Err(content(path, found, "the chromaticities of red, green, blue and white"));
        };
        for texel in &mut self.texels {
            let rgb = texel.map(f64::from);
            *texel = matrix.map(|row| row.iter().zip(rgb).map(|(a, b)| a * b).sum::<f64>() as f32);
        }
        Ok(self)
    }
}

/// Refuses an image whose texels are not square, unless that makes it twice as wide as high, as all directions are.
fn check_shape(path: &Path, [width, height]: [usize; 2], width_of_texel: f64) -> Result<(), PictureError> {
    let shape = width as f64 * width_of_texel / height as f64;
    if (width_of_texel - 1.0).abs() < 1e-3 || (shape - 2.0).abs() < 0.02 {
        return Ok(());
    }
    let found = format!("{width} x {height} texels, {width_of_texel} times as wide as high, which is {shape:.3} to 1");
    Err(content(path, found, "square texels, or an image twice as wide as high: longitude and latitude"))
}
