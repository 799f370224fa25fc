//! From channels to three numbers.

use thiserror::Error;

use crate::cie::{D65, FIRST, LAST, X_BAR, Y_BAR, Z_BAR};
use crate::{Channels, NamedBands, RGB_TO_XYZ, WHITE, xyz_to_rgb};

/// Channels that have no colour.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("found the channels {found}; expected Y, RGB, XYZ, wavelengths or a band called Visible")]
pub struct NoColour {
    /// The names of the channels.
    pub found: String,
}

/// The three numbers to compute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// CIE 1931 XYZ, 2 degrees.
    Xyz,
    /// Linear RGB with the primaries of sRGB (IEC 61966-2-1).
    Rgb,
}

/// A linear map from the channels of a material to three.
///
/// - One channel without a colour, and the visible band of named ones ([`NamedBands`]), are grey.
/// - RGB is assumed to be linear sRGB.
/// - Wavelengths are integrated with the colour matching functions under D65 in steps of 1 nm: the spectrum is linear
///   between them and constant beyond the first and the last. So a single wavelength is grey, and so are invisible
///   wavelengths.
///
/// Colours outside the triangle of the primaries have negative RGB, which is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// `[X, Y, Z]` or `[R, G, B]` of each channel.
    weights: Vec<[f64; 3]>,
    /// The same, rounded.
    narrow: Vec<[f32; 3]>,
    is_identity: bool,
}

impl Reduction {
    /// The map from these channels.
    ///
    /// # Errors
    /// [`NoColour`] if the names of the channels say nothing about colour.
    pub fn new(channels: &Channels, space: Space) -> Result<Self, NoColour> {
        let map = |xyz: Vec<[f64; 3]>| match space {
            Space::Xyz => xyz,
            Space::Rgb => xyz.into_iter().map(xyz_to_rgb).collect(),
        };
        let weights = match channels {
            Channels::Mono => vec![grey(space)],
            Channels::Rgb if space == Space::Xyz => [0, 1, 2].map(|column| RGB_TO_XYZ.map(|row| row[column])).into(),
            Channels::Rgb => UNIT.into(),
            Channels::Xyz => map(UNIT.into()),
            Channels::Spectral(wavelengths) => {
                let xyz = of_wavelengths(wavelengths);
                match only(&xyz) {
                    Some(index) => alone(xyz.len(), index, grey(space)),
                    None => map(xyz),
                }
            }
            Channels::Named(names) => {
                let bands = NamedBands::new(names);
                let visible = bands.visible.ok_or_else(|| NoColour { found: names.join(", ") })?;
                match bands.x_and_z {
                    Some([x, z]) => {
                        let mut xyz = vec![[0.0; 3]; names.len()];
                        for (index, axis) in [(x, 0), (visible, 1), (z, 2)] {
                            xyz[index][axis] = WHITE[axis];
                        }
                        map(xyz)
                    }
                    None => alone(names.len(), visible, grey(space)),
                }
            }
        };
        Ok(Reduction::from_weights(weights))
    }

    /// Linear sRGB for a picture, which always shows something: named bands without a colour show the first as grey.
    pub fn for_display(channels: &Channels) -> Self {
        Reduction::new(channels, Space::Rgb).unwrap_or_else(|NoColour { .. }| Reduction::grey(channels.count(), 0))
    }

    /// Linear sRGB that shows one of `count` channels as grey.
    ///
    /// # Panics
    /// If there is no channel `index`.
    pub fn grey(count: usize, index: usize) -> Self {
        Reduction::from_weights(alone(count, index, grey(Space::Rgb)))
    }

    fn from_weights(weights: Vec<[f64; 3]>) -> Self {
        let narrow = weights.iter().map(|weights| weights.map(|weight| weight as f32)).collect();
        Reduction { is_identity: weights == UNIT, weights, narrow }
    }

    /// The number of channels of the material.
    pub fn channels(&self) -> usize {
        self.weights.len()
    }

    /// `true` if the channels are already the wanted ones.
    pub fn is_identity(&self) -> bool {
        self.is_identity
    }

    /// `true` if the three numbers are always equal.
    pub fn is_grey(&self) -> bool {
        self.weights.iter().all(|[r, g, b]| r == g && g == b)
    }

    /// `[X, Y, Z]` or `[R, G, B]` of each channel at the value 1.
    pub fn weights(&self) -> &[[f64; 3]] {
        &self.weights
    }

