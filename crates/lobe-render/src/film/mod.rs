//! Films: the samples taken so far, in exact sums.
//!
//! Sums are integers: a radiance counts in units of `2^-64`, so adding is exact and the order of adding does not change
//! the result. This is why a picture has the same bits for any number of threads, tiles and machines.

mod pixel;
mod rect;
mod splats;

pub(crate) use pixel::{BRIGHTEST_UNITS, SURFACE_UNITS};
pub use pixel::{FirstHit, Pixel, RADIANCE_UNIT, SURFACE_UNIT, Sample};
pub use rect::Rect;
pub(crate) use splats::Splat;

use lobe_memory::{NoRoom, available};

use crate::camera::Filter;
use crate::channels::Channels;
use crate::transport::{Rgb, Transport};

/// The pixels in a window of a picture.
///
/// A pixel is the mean of the samples of its own paths, plus the mean over light paths of their splats.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film<T: Transport = Rgb> {
    window: Rect,
    pixels: Vec<Pixel<T>>,
    /// One per pixel; empty until light paths are added.
    splats: Vec<Splat<T>>,
}

impl<T: Transport> Film<T> {
    /// An empty film for these pixels of a picture.
    pub fn new(window: Rect) -> Self {
        Film { window, pixels: vec![Pixel::EMPTY; window.area()], splats: Vec::new() }
    }

    /// Like [`new`](Film::new), if there is enough memory for the film and for `more` bytes per pixel, which will be
    /// needed with it.
    ///
    /// # Errors
    /// [`NoRoom`] with the memory that it would take.
    pub fn try_new(window: Rect, more: usize) -> Result<Self, NoRoom> {
        let bytes = |each: usize| (window.area() as u64).saturating_mul(each as u64);
        lobe_memory::require(bytes(size_of::<Pixel<T>>() + more))?;
        let mut pixels = Vec::new();
        let refused = |_| NoRoom { needed: bytes(size_of::<Pixel<T>>()), available: available().unwrap_or(0) };
        pixels.try_reserve_exact(window.area()).map_err(refused)?;
        pixels.resize(window.area(), Pixel::EMPTY);
        Ok(Film { window, pixels, splats: Vec::new() })
    }

    /// The pixels of the picture that the film has.
    pub fn window(&self) -> Rect {
        self.window
    }

    /// The pixels, row by row from the top.
    pub fn pixels(&self) -> &[Pixel<T>] {
        &self.pixels
    }

    /// The pixels for writing, row by row from the top.
    pub fn pixels_mut(&mut self) -> &mut [Pixel<T>] {
        &mut self.pixels
    }

    /// Adds the sums of another film, as far as their windows overlap.
    pub fn merge(&mut self, other: &Film<T>) {
        let Some(shared) = self.window.intersection(&other.window) else { return };
        for y in shared.rows() {
            for x in shared.columns() {
                let at = self.index(x, y);
                self.pixels[at].merge(&other.pixels[other.index(x, y)]);
            }
        }
        self.merge_splats(other, shared);
    }

    /// The index of a pixel of the picture in [`pixels`](Film::pixels).
    ///
    /// # Panics
    /// If the pixel is left of or above the window.
    pub fn index(&self, x: u32, y: u32) -> usize {
        (y - self.window.y) as usize * self.window.width as usize + (x - self.window.x) as usize
    }

    /// The smallest and the largest number of samples of a pixel.
    pub fn samples(&self) -> (u32, u32) {
        let counts = || self.pixels.iter().map(|pixel| pixel.samples);
        (counts().min().unwrap_or(0), counts().max().unwrap_or(0))
    }

    /// The radiance of a pixel: the mean of its samples plus the mean of its splats.
    pub fn radiance(&self, index: usize) -> T::Radiance {
        let mut radiance = self.pixels[index].mean_radiance();
        if let Some(splat) = self.splats.get(index) {
            let splatted = splat.mean_radiance();
            radiance.as_mut().iter_mut().zip(splatted.as_ref()).for_each(|(sum, more)| *sum += more);
        }
        radiance
    }

    /// The colours of the pixels in linear sRGB, row by row from the top.
    pub fn colours_in<'a>(&'a self, basis: &'a T::Basis) -> impl Iterator<Item = [f32; 3]> + 'a {
        (0..self.pixels.len()).map(|index| T::colour(basis, self.radiance(index)))
    }
}

impl<T: Transport<Basis = ()>> Film<T> {
    /// The colours of the pixels in linear sRGB, row by row from the top.
    pub fn colours(&self) -> impl Iterator<Item = [f32; 3]> {
        (0..self.pixels.len()).map(|index| T::colour(&(), self.radiance(index)))
    }
}
