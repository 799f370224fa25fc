//! The exact sums of one pixel.

use crate::channels::Channels;
use crate::transport::{RadianceSums, Rgb, Transport};

/// The contribution of one path to its pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<T: Transport = Rgb> {
    /// Radiance that arrived along it.
    pub radiance: T::Radiance,
    /// The first surface.
    pub first_hit: FirstHit,
}

impl<T: Transport> Sample<T> {
    /// The sample of a path that hit nothing.
    pub const EMPTY: Self = Sample { radiance: T::Radiance::ZERO, first_hit: FirstHit::NONE };
}

/// Properties of the first surface of a path (arbitrary output variables), for denoisers and compositing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// Albedo in linear sRGB; 0 if there is no surface.
    pub albedo: [f32; 3],
    /// Shading normal in the world; 0 if there is no surface.
    pub normal: [f32; 3],
    /// Distance; infinite if there is no surface.
    pub depth: f32,
    /// The material, counted from 1; 0 if there is no surface.
    pub material: u32,
}

impl FirstHit {
    /// No surface.
    pub const NONE: Self = FirstHit { albedo: [0.0; 3], normal: [0.0; 3], depth: f32::INFINITY, material: 0 };
}

/// The sums of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel<T: Transport = Rgb> {
    /// Radiance in units of [`RADIANCE_UNIT`].
    pub radiance: RadianceSums<T>,
    /// Albedo in units of [`SURFACE_UNIT`].
    pub albedo: [i64; 3],
    /// Normal in units of [`SURFACE_UNIT`].
    pub normal: [i64; 3],
    /// Number of samples added.
    pub samples: u32,
    /// The bits of the smallest distance, which for positive floats have the same order as the floats.
    pub depth: u32,
    /// The material there.
    pub material: u32,
}

/// The unit of radiance sums, `2^-64`.
pub const RADIANCE_UNIT: f64 = 1.0 / 18_446_744_073_709_551_616.0;
/// The unit of the sums of albedos and normals, `2^-30`.
pub const SURFACE_UNIT: f64 = 1.0 / 1_073_741_824.0;
/// The limit to which the radiance of a sample is clamped, so that no sum of `2^32` samples overflows.
pub(super) const BRIGHTEST: f32 = 1_073_741_824.0;
/// This limit in units of [`RADIANCE_UNIT`].
pub(crate) const BRIGHTEST_UNITS: u128 = 1 << (30 + 64);
/// The largest albedo or component of a normal of a sample, in units of [`SURFACE_UNIT`].
pub(crate) const SURFACE_UNITS: u128 = 1 << 30;

impl<T: Transport> Pixel<T> {
    /// No samples yet.
    pub const EMPTY: Self = Pixel {
        radiance: T::Radiance::ZERO_SUMS,
        albedo: [0; 3],
        normal: [0; 3],
        samples: 0,
        depth: f32::INFINITY.to_bits(),
        material: 0,
    };

    /// Adds a sample. Returns `false` if its radiance was not finite and was counted as 0.
    pub fn add(&mut self, sample: &Sample<T>) -> bool {
        let finite = add_radiance::<T>(&mut self.radiance, &sample.radiance);
        let FirstHit { albedo, normal, depth, material } = sample.first_hit;
        let surface = |value: f32| (f64::from(value.clamp(-1.0, 1.0)) / SURFACE_UNIT) as i64;
        self.albedo.iter_mut().zip(albedo).for_each(|(sum, value)| *sum += surface(value));
        self.normal.iter_mut().zip(normal).for_each(|(sum, value)| *sum += surface(value));
        self.samples += 1;
        self.nearest(depth.max(0.0).to_bits(), material);
        finite
    }

    /// Adds the sums of other samples of the same pixel.
    pub fn merge(&mut self, other: &Self) {
        merge_sums::<T>(&mut self.radiance, &other.radiance);
        // Rendered sums do not overflow, but the sums of a damaged file may.
        self.albedo.iter_mut().zip(other.albedo).for_each(|(sum, more)| *sum = sum.wrapping_add(more));
        self.normal.iter_mut().zip(other.normal).for_each(|(sum, more)| *sum = sum.wrapping_add(more));
        self.samples = self.samples.saturating_add(other.samples);
        self.nearest(other.depth, other.material);
    }

    /// Keeps the nearer surface. Among equally near ones the smaller material number wins, so that the order of adding
    /// does not matter.
    fn nearest(&mut self, depth: u32, material: u32) {
        if (depth, material) < (self.depth, self.material) || self.material == 0 && depth == self.depth {
            (self.depth, self.material) = (depth, material);
        }
    }

