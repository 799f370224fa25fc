//! Environments: radiance from all directions, as an image of longitude and latitude.

use std::f32::consts::{PI, TAU};
use std::marker::PhantomData;

use lobe_lane::{Block, Floats, Ints, Lanes};
use lobe_memory::Storage;
use lobe_scalar::Reference;

use super::cdf::Cdf;
use super::sample::LightSample;
use crate::channels::Channels;
use crate::vec3::Vec3;
use crate::vectors::sin_cos;

/// An error of an environment.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EnvironmentError {
    /// The number of texels does not match the size of the image, or is zero.
    #[error("{found} texels; expected {width} x {height}, at least one")]
    Size {
        /// Number of texels found.
        found: usize,
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A radiance is negative or not a finite number.
    #[error("radiance {value} at column {x} of row {y}; expected a finite number that is not negative")]
    Radiance {
        /// Column, from the left.
        x: usize,
        /// Row, from the top.
        y: usize,
        /// The radiance.
        value: f32,
    },
}

/// Light from infinitely far away, interpolated linearly between the centres of texels.
///
/// Rows go from +y at the top to -y; the middle of the image is -z, its left quarter -x, its right quarter +x, as seen
/// by a camera that looks along -z with +y up.
#[derive(Clone, Debug)]
pub struct Environment<S: Channels = [f32; 3]> {
    width: usize,
    height: usize,
    /// Channels of each texel, padded to whole quads.
    texels: Storage<f32>,
    /// Rotation about +y, as a fraction of a full turn.
    turn: f32,
    mean: f64,
    rows: Cdf,
    /// Weights of the texels, one list per row.
    columns: Cdf,
    /// Density of a texel over the unit square.
    density: Storage<f32>,
    spectrum: PhantomData<S>,
}

impl<S: Channels> Environment<S> {
    /// Distance from one texel to the next, in floats.
    const STRIDE: usize = S::COUNT.next_multiple_of(4);

    /// The same radiance from all directions.
    ///
    /// # Errors
    /// If the radiance is negative or not finite.
    pub fn constant(radiance: S) -> Result<Self, EnvironmentError> {
        Environment::image(1, 1, vec![radiance], 0.0)
    }

    /// A gradient of three radiances: straight up, at the horizon, and straight down, with a smooth transition.
    ///
    /// # Errors
    /// If a radiance is negative or not finite.
    pub fn gradient(zenith: S, horizon: S, ground: S) -> Result<Self, EnvironmentError> {
        const ROWS: usize = 128;
        let mut texels = Vec::with_capacity(2 * ROWS);
        for row in 0..ROWS {
            let height = libm::cosf(PI * (row as f32 + 0.5) / ROWS as f32);
            let end = if height > 0.0 { zenith } else { ground };
            let t = height.abs().sqrt();
            let mut texel = horizon;
            for (texel, end) in texel.as_mut().iter_mut().zip(end.as_ref()) {
                *texel += t * (end - *texel);
            }
            texels.extend([texel; 2]);
        }
        Environment::image(2, ROWS, texels, 0.0)
    }

    /// An image of `height` rows from the top, rotated about +y by an angle in radians.
    ///
    /// # Errors
    /// If the number of texels does not match, or one is negative or not finite.
    pub fn image(width: usize, height: usize, texels: Vec<S>, turn: f32) -> Result<Self, EnvironmentError> {
        if texels.is_empty() || width.checked_mul(height) != Some(texels.len()) {
            return Err(EnvironmentError::Size { found: texels.len(), width, height });
        }
        for (at, texel) in texels.iter().enumerate() {
            if let Some(&value) = texel.as_ref().iter().find(|value| !(value.is_finite() && **value >= 0.0)) {
                return Err(EnvironmentError::Radiance { x: at % width, y: at / width, value });
            }
        }
        let (weights, mean) = weights(width, height, &texels);
        let mut padded = Storage::zeros(texels.len() * Self::STRIDE);
        for (texel, padded) in texels.iter().zip(padded.as_mut_slice().chunks_exact_mut(Self::STRIDE)) {
            padded[..S::COUNT].copy_from_slice(texel.as_ref());
        }
        let across: Vec<f64> = weights.chunks_exact(width).map(|row| row.iter().sum()).collect();
        let total: f64 = across.iter().sum();
        let density = |weight: &f64| (weight / total * (width * height) as f64) as f32;
        Ok(Environment {
            width,
            height,
            texels: padded,
            turn: turn / TAU,
            mean,
            rows: Cdf::new(height, &across),
            columns: Cdf::new(width, &weights),
            density: Storage::copied(&weights.iter().map(density).collect::<Vec<_>>()),
            spectrum: PhantomData,
        })
    }

    /// Mean radiance over all directions and channels.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Radiance from the unit direction `wi`.
    pub fn radiance(&self, wi: [f32; 3]) -> S {
        self.radiance_and_pdf(wi).0
    }

