//! What has been seen so far, in sums that are exact.
//!
//! Sums are integers: a radiance counts in units of `2^-64`, so that adding is exact and the order of adding cannot be
//! told from the result. That is what makes pictures of any number of threads, tiles and machines the same bits.

use std::ops::Range;

/// A rectangle of pixels; rows count downward from the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// The leftmost column.
    pub x: u32,
    /// The top row.
    pub y: u32,
    /// How many columns.
    pub width: u32,
    /// How many rows.
    pub height: u32,
}

impl Rect {
    /// How many pixels.
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The columns.
    pub fn columns(&self) -> Range<u32> {
        self.x..self.x + self.width
    }

    /// The rows.
    pub fn rows(&self) -> Range<u32> {
        self.y..self.y + self.height
    }

    /// What both have; `None` where that is nothing.
    pub fn intersection(&self, other: &Rect) -> Option<Rect> {
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let right = self.columns().end.min(other.columns().end);
        let bottom = self.rows().end.min(other.rows().end);
        (x < right && y < bottom).then(|| Rect { x, y, width: right - x, height: bottom - y })
    }
}

/// What one path saw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<const C: usize> {
    /// Radiance that came along it, one value a channel.
    pub radiance: [f32; C],
    /// Albedo of the first surface; 0 where there is none.
    pub albedo: [f32; C],
    /// Shading normal of the first surface in the world; 0 where there is none.
    pub normal: [f32; 3],
    /// Distance to the first surface; infinite where there is none.
    pub depth: f32,
    /// The material of the first surface, counted from 1; 0 where there is none.
    pub material: u32,
}

impl<const C: usize> Sample<C> {
    /// A path that met nothing.
    pub const EMPTY: Self =
        Sample { radiance: [0.0; C], albedo: [0.0; C], normal: [0.0; 3], depth: f32::INFINITY, material: 0 };
}

/// The sums of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel<const C: usize> {
    /// Radiance in units of [`Pixel::RADIANCE`].
    pub radiance: [i128; C],
    /// Albedo in units of [`Pixel::SURFACE`].
    pub albedo: [i64; C],
    /// Normal in units of [`Pixel::SURFACE`].
    pub normal: [i64; 3],
    /// How many samples were added.
    pub samples: u32,
    /// The bits of the smallest distance, which for positive floats are in the order of the floats.
    pub depth: u32,
    /// The material there.
    pub material: u32,
}

impl<const C: usize> Pixel<C> {
    /// Nothing seen yet.
    pub const EMPTY: Self = Pixel {
        radiance: [0; C],
        albedo: [0; C],
        normal: [0; 3],
        samples: 0,
        depth: f32::INFINITY.to_bits(),
        material: 0,
    };
    /// The unit of radiance sums, `2^-64`.
    pub const RADIANCE: f64 = 1.0 / 18_446_744_073_709_551_616.0;
    /// The unit of the sums of albedos and normals, `2^-30`.
    pub const SURFACE: f64 = 1.0 / 1_073_741_824.0;
    /// What a sample's radiance is cut to, so that no sum of `2^32` samples overflows.
    const BRIGHTEST: f32 = 1_073_741_824.0;

    /// Adds a sample. Returns `false` where its radiance was no finite number and was taken for 0.
    pub fn add(&mut self, sample: &Sample<C>) -> bool {
        let finite = sample.radiance.iter().all(|value| value.is_finite());
        if finite {
            for (sum, value) in self.radiance.iter_mut().zip(sample.radiance) {
                let value = value.clamp(-Self::BRIGHTEST, Self::BRIGHTEST);
                *sum += fixed(value);
            }
        }
        let surface = |value: f32| (f64::from(value.clamp(-1.0, 1.0)) / Self::SURFACE) as i64;
        self.albedo.iter_mut().zip(sample.albedo).for_each(|(sum, value)| *sum += surface(value));
        self.normal.iter_mut().zip(sample.normal).for_each(|(sum, value)| *sum += surface(value));
        self.samples += 1;
        self.nearest(sample.depth.max(0.0).to_bits(), sample.material);
        finite
    }

    /// Adds the sums of another part of the samples of the same pixel.
    pub fn merge(&mut self, other: &Self) {
        self.radiance.iter_mut().zip(other.radiance).for_each(|(sum, more)| *sum += more);
        self.albedo.iter_mut().zip(other.albedo).for_each(|(sum, more)| *sum += more);
        self.normal.iter_mut().zip(other.normal).for_each(|(sum, more)| *sum += more);
        self.samples += other.samples;
        self.nearest(other.depth, other.material);
    }

    /// Of equally near surfaces the smaller number wins, so that the order of adding does not matter.
    fn nearest(&mut self, depth: u32, material: u32) {
        if (depth, material) < (self.depth, self.material) || self.material == 0 && depth == self.depth {
            (self.depth, self.material) = (depth, material);
        }
    }

    /// Mean radiance, one value a channel; 0 before the first sample.
    pub fn mean_radiance(&self) -> [f32; C] {
        self.radiance.map(|sum| self.mean(sum as f64 * Self::RADIANCE))
    }

