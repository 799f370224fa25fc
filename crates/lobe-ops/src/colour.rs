//! From what the channels of a file are to CIE XYZ, and to RGB.
//!
//! A BRDF turns the spectrum of the light into that of what is seen, so its colour is that under a light: the CIE standard
//! illuminant D65, under which a perfect white has the XYZ of D65 with Y = 1, and RGB 1, 1, 1. Values stay in 1/sr.

use std::sync::LazyLock;

use colorimetry::illuminant::CieIlluminant;
use colorimetry::lab::CieLab;
use colorimetry::observer::Observer;
use colorimetry::rgb::RgbSpace;
use colorimetry::traits::Light;
use colorimetry::xyz::{RelXYZ, XYZ};
use lobe_table::{Channels, GridError, specular};
use thiserror::Error;

use crate::Scattering;

/// Channels that have no colour.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("found the channels {found}; expected Y, RGB, XYZ, wavelengths or a band called Visible")]
pub struct NoColour {
    /// The names of the channels.
    pub found: String,
}

/// Which colour channels are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// CIE 1931 XYZ, 2 degrees.
    Xyz,
    /// Linear RGB with the primaries of sRGB (IEC 61966-2-1).
    Rgb,
}

/// A linear map from the channels of a file to three.
#[derive(Clone, Debug, PartialEq)]
pub struct ToColour {
    /// `[X, Y, Z]` or `[R, G, B]` of each channel.
    weights: Vec<[f64; 3]>,
}

const OBSERVER: Observer = Observer::Cie1931;

/// XYZ of D65 with Y = 1.
static WHITE: LazyLock<[f64; 3]> = LazyLock::new(|| {
    let [x, y, z] = OBSERVER.xyz_d65().to_array();
    [x / y, 1.0, z / y]
});

/// Rows X, Y, Z; columns R, G, B; white is [`WHITE`].
static RGB_TO_XYZ: LazyLock<[[f64; 3]; 3]> = LazyLock::new(|| {
    let matrix = OBSERVER.rgb2xyz_matrix(RgbSpace::SRGB);
    let luminance: f64 = (0..3).map(|column| matrix[(1, column)]).sum();
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| matrix[(row, column)] / luminance))
});

static XYZ_TO_RGB: LazyLock<[[f64; 3]; 3]> = LazyLock::new(|| inverse(&RGB_TO_XYZ));

impl ToColour {
    /// The map from these channels.
    ///
    /// - One channel without a colour, and a band called `Visible`, are grey.
    /// - RGB is taken for linear sRGB.
    /// - Wavelengths are integrated with the colour matching functions in steps of 1 nm: the spectrum is linear between
    ///   them and constant beyond the first and the last.
    ///
    /// # Errors
    /// [`NoColour`] where channels have names that say nothing about colour.
    pub fn new(channels: &Channels, target: Target) -> Result<Self, NoColour> {
        let grey = *WHITE;
        let xyz: Vec<[f64; 3]> = match channels {
            Channels::Mono => vec![grey],
            Channels::Rgb => [0, 1, 2].map(|column| RGB_TO_XYZ.map(|row| row[column])).into(),
            Channels::Xyz => vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            Channels::Spectral(wavelengths) => of_wavelengths(wavelengths),
            Channels::Named(names) => {
                let visible = names.iter().position(|name| name.eq_ignore_ascii_case("visible"));
                let visible = visible.ok_or_else(|| NoColour { found: names.join(", ") })?;
                (0..names.len()).map(|index| if index == visible { grey } else { [0.0; 3] }).collect()
            }
        };
        let weights = match target {
            Target::Xyz => xyz,
            Target::Rgb => xyz.into_iter().map(xyz_to_rgb).collect(),
        };
        Ok(ToColour { weights })
    }

    /// `[X, Y, Z]` or `[R, G, B]` that each channel contributes where its value is 1.
    pub fn weights(&self) -> &[[f64; 3]] {
        &self.weights
    }

    /// The colour of a value: one number a channel.
    pub fn apply(&self, texel: &[f32]) -> [f64; 3] {
        let mut colour = [0.0; 3];
        for (weights, &value) in self.weights.iter().zip(texel) {
            colour.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * f64::from(value));
        }
        colour
    }
}