    /// Radiance from a direction, and the density with which [`sample_li`](Environment::sample_li) samples it.
    pub(crate) fn radiance_and_pdf(&self, wi: Vec3) -> (S, f32) {
        let lanes = Reference::default();
        let (u, v) = if self.is_constant() { (0.0, 0.0) } else { self.place(wi) };
        let interpolated = self.interpolated(lanes, [lanes.splat(u), lanes.splat(v)]);
        let mut radiance = S::ZERO;
        for (radiance, value) in radiance.as_mut().iter_mut().zip(interpolated.as_ref()) {
            *radiance = lanes.extract(*value, 0);
        }
        if self.is_constant() {
            return (radiance, 0.25 / PI);
        }
        let cell = |x: f32, n: usize| ((x * n as f32) as usize).min(n - 1);
        let density = self.density.as_slice()[cell(v, self.height) * self.width + cell(u, self.width)];
        (radiance, density / (TAU * PI * sin_of(wi)))
    }

    fn is_constant(&self) -> bool {
        self.width * self.height == 1
    }

    /// Radiance at points of the unit square.
    #[inline(always)]
    fn interpolated<L: Lanes>(&self, lanes: L, [u, v]: [L::F; 2]) -> S::InLanes<L> {
        let (zero, none, one) = (lanes.splat(0.0), lanes.splat_int(0), lanes.splat_int(1));
        let half = lanes.splat(0.5);
        let x = u * lanes.splat(self.width as f32) - half;
        let y = (v * lanes.splat(self.height as f32) - half).max(zero);
        // Longitude wraps around; interpolation does not cross the poles.
        let (width, height) = (lanes.splat_int(self.width as i32), lanes.splat_int(self.height as i32));
        let before = x.lt(zero);
        let left = x.to_int();
        let fx = x - lanes.select(before, lanes.splat(-1.0), left.to_float());
        let left = lanes.select_int(before, width - one, left);
        let right = left + one;
        let right = lanes.select_int(right.lt(width), right, none);
        let top = y.to_int();
        let fy = y - top.to_float();
        let bottom = (top + one).min(height - one);
        let block = Block::new(self.texels.as_slice(), [0]);
        let mut radiance = S::ZERO.in_lanes(lanes);
        let mut from = 0;
        while from < S::COUNT {
            let mut corners = [[zero; 4]; 4];
            let places = [(top, left), (top, right), (bottom, left), (bottom, right)];
            let mut corner = 0;
            while corner < 4 {
                let (row, column) = places[corner];
                let texel = (row * width + column) * lanes.splat_int(Self::STRIDE as i32);
                [corners[corner]] = lanes.gather_quads(&block, texel + lanes.splat_int(from as i32));
                corner += 1;
            }
            let [a, b, c, d] = corners;
            let mut k = 0;
            while k < 4 && from + k < S::COUNT {
                let upper = a[k] + fx * (b[k] - a[k]);
                let lower = c[k] + fx * (d[k] - c[k]);
                radiance.as_mut()[from + k] = (upper + fy * (lower - upper)).max(zero);
                k += 1;
            }
            from += 4;
        }
        radiance
    }

    /// Samples directions roughly in proportion to radiance.
    #[inline(always)]
    pub(crate) fn sample_li<L: Lanes>(&self, lanes: L, [u, v]: [L::F; 2]) -> LightSample<L, S> {
        let (zero, one, half) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(0.5));
        let infinite = lanes.splat(f32::INFINITY);
        if self.is_constant() {
            let y = one - lanes.splat(2.0) * v;
            let radius = (one - y * y).max(zero).sqrt();
            let [sin, cos] = sin_cos(lanes, u);
            let radiance = self.interpolated(lanes, [zero; 2]);
            let (wi, pdf) = ([radius * cos, y, radius * sin], lanes.splat(0.25 / PI));
            return LightSample { wi, distance: infinite, radiance, pdf, valid: zero.lt(one) };
        }
        let (row, fy) = self.rows.sample(lanes, lanes.splat_int(0), v);
        let (column, fx) = self.columns.sample(lanes, row, u);
        let place = [
            (column.to_float() + fx) / lanes.splat(self.width as f32),
            (row.to_float() + fy) / lanes.splat(self.height as f32),
        ];
        let [sin, cos] = sin_cos(lanes, half * place[1]);
        let [sin_phi, cos_phi] = sin_cos(lanes, place[0] + lanes.splat(self.turn) - half);
        let wi = [sin * sin_phi, cos, -sin * cos_phi];
        let texel = row * lanes.splat_int(self.width as i32) + column;
        let pdf = lanes.gather(self.density.as_slice(), texel) / (lanes.splat(TAU * PI) * sin.max(lanes.splat(1e-6)));
        let valid = zero.lt(pdf) & pdf.lt(infinite);
        LightSample { wi, distance: infinite, radiance: self.interpolated(lanes, place), pdf, valid }
    }

    /// The point of the unit square that represents a direction.
    fn place(&self, [x, y, z]: Vec3) -> (f32, f32) {
        let u = libm::atan2f(x, -z) / TAU + 0.5 - self.turn;
        let u = u - u.floor();
        (if u < 1.0 { u } else { 0.0 }, libm::acosf(y.clamp(-1.0, 1.0)) / PI)
    }
}

