//! Images of environments: OpenEXR and Radiance HDR.

mod open_exr;
mod radiance;

use std::path::Path;

use lobe_colour::Primaries;

use super::PictureError;
use super::exr_file::content;
use crate::channels::Channels;
use crate::light::Environment;

/// What the first bytes of an OpenEXR file are.
const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Reads an image of longitude and latitude, turned about +y by an angle in radians, every radiance multiplied by
/// `scale`. Negative radiances, which resampling leaves in such files, count as 0.
///
/// What the header of a file says of its radiances is honoured: the exposures and colour corrections of Radiance HDR, the
/// order of its lines, the windows of OpenEXR, and the primaries of both. An image that the header says is anything but a
/// view of all directions in longitude and latitude is refused.
///
/// # Errors
/// If the file cannot be read, is damaged, has radiances that are not finite numbers, or says what cannot be honoured.
pub fn read_environment(path: &Path, turn: f32, scale: f32) -> Result<Environment, PictureError> {
    read_environment_as(path, turn, scale, |texel| texel)
}

/// As [`read_environment`], every radiance replaced by what `emission` makes of it.
///
/// # Errors
/// As [`read_environment`].
pub fn read_environment_as<S: Channels>(
    path: &Path,
    turn: f32,
    scale: f32,
    emission: impl Fn([f32; 3]) -> S,
) -> Result<Environment<S>, PictureError> {
    let bytes = lobe_files::bytes(path).map_err(|error| PictureError::Io { file: path.into(), error })?;
    let picture = if bytes.starts_with(&EXR) { open_exr::read(path, &bytes)? } else { radiance::read(path, &bytes)? };
    // What is not a number is left for the environment to refuse, with its place.
    let scaled = |x: f32| if x.is_finite() { (x * scale).max(0.0) } else { x };
    let wrong = |texel: &&[f32; 3]| !texel.iter().all(|x| x.is_finite());
    if let Some(texel) = picture.texels.iter().find(wrong) {
        // Found again with its place.
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
    /// The same in linear sRGB, if the colours are of other primaries.
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
