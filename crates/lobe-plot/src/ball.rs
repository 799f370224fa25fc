//! A ball under one lamp, redrawn for every position of the lamp while it is dragged.

use std::f32::consts::PI;

use lobe::{Directions, Scatter};
use lobe_colour::ToneMap;

use crate::geometry::sign;
use crate::image::Image;
use crate::subject::Subject;
use crate::view::View;

/// The visible points of a ball, one per pixel, with their frames. The viewer is far away at +z, up is +y; the sample
/// lies on the ball with its x axis along the circles of latitude.
#[derive(Clone, Debug)]
pub struct Ball {
    size: usize,
    /// The pixel of each point.
    pixels: Vec<u32>,
    /// The axes of each point: tangent, bitangent and normal.
    frames: Vec<[[f32; 3]; 3]>,
}

/// The number of points that are evaluated at once: their directions and values stay in the cache.
const AT_ONCE: usize = 2048;

impl Ball {
    /// A ball in the middle of a square picture, `size` pixels wide. Its radius is `share` times half that width.
    pub fn new(size: usize, share: f32) -> Self {
        let (mut pixels, mut frames) = (Vec::new(), Vec::new());
        for pixel in 0..size * size {
            let [x, y] = [pixel % size, pixel / size].map(|at| (2.0 * (at as f32 + 0.5) / size as f32 - 1.0) / share);
            let (y, square) = (-y, x * x + y * y);
            if square < 1.0 {
                let z = (1.0 - square).sqrt();
                let around = x.hypot(z).max(1e-6);
                let tangent = [z / around, 0.0, -x / around];
                let bitangent = [-x * y / around, around, -y * z / around];
                pixels.push(pixel as u32);
                frames.push([tangent, bitangent, [x, y, z]]);
            }
        }
        Ball { size, pixels, frames }
    }

    /// The picture at an exposure in stops, transparent around the ball. The lamp is in the direction of the unit
    /// vector `toward`, and makes a white surface that faces it have radiance 1. The colours and the lit side are those
    /// of the view.
    pub fn picture(&self, subject: &Subject, view: &View, toward: [f32; 3], exposure: f32) -> Image {
        let material = subject.material();
        let channels = material.channel_count();
        let flip = sign(view.side) as f32;
        let scatters = subject.scatters(view.side);
        let (reflects, transmits) =
            (scatters.contains(&Scatter::Reflection), scatters.contains(&Scatter::Transmission));
        let (sin, cos) = (view.psi as f32).sin_cos();
        let tone = Toned::new(ToneMap { exposure });
        let mut rgba = vec![0; 4 * self.size * self.size];
        let mut columns: [Vec<f32>; 6] = std::array::from_fn(|_| Vec::with_capacity(AT_ONCE));
        let mut lit: Vec<(u32, f32)> = Vec::with_capacity(AT_ONCE);
        let (mut texels, mut colours) = (vec![0.0; AT_ONCE * channels], vec![[0.0; 3]; AT_ONCE]);
        let dark = tone.byte(0.0);
        for &pixel in &self.pixels {
            rgba[4 * pixel as usize..][..4].copy_from_slice(&[dark, dark, dark, 255]);
        }
        for (pixels, frames) in self.pixels.chunks(AT_ONCE).zip(self.frames.chunks(AT_ONCE)) {
            columns.iter_mut().for_each(Vec::clear);
            lit.clear();
            for (&pixel, [tangent, bitangent, normal]) in pixels.iter().zip(frames) {
                let height = dot(*normal, toward);
                let is_lit = if height > 0.0 { reflects } else { transmits && height < 0.0 };
                if !is_lit {
                    continue;
                }
                // The sample is turned by psi, with its lit side outward; the viewer is along +z.
                let local = |[u, v, w]: [f32; 3]| [cos * u + sin * v, flip * (cos * v - sin * u), flip * w];
                let wi = local([dot(*tangent, toward), dot(*bitangent, toward), height]);
                let wo = local([tangent[2], bitangent[2], normal[2]]);
                for (column, value) in columns.iter_mut().zip(wi.into_iter().chain(wo)) {
                    column.push(value);
                }
                lit.push((pixel, height.abs()));
            }
            let [a, b, c, d, e, f] = columns.each_ref().map(Vec::as_slice);
            let texels = &mut texels[..lit.len() * channels];
            let colours = &mut colours[..lit.len()];
            material.eval_batch(Directions::columns(a, b, c), Directions::columns(d, e, f), texels);
            view.colour.apply_batch(texels, colours);
            for ((pixel, cos), colour) in lit.iter().zip(colours.iter()) {
                let bytes = colour.map(|f| tone.byte(PI * cos * f));
                rgba[4 * *pixel as usize..][..3].copy_from_slice(&bytes);
            }
        }
        Image { width: self.size as u32, height: self.size as u32, rgba }
    }
}

/// A tone map as a table: if every byte took a power, the bytes of a pixel would cost more than the material.
struct Toned {
    tone: ToneMap,
    bytes: Vec<u8>,
}

/// The bits of the mantissa that the table distinguishes; an interval is at most a fifth of a step of a byte.
const MANTISSA: u32 = 9;
/// The exponents of the table: from 2^-12, below which the tone map takes no power, to 2^5.
const FIRST: u32 = (127 - 12) << MANTISSA;
const LAST: u32 = (127 + 5) << MANTISSA;

impl Toned {
    fn new(tone: ToneMap) -> Self {
        // The middle of each interval.
        let middle = |index: u32| f32::from_bits((index << (23 - MANTISSA)) | (1 << (22 - MANTISSA)));
        Toned { tone, bytes: (FIRST..LAST).map(|index| tone.byte(middle(index))).collect() }
    }

    fn byte(&self, radiance: f32) -> u8 {
        // Negative numbers and NaN are beyond the last index.
        let index = (radiance.to_bits() >> (23 - MANTISSA)).wrapping_sub(FIRST) as usize;
        self.bytes.get(index).copied().unwrap_or_else(|| self.tone.byte(radiance))
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_the_bytes_of_the_tone_map() {
        for exposure in [-3.0, 0.0, 2.5] {
            let tone = ToneMap { exposure };
            let toned = Toned::new(tone);
            for k in 0..40_000 {
                let radiance = 1e-5 * 1.0004_f32.powi(k);
                let (found, expected) = (toned.byte(radiance), tone.byte(radiance));
                assert!(found.abs_diff(expected) <= 1, "{found} is not {expected} for {radiance}");
            }
            for radiance in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-30] {
                assert_eq!(toned.byte(radiance), tone.byte(radiance), "{radiance}");
            }
        }
    }

    #[test]
    fn frames_are_right_handed_and_of_unit_length() {
        for [t, b, n] in Ball::new(9, 0.9).frames {
            let cross = [t[1] * b[2] - t[2] * b[1], t[2] * b[0] - t[0] * b[2], t[0] * b[1] - t[1] * b[0]];
            assert!((0..3).all(|k| (cross[k] - n[k]).abs() < 1e-5), "{t:?} {b:?} {n:?}");
            assert!((dot(n, n) - 1.0).abs() < 1e-5 && dot(t, b).abs() < 1e-5);
        }
    }
}
