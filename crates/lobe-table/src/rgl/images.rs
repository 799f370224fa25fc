//! Images on the unit square.

use std::sync::Arc;

use crate::invalid::{Invalid, count, finite};

/// Images on the unit square, `[slice][row][column]`: the row is `u.y`, an azimuth; the column is `u.x`, a zenith
/// angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Images {
    pub(super) slices: usize,
    pub(super) height: usize,
    pub(super) width: usize,
    /// Shared, so that an evaluator can also keep them.
    pub(super) texels: Arc<Vec<f32>>,
}

impl Images {
    /// Checks that the texels are finite and fill `[slices][height][width]`, with at least two rows and columns, so
    /// that there is a cell to interpolate in. `part` names the images in the error.
    ///
    /// # Errors
    /// [`Invalid`] says which of these conditions is violated.
    pub fn new(part: &'static str, [slices, height, width]: [usize; 3], texels: Vec<f32>) -> Result<Self, Invalid> {
        if slices == 0 || height < 2 || width < 2 {
            let found = format!("{slices} slices of {height} x {width} texels");
            return Err(Invalid::new(part, found, "at least one slice of at least 2 x 2 texels"));
        }
        count(part, texels.len(), &[slices, height, width])?;
        finite(part, &texels)?;
        Ok(Images { slices, height, width, texels: Arc::new(texels) })
    }

    /// The number of images.
    pub fn slices(&self) -> usize {
        self.slices
    }

    /// The numbers of rows and columns of each image.
    pub fn size(&self) -> [usize; 2] {
        [self.height, self.width]
    }

    /// All texels, `[slice][row][column]`.
    pub fn texels(&self) -> &[f32] {
        &self.texels
    }

    /// The texels of one image, `[row][column]`.
    ///
    /// # Panics
    /// If there is no such slice.
    pub fn slice(&self, index: usize) -> &[f32] {
        &self.texels[index * self.height * self.width..][..self.height * self.width]
    }

    /// The bilinear value of one image at `u`, which is clamped to the unit square.
    ///
    /// # Panics
    /// If there is no such slice.
    pub fn bilinear(&self, index: usize, u: [f64; 2]) -> f64 {
        let image = self.slice(index);
        bilinear(self, u, |texel| f64::from(image[texel]))
    }
}

/// The bilinear value at `u` of the blended images. Positions are clamped to the unit square.
pub(super) fn bilinear(images: &Images, u: [f64; 2], value: impl Fn(usize) -> f64) -> f64 {
    let [height, width] = images.size();
    let ((col, fx), (row, fy)) = (place(u[0], width), place(u[1], height));
    let at = |r: usize, c: usize| value((row + r) * width + col + c);
    lerp(lerp(at(0, 0), at(0, 1), fx), lerp(at(1, 0), at(1, 1), fx), fy)
}

/// A coordinate in `[0, 1]` as a cell and a fraction, for `n` texels.
pub(super) fn place(u: f64, n: usize) -> (usize, f64) {
    let x = u.clamp(0.0, 1.0) * (n - 1) as f64;
    let cell = (x as usize).min(n - 2);
    (cell, x - cell as f64)
}

pub(super) fn lerp(a: f64, b: f64, t: f64) -> f64 {
    (1.0 - t) * a + t * b
}