/// Sine of the angle to the axis, limited so that it is never 0.
fn sin_of([x, _, z]: Vec3) -> f32 {
    (x * x + z * z).sqrt().max(1e-6)
}

/// The weights by which texels are sampled: the mean of a texel and its neighbours, which the interpolation reads,
/// times the solid angle. Also returns the mean radiance over the sphere.
fn weights<S: Channels>(width: usize, height: usize, texels: &[S]) -> (Vec<f64>, f64) {
    let grey: Vec<f64> = texels
        .iter()
        .map(|texel| texel.as_ref().iter().map(|x| f64::from(*x)).sum::<f64>() / S::COUNT as f64)
        .collect();
    let sine = |y: usize| libm::sin(std::f64::consts::PI * (y as f64 + 0.5) / height as f64);
    let (mut sum, mut angle) = (0.0, 0.0);
    for (y, row) in grey.chunks_exact(width).enumerate() {
        sum += sine(y) * row.iter().sum::<f64>();
        angle += sine(y) * width as f64;
    }
    let mean = sum / angle;
    // A hundredth of the mean everywhere, so that every direction can be sampled.
    let floor = if mean > 0.0 { 0.01 * mean } else { 1.0 };
    let blurred = |at: usize| {
        let (x, y) = (at % width, at / width);
        let columns = [x + width - 1, x, x + 1].map(|x| x % width);
        let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)];
        let sum: f64 = rows.iter().map(|y| columns.iter().map(|x| grey[y * width + x]).sum::<f64>()).sum();
        (sum / 9.0 + floor) * sine(y)
    };
    ((0..grey.len()).map(blurred).collect(), mean)
}

#[cfg(test)]
mod tests {
    use lobe_lane::Mask;

    use super::*;

    fn sun() -> Environment<[f32; 1]> {
        let mut texels = vec![[0.5f32]; 32 * 16];
        texels[3 * 32 + 20] = [1000.0];
        Environment::image(32, 16, texels, 0.7).unwrap()
    }

    #[test]
    fn directions_are_sampled_in_proportion_to_their_density() {
        let light = sun();
        let lanes = Reference::default();
        let n = 400;
        let (mut radiance, mut exact, mut angle) = (0.0, 0.0, 0.0);
        for i in 0..n * n {
            let u = [((i / n) as f32 + 0.5) / n as f32, ((i % n) as f32 + 0.5) / n as f32];
            let sample = light.sample_li(lanes, u.map(|u| lanes.splat(u)));
            assert!(sample.valid.all());
            let pdf = light.radiance_and_pdf(lanes.extract_xyz(sample.wi, 0)).1;
            let drawn = lanes.extract(sample.pdf, 0);
            // Rounding puts a few directions at an edge into the next texel.
            angle += f64::from(((pdf - drawn).abs() > 1e-3 * drawn) as u8) / f64::from(n * n);
            radiance += f64::from(lanes.extract(sample.radiance[0], 0) / drawn) / f64::from(n * n);
            let y = 1.0 - 2.0 * u[0];
            let (sin, cos) = (TAU * u[1]).sin_cos();
            let r = (1.0 - y * y).sqrt();
            exact +=
                f64::from(light.radiance([r * cos, y, r * sin])[0]) * 4.0 * std::f64::consts::PI / f64::from(n * n);
        }
        assert!(angle < 2e-3, "{angle} of the densities differ");
        assert!((radiance / exact - 1.0).abs() < 0.02, "{radiance} sampled, {exact} summed");
    }

    #[test]
    fn directions_appear_where_a_camera_sees_them() {
        let mut texels = vec![[0.0f32]; 8 * 4];
        texels[8 + 5] = [1.0];
        let light = Environment::image(8, 4, texels, 0.0).unwrap();
        // Column 5.5 of 8 is 3/16 of a turn to the right of -z; row 1.5 of 4 is pi/8 above the horizon.
        let (phi, theta) = (TAU * 3.0 / 16.0, PI * 3.0 / 8.0);
        let wi = [theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos()];
        assert!((light.radiance(wi)[0] - 1.0).abs() < 1e-5, "{:?}", light.radiance(wi));
    }

    #[test]
    fn bad_images_are_refused() {
        assert!(matches!(Environment::image(2, 2, vec![[0.0]; 3], 0.0), Err(EnvironmentError::Size { found: 3, .. })));
        let error = Environment::image(2, 1, vec![[0.0], [f32::NAN]], 0.0).unwrap_err();
        assert!(error.to_string().contains("column 1 of row 0"), "{error}");
    }
}