    /// Mean albedo of the first surfaces, one value a channel.
    pub fn mean_albedo(&self) -> [f32; C] {
        self.albedo.map(|sum| self.mean(sum as f64 * Self::SURFACE))
    }

    /// Mean shading normal of the first surfaces.
    pub fn mean_normal(&self) -> [f32; 3] {
        self.normal.map(|sum| self.mean(sum as f64 * Self::SURFACE))
    }

    /// Distance to the nearest surface that was seen; infinite where there is none.
    pub fn depth(&self) -> f32 {
        f32::from_bits(self.depth)
    }

    fn mean(&self, sum: f64) -> f32 {
        if self.samples == 0 { 0.0 } else { (sum / f64::from(self.samples)) as f32 }
    }
}

/// A finite number in units of `2^-64`, what is left over cut off.
fn fixed(value: f32) -> i128 {
    let bits = value.to_bits();
    let exponent = (bits >> 23 & 0xff) as i32;
    // Below the smallest normal number there is nothing to be seen.
    if exponent == 0 {
        return 0;
    }
    let mantissa = i128::from(bits & 0x7f_ffff | 0x80_0000);
    // The mantissa is in units of 2^(exponent - 150).
    let shift = exponent - 150 + 64;
    let size = if shift >= 0 { mantissa << shift } else { mantissa >> (-shift).min(127) };
    if value < 0.0 { -size } else { size }
}

/// The pixels of a window of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film<const C: usize> {
    window: Rect,
    pixels: Vec<Pixel<C>>,
}

impl<const C: usize> Film<C> {
    /// An empty film for these pixels of a picture.
    pub fn new(window: Rect) -> Self {
        Film { window, pixels: vec![Pixel::EMPTY; window.area()] }
    }

    /// Which pixels of the picture it has.
    pub fn window(&self) -> Rect {
        self.window
    }

    /// The pixels, row by row from the top.
    pub fn pixels(&self) -> &[Pixel<C>] {
        &self.pixels
    }

    /// The pixels for writing, row by row from the top.
    pub fn pixels_mut(&mut self) -> &mut [Pixel<C>] {
        &mut self.pixels
    }

    /// Adds what another film has seen, as far as their windows overlap.
    pub fn merge(&mut self, other: &Film<C>) {
        let Some(shared) = self.window.intersection(&other.window) else { return };
        for y in shared.rows() {
            for x in shared.columns() {
                let at = self.index(x, y);
                self.pixels[at].merge(&other.pixels[other.index(x, y)]);
            }
        }
    }

    /// Where a pixel of the picture is among [`pixels`](Film::pixels).
    ///
    /// # Panics
    /// Where it is left of or above the window.
    pub fn index(&self, x: u32, y: u32) -> usize {
        (y - self.window.y) as usize * self.window.width as usize + (x - self.window.x) as usize
    }

    /// The smallest and the largest number of samples of a pixel.
    pub fn samples(&self) -> (u32, u32) {
        let counts = || self.pixels.iter().map(|pixel| pixel.samples);
        (counts().min().unwrap_or(0), counts().max().unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_adding_cannot_be_told() {
        let samples: Vec<Sample<3>> = (0..200)
            .map(|i| {
                let x = (i * 7919 % 1000) as f32 / 7.0;
                let radiance = [x * 1e-9, x, x * 1e6];
                Sample { radiance, albedo: [0.3; 3], normal: [0.1, x / 1000.0, 0.9], depth: x, material: i % 3 + 1 }
            })
            .collect();
        let sum = |order: &mut dyn Iterator<Item = &Sample<3>>| {
            let mut pixel = Pixel::EMPTY;
            order.for_each(|sample| assert!(pixel.add(sample)));
            pixel
        };
        let forward = sum(&mut samples.iter());
        assert_eq!(forward, sum(&mut samples.iter().rev()));
        let mut merged = sum(&mut samples[120..].iter());
        merged.merge(&sum(&mut samples[..120].iter()));
        assert_eq!(forward, merged);
        let mean = samples.iter().map(|sample| f64::from(sample.radiance[0])).sum::<f64>() / 200.0;
        assert!((f64::from(forward.mean_radiance()[0]) - mean).abs() < 1e-7 * mean);
    }

    #[test]
    fn sums_are_of_what_a_number_is() {
        let unit = Pixel::<1>::RADIANCE;
        for value in [0.0, 1.0, -1.0, 0.1, 1e-30, 3e-20, -7.3e-19, 5.421_011e-20, 1e-44, 1234.567, 1_073_741_824.0] {
            assert_eq!(fixed(value), (f64::from(value) / unit) as i128, "{value}");
            assert_eq!(fixed(-value), (f64::from(-value) / unit) as i128, "-{value}");
        }
    }

    #[test]
    fn what_is_no_number_is_reported_and_left_out() {
        let mut pixel = Pixel::<3>::EMPTY;
        let sample = Sample { radiance: [1.0, f32::NAN, 1.0], ..Sample::EMPTY };
        assert!(!pixel.add(&sample));
        assert!(pixel.add(&Sample { radiance: [f32::MAX; 3], ..Sample::EMPTY }));
        assert_eq!(pixel.mean_radiance(), [Pixel::<3>::BRIGHTEST / 2.0; 3]);
    }
}