    /// Mean radiance of the samples, without splats; 0 before the first sample.
    pub fn mean_radiance(&self) -> T::Radiance {
        mean_radiance::<T>(&self.radiance, u64::from(self.samples))
    }

    /// Mean albedo of the first surfaces in linear sRGB.
    pub fn mean_albedo(&self) -> [f32; 3] {
        self.albedo.map(|sum| mean(sum as f64 * SURFACE_UNIT, u64::from(self.samples)))
    }

    /// Mean shading normal of the first surfaces.
    pub fn mean_normal(&self) -> [f32; 3] {
        self.normal.map(|sum| mean(sum as f64 * SURFACE_UNIT, u64::from(self.samples)))
    }

    /// Distance to the nearest surface that was hit; infinite if there is none.
    pub fn depth(&self) -> f32 {
        f32::from_bits(self.depth)
    }
}

/// Adds radiance to sums, unless it is not finite; returns whether it is.
pub(super) fn add_radiance<T: Transport>(sums: &mut RadianceSums<T>, radiance: &T::Radiance) -> bool {
    let finite = radiance.as_ref().iter().all(|value| value.is_finite());
    if finite {
        for (sum, value) in sums.as_mut().iter_mut().zip(radiance.as_ref()) {
            *sum += fixed(value.clamp(-BRIGHTEST, BRIGHTEST));
        }
    }
    finite
}

pub(super) fn merge_sums<T: Transport>(sums: &mut RadianceSums<T>, other: &RadianceSums<T>) {
    sums.as_mut().iter_mut().zip(other.as_ref()).for_each(|(sum, more)| *sum = sum.wrapping_add(*more));
}

pub(super) fn mean_radiance<T: Transport>(sums: &RadianceSums<T>, count: u64) -> T::Radiance {
    let mut radiance = T::Radiance::ZERO;
    for (mean_of, sum) in radiance.as_mut().iter_mut().zip(sums.as_ref()) {
        *mean_of = mean(*sum as f64 * RADIANCE_UNIT, count);
    }
    radiance
}

fn mean(sum: f64, count: u64) -> f32 {
    if count == 0 { 0.0 } else { (sum / count as f64) as f32 }
}

/// A finite number in units of `2^-64`, rounded toward 0.
fn fixed(value: f32) -> i128 {
    let bits = value.to_bits();
    let exponent = (bits >> 23 & 0xff) as i32;
    // Numbers below the smallest normal number are not visible.
    if exponent == 0 {
        return 0;
    }
    let mantissa = i128::from(bits & 0x7f_ffff | 0x80_0000);
    // The mantissa is in units of 2^(exponent - 150).
    let shift = exponent - 150 + 64;
    let size = if shift >= 0 { mantissa << shift } else { mantissa >> (-shift).min(127) };
    if value < 0.0 { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_adding_does_not_matter() {
        let samples: Vec<Sample> = (0..200)
            .map(|i| {
                let x = (i * 7919 % 1000) as f32 / 7.0;
                let radiance = [x * 1e-9, x, x * 1e6];
                let normal = [0.1, x / 1000.0, 0.9];
                let first_hit = FirstHit { albedo: [0.3; 3], normal, depth: x, material: i % 3 + 1 };
                Sample { radiance, first_hit }
            })
            .collect();
        let sum = |order: &mut dyn Iterator<Item = &Sample>| {
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
    fn sums_hold_the_exact_numbers() {
        let unit = RADIANCE_UNIT;
        for value in [0.0, 1.0, -1.0, 0.1, 1e-30, 3e-20, -7.3e-19, 5.421_011e-20, 1e-44, 1234.567, 1_073_741_824.0] {
            assert_eq!(fixed(value), (f64::from(value) / unit) as i128, "{value}");
            assert_eq!(fixed(-value), (f64::from(-value) / unit) as i128, "-{value}");
        }
    }

    #[test]
    fn a_radiance_that_is_not_a_number_is_reported_and_left_out() {
        let mut pixel = Pixel::<Rgb>::EMPTY;
        let sample = Sample { radiance: [1.0, f32::NAN, 1.0], ..Sample::EMPTY };
        assert!(!pixel.add(&sample));
        assert!(pixel.add(&Sample { radiance: [f32::MAX; 3], ..Sample::EMPTY }));
        assert_eq!(pixel.mean_radiance(), [BRIGHTEST / 2.0; 3]);
    }
}