/// The same table with XYZ or RGB channels. Colours outside the triangle of the primaries have negative RGB, which are
/// kept.
///
/// # Errors
/// Those of [`ToColour::new`].
pub fn convert(samples: &specular::Data, target: Target) -> Result<specular::Data, ColourError> {
    let map = ToColour::new(samples.channels(), target)?;
    let texels = samples.values().chunks_exact(samples.channels().count());
    let values = texels.flat_map(|texel| map.apply(texel).map(|value| value as f32)).collect();
    let channels = match target {
        Target::Xyz => Channels::Xyz,
        Target::Rgb => Channels::Rgb,
    };
    let converted = specular::Data::new(samples.scatter(), samples.knots().clone(), channels, values)?;
    Ok(match samples.refraction() {
        Some(offsets) => converted.with_refraction(offsets.to_vec())?,
        None => converted,
    })
}

/// Why a table cannot be converted.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ColourError {
    /// Its channels have no colour.
    #[error(transparent)]
    NoColour(#[from] NoColour),
    /// A value is too large for `f32`.
    #[error(transparent)]
    Samples(#[from] GridError),
}

/// A material in the colours of another target.
pub struct Coloured<'a> {
    scattering: &'a dyn Scattering,
    map: ToColour,
    channels: Channels,
}

impl<'a> Coloured<'a> {
    /// `scattering` with three channels.
    ///
    /// # Errors
    /// Those of [`ToColour::new`].
    pub fn new(scattering: &'a dyn Scattering, target: Target) -> Result<Self, NoColour> {
        let map = ToColour::new(scattering.channels(), target)?;
        let channels = if target == Target::Xyz { Channels::Xyz } else { Channels::Rgb };
        Ok(Coloured { scattering, map, channels })
    }
}

impl Scattering for Coloured<'_> {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let count = self.scattering.channels().count();
        let mut values = vec![0.0; wi.len() * count];
        self.scattering.eval_batch(wi, wo, &mut values);
        for (out, texel) in out.chunks_exact_mut(3).zip(values.chunks_exact(count)) {
            out.iter_mut().zip(self.map.apply(texel)).for_each(|(out, value)| *out = value as f32);
        }
    }
}

/// The colour difference of two XYZ, of which a perfect white has Y = 1: CIE delta E 2000 (ISO/CIE 11664-6) between their
/// CIELAB under D65.
pub fn delta_e(a: [f64; 3], b: [f64; 3]) -> f64 {
    let white = XYZ::new(WHITE.map(|c| 100.0 * c), OBSERVER);
    let lab = |xyz: [f64; 3]| CieLab::from_rxyz(RelXYZ::new(xyz.map(|c| 100.0 * c), white));
    // The observer and the white are the same, so there is no error.
    lab(a).ciede2000(&lab(b)).unwrap_or(f64::NAN)
}

/// XYZ of D65 with Y = 1: the XYZ of a perfect white.
pub fn white() -> [f64; 3] {
    *WHITE
}

/// Linear sRGB of an XYZ of which white has Y = 1.
pub fn xyz_to_rgb(xyz: [f64; 3]) -> [f64; 3] {
    XYZ_TO_RGB.map(|row| row.iter().zip(xyz).map(|(a, b)| a * b).sum())
}

/// XYZ of each wavelength's share of the spectrum.
fn of_wavelengths(wavelengths: &[f64]) -> Vec<[f64; 3]> {
    let mut order: Vec<usize> = (0..wavelengths.len()).collect();
    order.sort_by(|&a, &b| wavelengths[a].total_cmp(&wavelengths[b]));
    let light = CieIlluminant::D65.spectrum();
    let mut weights = vec![[0.0; 3]; wavelengths.len()];
    let mut luminance = 0.0;
    for (nm, power) in (380..=780_usize).zip(light.as_array()) {
        let Ok(matching) = OBSERVER.xyz_at_wavelength(nm) else { continue };
        let seen = matching.to_array().map(|c| c * power);
        luminance += seen[1];
        let x = nm as f64;
        let upper = order.partition_point(|&index| wavelengths[index] < x);
        let (a, b) = (order[upper.saturating_sub(1)], order[upper.min(order.len() - 1)]);
        let width = wavelengths[b] - wavelengths[a];
        let t = if width > 0.0 { ((x - wavelengths[a]) / width).clamp(0.0, 1.0) } else { 0.0 };
        for (index, share) in [(a, 1.0 - t), (b, t)] {
            weights[index].iter_mut().zip(seen).for_each(|(sum, c)| *sum += share * c);
        }
    }
    weights.into_iter().map(|weight| weight.map(|c| c / luminance)).collect()
}

fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |r: usize, c: usize| {
        let (r0, r1, c0, c1) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * minor(0, c)).sum();
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| minor(column, row) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: [f64; 3], expected: [f64; 3], tolerance: f64) {
        for (x, expected) in found.iter().zip(expected) {
            assert!((x - expected).abs() < tolerance, "{found:?} is not {expected}");
        }
    }

    #[test]
    fn white_stays_white() {
        let every = |step: usize| Channels::Spectral((380..=780).step_by(step).map(|nm| nm as f64).collect());
        for channels in
            [Channels::Mono, Channels::Rgb, every(1), every(10), every(100), Channels::Spectral(vec![550.0])]
        {
            let texel = vec![0.5_f32; channels.count()];
            let xyz = ToColour::new(&channels, Target::Xyz).expect("a colour").apply(&texel);
            // D65 of CIE 15: 95.047, 100, 108.883.
            assert_close(xyz, [0.475_235, 0.5, 0.544_415], 2e-4);
            let rgb = ToColour::new(&channels, Target::Rgb).expect("a colour").apply(&texel);
            assert_close(rgb, [0.5; 3], 1e-3);
        }
    }

    /// The matching functions of CIE 1931 at 555 nm are 0.5121, 1, 0.0057, under any light in these proportions.
    #[test]
    fn a_narrow_band_has_the_colour_of_its_wavelength() {
        let wavelengths: Vec<f64> = (380..=780).map(f64::from).collect();
        let mut texel = vec![0.0_f32; wavelengths.len()];
        texel[555 - 380] = 1.0;
        let [x, y, z] = ToColour::new(&Channels::Spectral(wavelengths), Target::Xyz).expect("a colour").apply(&texel);
        assert_close([x / y, 1.0, z / y], [0.5121, 1.0, 0.0057], 2e-3);
    }

    #[test]
    fn the_order_of_wavelengths_does_not_matter() {
        let up = ToColour::new(&Channels::Spectral(vec![450.0, 550.0, 650.0]), Target::Rgb).expect("a colour");
        let down = ToColour::new(&Channels::Spectral(vec![650.0, 450.0, 550.0]), Target::Rgb).expect("a colour");
        assert_close(up.apply(&[0.1, 0.2, 0.3]), down.apply(&[0.3, 0.1, 0.2]), 1e-12);
        let [r, g, b] = up.apply(&[0.0, 0.0, 1.0]);
        assert!(r > g && r > b, "{r} {g} {b} is not red");
    }

    #[test]
    fn names_have_a_colour_where_one_of_them_is_visible() {
        let named = |names: &[&str]| Channels::Named(names.iter().map(|&name| name.into()).collect());
        let map = ToColour::new(&named(&["Solar", "visible"]), Target::Rgb).expect("a colour");
        assert_close(map.apply(&[9.0, 0.25]), [0.25; 3], 1e-3);
        let error = ToColour::new(&named(&["Solar", "NIR"]), Target::Rgb).expect_err("no colour");
        assert_eq!(
            error.to_string(),
            "found the channels Solar, NIR; expected Y, RGB, XYZ, wavelengths or a band called Visible"
        );
    }

    /// Pairs 1, 7 and 25 of Sharma, Wu and Dalal, "The CIEDE2000 color-difference formula", Color Res. Appl. 30, 2005.
    #[test]
    fn colour_differences_are_those_of_the_published_pairs() {
        let xyz = |[l, a, b]: [f64; 3]| {
            let fy = (l + 16.0) / 116.0;
            let f = |t: f64| if t > 6.0 / 29.0 { t.powi(3) } else { 3.0 * (6.0_f64 / 29.0).powi(2) * (t - 4.0 / 29.0) };
            let white = white();
            [white[0] * f(fy + a / 500.0), white[1] * f(fy), white[2] * f(fy - b / 200.0)]
        };
        for (a, b, expected) in [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ] {
            assert!((delta_e(xyz(a), xyz(b)) - expected).abs() < 1e-3, "{} is not {expected}", delta_e(xyz(a), xyz(b)));
        }
    }
}