    /// The colour of a value, one number per channel, summed in `f64`.
    pub fn exact<T: Copy + Into<f64>>(&self, texel: &[T]) -> [f64; 3] {
        let mut colour = [0.0; 3];
        for (weights, &value) in self.weights.iter().zip(texel) {
            colour.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * value.into());
        }
        colour
    }

    /// The colour of a value, one number per channel, summed in `f32`.
    ///
    /// # Panics
    /// If there are fewer numbers than channels.
    pub fn apply(&self, texel: &[f32]) -> [f32; 3] {
        if self.is_identity {
            return [texel[0], texel[1], texel[2]];
        }
        let mut sum = [0.0; 3];
        for (value, weight) in texel.iter().zip(&self.narrow) {
            sum.iter_mut().zip(weight).for_each(|(sum, weight)| *sum += value * weight);
        }
        sum
    }

    /// [`apply`](Self::apply) to many values, `[query][channel]`.
    pub fn apply_batch(&self, values: &[f32], out: &mut [[f32; 3]]) {
        for (texel, out) in values.chunks_exact(self.channels()).zip(out) {
            *out = self.apply(texel);
        }
    }
}

const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn grey(space: Space) -> [f64; 3] {
    match space {
        Space::Xyz => WHITE,
        Space::Rgb => [1.0; 3],
    }
}

fn alone(count: usize, index: usize, weights: [f64; 3]) -> Vec<[f64; 3]> {
    let mut all = vec![[0.0; 3]; count];
    all[index] = weights;
    all
}

/// The channel with all the weight, if there is one.
fn only(weights: &[[f64; 3]]) -> Option<usize> {
    let counts = |weights: &[f64; 3]| weights.iter().any(|weight| *weight != 0.0);
    let mut indices = (0..weights.len()).filter(|&index| counts(&weights[index]));
    let first = indices.next()?;
    indices.next().is_none().then_some(first)
}

/// XYZ of each wavelength's share of the spectrum.
pub(crate) fn of_wavelengths(wavelengths: &[f64]) -> Vec<[f64; 3]> {
    let mut weights = vec![[0.0; 3]; wavelengths.len()];
    let mut order: Vec<usize> = (0..wavelengths.len()).collect();
    order.sort_by(|&a, &b| wavelengths[a].total_cmp(&wavelengths[b]));
    let Some(last) = order.len().checked_sub(1) else { return weights };
    let mut luminance = 0.0;
    for (step, power) in D65.iter().enumerate() {
        let seen = [X_BAR[step], Y_BAR[step], Z_BAR[step]].map(|c| c * power);
        luminance += seen[1];
        let x = FIRST + step as f64;
        let upper = order.partition_point(|&index| wavelengths[index] < x);
        let (a, b) = (order[upper.saturating_sub(1)], order[upper.min(last)]);
        let width = wavelengths[b] - wavelengths[a];
        let t = if width > 0.0 { ((x - wavelengths[a]) / width).clamp(0.0, 1.0) } else { 0.0 };
        for (index, share) in [(a, 1.0 - t), (b, t)] {
            weights[index].iter_mut().zip(seen).for_each(|(sum, c)| *sum += share * c);
        }
    }
    weights.into_iter().map(|weight| weight.map(|c| c / luminance)).collect()
}

/// `true` if any of these wavelengths is visible.
pub(crate) fn any_visible(wavelengths: &[f64]) -> bool {
    wavelengths.iter().any(|nm| (FIRST..=LAST).contains(nm))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: [f64; 3], expected: [f64; 3], tolerance: f64) {
        for (x, expected) in found.iter().zip(expected) {
            assert!((x - expected).abs() < tolerance, "{found:?} is not {expected}");
        }
    }

    fn rgb(channels: &Channels, texel: &[f32]) -> [f64; 3] {
        Reduction::new(channels, Space::Rgb).expect("a colour").exact(texel)
    }

    fn named(names: &[&str]) -> Channels {
        Channels::Named(names.iter().map(|&name| name.into()).collect())
    }

    #[test]
    fn white_stays_white() {
        let every = |step: usize| Channels::Spectral((380..=780).step_by(step).map(|nm| nm as f64).collect());
        for channels in
            [Channels::Mono, Channels::Rgb, every(1), every(10), every(100), Channels::Spectral(vec![550.0])]
        {
            let texel = vec![0.5_f32; channels.count()];
            let xyz = Reduction::new(&channels, Space::Xyz).expect("a colour").exact(&texel);
            // D65 of CIE 15: 95.047, 100, 108.883.
            assert_close(xyz, [0.475_235, 0.5, 0.544_415], 2e-4);
            assert_close(rgb(&channels, &texel), [0.5; 3], 1e-9);
        }
    }

    /// The matching functions of CIE 1931 at 555 nm are 0.5121, 1, 0.0057, under any light in these proportions.
    #[test]
    fn a_narrow_band_has_the_colour_of_its_wavelength() {
        let wavelengths: Vec<f64> = (380..=780).map(f64::from).collect();
        let mut texel = vec![0.0_f32; wavelengths.len()];
        texel[555 - 380] = 1.0;
        let [x, y, z] = Reduction::new(&Channels::Spectral(wavelengths), Space::Xyz).expect("a colour").exact(&texel);
        assert_close([x / y, 1.0, z / y], [0.5121, 1.0, 0.0057], 2e-3);
    }

    #[test]
    fn the_order_of_wavelengths_does_not_matter() {
        let up = rgb(&Channels::Spectral(vec![450.0, 550.0, 650.0]), &[0.1, 0.2, 0.3]);
        let down = rgb(&Channels::Spectral(vec![650.0, 450.0, 550.0]), &[0.3, 0.1, 0.2]);
        assert_close(up, down, 1e-12);
        let [r, g, b] = rgb(&Channels::Spectral(vec![450.0, 550.0, 650.0]), &[0.0, 0.0, 1.0]);
        assert!(r > g && r > b, "{r} {g} {b} is not red");
    }

    #[test]
    fn a_spectrum_of_long_waves_is_red() {
        let wavelengths: Vec<f64> = (0..31).map(|k| 700.0 - 10.0 * f64::from(k)).collect();
        let red: Vec<f32> = wavelengths.iter().map(|&nm| if nm > 600.0 { 1.0 } else { 0.0 }).collect();
        let reduction = Reduction::for_display(&Channels::Spectral(wavelengths));
        let mut out = [[0.0; 3]];
        reduction.apply_batch(&red, &mut out);
        assert!(out[0][0] > 0.5 && out[0][1] < 0.05 && out[0][2] < 0.05, "{out:?}");
    }

    #[test]
    fn one_wavelength_and_invisible_ones_are_exactly_grey() {
        for (wavelengths, texel, expected) in [
            (vec![633.0], vec![0.7], 0.7),
            (vec![1550.0, 3390.0], vec![0.25, 9.0], 0.25),
            (vec![200.0, 300.0], vec![9.0, 0.5], 0.5),
        ] {
            let reduction = Reduction::for_display(&Channels::Spectral(wavelengths));
            assert!(reduction.is_grey());
            assert_eq!(reduction.apply(&texel), [expected; 3]);
        }
        assert!(!Reduction::for_display(&Channels::Spectral(vec![450.0, 650.0])).is_grey());
    }

    #[test]
    fn names_have_a_colour_if_one_of_them_is_visible() {
        assert_eq!(rgb(&named(&["Solar", "visible"]), &[9.0, 0.25]), [0.25; 3]);
        let solar = named(&["Solar", "NIR"]);
        assert_eq!(
            Reduction::new(&solar, Space::Rgb).expect_err("no colour").to_string(),
            "found the channels Solar, NIR; expected Y, RGB, XYZ, wavelengths or a band called Visible"
        );
        assert_eq!(Reduction::for_display(&solar).apply(&[0.5, 9.0]), [0.5; 3]);
    }

    #[test]
    fn bands_of_x_y_and_z_are_relative_to_equal_energy() {
        let channels = named(&["Visible", "CIE-Z", "CIE-X", "Solar"]);
        assert_close(rgb(&channels, &[0.5, 0.5, 0.5, 9.0]), [0.5; 3], 1e-9);
        let [r, g, b] = rgb(&channels, &[0.3, 0.1, 0.5, 9.0]);
        assert!(r > 2.0 * g && r > 2.0 * b, "{r} {g} {b} is not red");
    }

    #[test]
    fn rgb_is_left_unchanged() {
        let reduction = Reduction::for_display(&Channels::Rgb);
        assert!(reduction.is_identity() && reduction.channels() == 3);
        assert_eq!(reduction.apply(&[0.1, -0.2, f32::MAX]), [0.1, -0.2, f32::MAX]);
        assert!(!Reduction::for_display(&Channels::Xyz).is_identity());
    }
}
