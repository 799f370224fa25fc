//! The wavelengths of a picture.

use lobe_colour::{Channels, Reduction, Space};

use crate::spectrum::ascending;
use crate::upsample;
use crate::{Illuminant, Spectrum, SpectrumError};

/// Wavelengths at which light is followed, and their colours.
///
/// A band has the radiance at its wavelength; spectra are linear between bands, and constant beyond the first and the
/// last. Radiance 1 in all bands (illuminant E) has a luminance of about 1. Reflectances under [D65](Illuminant::D65)
/// have exactly the colour that [`Reduction`] gives them.
#[derive(Clone, Debug, PartialEq)]
pub struct Bands {
    wavelengths: Vec<f64>,
    /// Linear sRGB of radiance 1 in each band.
    weights: Vec<[f64; 3]>,
    /// Linear sRGB of reflectance 1 in each band, under D65.
    pub(crate) reduction: Vec<[f64; 3]>,
    /// D65 in bands, with luminance 1.
    d65: Vec<f64>,
    /// The reflectances of colours whose largest component is 1/2, indexed by which component that is and by the other
    /// two.
    palette: Vec<Vec<f32>>,
}

/// The most bands of a picture.
const MOST: usize = 32;
/// Nodes of each side of the palette.
const SIDE: usize = 17;
/// The largest component of every colour in the palette.
const BRIGHT: f64 = 0.5;

impl Bands {
    /// Bands at these wavelengths in nm.
    ///
    /// # Errors
    /// [`SpectrumError`] if there are none or more than 32, if they do not ascend, or if none of them is visible.
    pub fn new(wavelengths: Vec<f64>) -> Result<Self, SpectrumError> {
        ascending(&wavelengths)?;
        if wavelengths.len() > MOST {
            return Err(SpectrumError::Count { found: wavelengths.len(), expected: "at most 32" });
        }
        if !wavelengths.iter().any(|nm| (380.0..=780.0).contains(nm)) {
            let (first, last) = (wavelengths[0], wavelengths[wavelengths.len() - 1]);
            return Err(SpectrumError::Invisible { first, last });
        }
        let reduction = Reduction::for_display(&Channels::Spectral(wavelengths.clone())).weights().to_vec();
        let mut bands = Bands { wavelengths, weights: Vec::new(), reduction, d65: Vec::new(), palette: Vec::new() };
        let d65 = bands.mean(&Illuminant::D65.spectrum());
        // Equal energy has luminance 1.
        let luminance = |of: &dyn Fn(f64) -> f64| -> f64 {
            let fine: Vec<f64> = (380..=780).map(f64::from).collect();
            let y = Reduction::new(&Channels::Spectral(fine.clone()), Space::Xyz)
                .map_or(Vec::new(), |r| r.weights().to_vec());
            fine.iter().zip(y).map(|(nm, xyz)| of(*nm) * xyz[1]).sum()
        };
        let daylight = Illuminant::D65.spectrum();
        let scale = luminance(&|nm| 1.0 / daylight.at(nm));
        bands.d65 = d65.iter().map(|x| x * scale).collect();
        bands.weights = bands
            .reduction
            .iter()
            .zip(&bands.d65)
            .map(|(weights, d65)| weights.map(|weight| if *d65 > 0.0 { weight / d65 } else { 0.0 }))
            .collect();
        bands.palette = bands.palette();
        Ok(bands)
    }

    /// This many bands from 400 to 700 nm, equally spaced.
    ///
    /// # Errors
    /// If there are fewer than 2 or more than 32.
    pub fn uniform(count: usize) -> Result<Self, SpectrumError> {
        if !(2..=MOST).contains(&count) {
            return Err(SpectrumError::Count { found: count, expected: "from 2 to 32" });
        }
        Bands::new((0..count).map(|k| 400.0 + 300.0 * k as f64 / (count - 1) as f64).collect())
    }

    /// The wavelengths in nm.
    pub fn wavelengths(&self) -> &[f64] {
        &self.wavelengths
    }

    /// The number of bands.
    pub fn count(&self) -> usize {
        self.wavelengths.len()
    }

    /// Linear sRGB of radiance 1 in each band.
    pub fn weights(&self) -> &[[f64; 3]] {
        &self.weights
    }

    /// The colour of a radiance, in linear sRGB.
    pub fn colour(&self, radiance: &[f32]) -> [f32; 3] {
        let mut sum = [0.0f64; 3];
        for (weights, &value) in self.weights.iter().zip(radiance) {
            sum.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * f64::from(value));
        }
        sum.map(|c| c as f32)
    }

    /// A spectrum sampled at the wavelengths: for reflectances and refractive indices.
    pub fn at(&self, spectrum: &Spectrum) -> Vec<f64> {
        self.wavelengths.iter().map(|nm| spectrum.at(*nm)).collect()
    }

    /// The mean of a spectrum around each wavelength, with weights that fall to 0 at its neighbours: for light, which
    /// may have narrow lines.
    pub fn mean(&self, spectrum: &Spectrum) -> Vec<f64> {
        let mean = |k: usize| {
            let at = self.wavelengths[k];
            let from = if k == 0 { at } else { self.wavelengths[k - 1] };
            let to = self.wavelengths.get(k + 1).copied().unwrap_or(at);
            // Half a step off the ends, whose weights are 0.
            let steps = ((to - from) / 0.25).ceil().clamp(1.0, 1e5) as usize;
            let (mut sum, mut total) = (0.0, 0.0);
            for step in 0..steps {
                let nm = from + (to - from) * (step as f64 + 0.5) / steps as f64;
                let share = if nm < at {
                    (nm - from) / (at - from)
                } else if to > at {
                    (to - nm) / (to - at)
                } else {
                    1.0
                };
                sum += share * spectrum.at(nm);
                total += share;
            }
            if total > 0.0 { sum / total } else { spectrum.at(at) }
        };
        (0..self.wavelengths.len()).map(mean).collect()
    }

    /// A spectrum of light, in the units of the spectrum.
    pub fn light(&self, spectrum: &Spectrum) -> Vec<f32> {
        self.mean(spectrum).into_iter().map(|x| x as f32).collect()
    }

    /// A spectrum of light, scaled to this luminance.
    pub fn light_of(&self, spectrum: &Spectrum, luminance: f64) -> Vec<f32> {
        let mean = self.mean(spectrum);
        let y: f64 = mean.iter().zip(&self.weights).map(|(x, weights)| x * luminance_of(*weights)).sum();
        mean.into_iter().map(|x| if y > 0.0 { (x * luminance / y) as f32 } else { 0.0 }).collect()
    }

    /// A smooth reflectance that has this colour under D65, each component from 0 to 1: the spectrum of Jakob and
    /// Hanika.
    pub fn reflectance(&self, rgb: [f32; 3]) -> Vec<f32> {
        self.fit(rgb.map(f64::from)).into_iter().map(|x| x as f32).collect()
    }

    pub(crate) fn fit(&self, rgb: [f64; 3]) -> Vec<f64> {
        let place = |nm: f64| (nm - 550.0) / 200.0;
        let inside = self.wavelengths.iter().filter(|nm| (430.0..=670.0).contains(*nm)).count();
        if inside >= 6 {
            let places: Vec<f64> = self.wavelengths.iter().map(|nm| place(*nm)).collect();
            return upsample::reflectance(&places, &self.reduction, rgb);
        }
        // A few bands cannot distinguish colours, so the spectrum is found for all wavelengths.
        let fine: Vec<f64> = (0..=80).map(|k| 380.0 + 5.0 * f64::from(k)).collect();
        let weights = Reduction::for_display(&Channels::Spectral(fine.clone())).weights().to_vec();
        let places: Vec<f64> = fine.iter().map(|nm| place(*nm)).collect();
        let values = upsample::reflectance(&places, &weights, rgb);
        Spectrum::new(fine, values).map_or_else(|_| vec![0.0; self.count()], |spectrum| self.at(&spectrum))
    }

    /// The reflectances of the palette.
    fn palette(&self) -> Vec<Vec<f32>> {
        let mut palette = Vec::with_capacity(3 * SIDE * SIDE);
        for largest in 0..3 {
            for i in 0..SIDE {
                for j in 0..SIDE {
                    let [a, b] = [i, j].map(|k| BRIGHT * k as f64 / (SIDE - 1) as f64);
                    let mut rgb = [BRIGHT; 3];
                    (rgb[(largest + 1) % 3], rgb[(largest + 2) % 3]) = (a, b);
                    palette.push(self.fit(rgb).into_iter().map(|x| x as f32).collect());
                }
            }
        }
        palette
    }

    /// The light of D65 through a smooth filter, with this colour, whose components may be of any size but not
    /// negative. Spectra are blended between the nodes of a palette, which preserves the colour.
    pub fn emission(&self, rgb: [f32; 3]) -> Vec<f32> {
        let mut out = vec![0.0; self.count()];
        self.emission_into(rgb, &mut out);
        out
    }

    /// Like [`emission`](Self::emission), into the first numbers of `out`; the others are unchanged.
    pub fn emission_into(&self, rgb: [f32; 3], out: &mut [f32]) {
        let rgb = rgb.map(|c| if c > 0.0 { c } else { 0.0 });
        let largest = (0..3).fold(0, |most, k| if rgb[k] > rgb[most] { k } else { most });
        let scale = rgb[largest];
        if scale.is_nan() || scale <= 0.0 {
            return out.iter_mut().take(self.count()).for_each(|x| *x = 0.0);
        }
        let place = |k: usize| {
            let x = (rgb[(largest + k) % 3] / scale).min(1.0) * (SIDE - 1) as f32;
            let cell = (x as usize).min(SIDE - 2);
            (cell, x - cell as f32)
        };
        let ((i, u), (j, v)) = (place(1), place(2));
        let node = |i: usize, j: usize| &self.palette[(largest * SIDE + i) * SIDE + j];
        let (a, b, c, d) = (node(i, j), node(i, j + 1), node(i + 1, j), node(i + 1, j + 1));
        let factor = scale / BRIGHT as f32;
        for (band, (x, d65)) in out.iter_mut().zip(&self.d65).enumerate() {
            let low = a[band] + v * (b[band] - a[band]);
            let high = c[band] + v * (d[band] - c[band]);
            *x = factor * *d65 as f32 * (low + u * (high - low));
        }
    }
}

/// The luminance of linear sRGB.
fn luminance_of(rgb: [f64; 3]) -> f64 {
    lobe_colour::rgb_to_xyz(rgb)[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f32; 3], b: [f32; 3], within: f32) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() <= within)
    }

    #[test]
    fn colours_are_reproduced() {
        for bands in [Bands::uniform(16).unwrap(), Bands::uniform(8).unwrap(), Bands::uniform(31).unwrap()] {
            let (mut worst, mut lit, mut inside) = (0.0f32, 0.0f32, 0.0f32);
            for i in 0..11 * 11 * 11 {
                let rgb = [i % 11, i / 11 % 11, i / 121].map(|k| 0.05 + 0.09 * k as f32);
                let values = bands.reflectance(rgb);
                assert!(values.iter().all(|x| (0.0..=1.0).contains(x)), "{values:?}");
                let white = bands.emission([1.0; 3]);
                let seen: Vec<f32> = values.iter().zip(&white).map(|(a, b)| a * b).collect();
                let found = bands.colour(&seen);
                let off = (0..3).fold(0.0f32, |off, k| off.max((found[k] - rgb[k]).abs()));
                worst = worst.max(off);
                if rgb.iter().all(|c| (0.1..=0.9).contains(c)) {
                    inside = inside.max(off);
                }
                let light = bands.colour(&bands.emission(rgb.map(|c| 20.0 * c)));
                lit = (0..3).fold(lit, |worst, k| worst.max((light[k] / 20.0 - rgb[k]).abs()));
            }
            // At eight wavelengths, no reflectance has the most saturated green and magenta: at least 0.00237 are missing,
            // by linear programming.
            assert!(inside < 2e-3 && worst < 3e-3, "{} bands: {inside}, {worst}", bands.count());
            println!("{} bands: reflectances {worst}, light {lit}", bands.count());
            if bands.count() >= 16 {
                assert!(worst < 2e-3 && lit < 2e-3, "{} bands: {worst} {lit}", bands.count());
            }
        }
    }

    #[test]
    fn white_is_white_and_daylight_too() {
        for count in [4, 8, 16, 31] {
            let bands = Bands::uniform(count).unwrap();
            assert!(near(bands.colour(&bands.emission([1.0; 3])), [1.0; 3], 1e-5), "{count}");
            let d65 = bands.light_of(&Illuminant::D65.spectrum(), 1.0);
            assert!(near(bands.colour(&d65), [1.0; 3], 1e-5), "{count}");
            assert!(bands.reflectance([1.0; 3]).iter().all(|x| *x == 1.0));
            assert!(bands.reflectance([0.0; 3]).iter().all(|x| *x == 0.0));
        }
    }

    #[test]
    fn illuminants_have_their_colours() {
        // Chromaticities of CIE 15, table T.3, 2 degrees; F2 and F11 have lines, which 31 bands widen.
        let bands = Bands::uniform(31).unwrap();
        for (name, x, y, within) in [
            (Illuminant::A, 0.447_57, 0.407_45, 2e-3),
            (Illuminant::D50, 0.345_67, 0.358_50, 1e-3),
            (Illuminant::D65, 0.312_71, 0.329_02, 1e-3),
            (Illuminant::E, 0.333_33, 0.333_33, 2e-3),
            (Illuminant::F2, 0.372_08, 0.375_29, 5e-3),
            (Illuminant::F11, 0.380_52, 0.377_13, 1e-2),
        ] {
            let colour = bands.colour(&bands.light(&name.spectrum())).map(f64::from);
            let [a, b, c] = lobe_colour::rgb_to_xyz(colour);
            let found = [a / (a + b + c), b / (a + b + c)];
            let far = (found[0] - x).abs().max((found[1] - y).abs());
            assert!(far < within, "{name:?}: {found:?}, not {x} {y}");
            assert_eq!(Illuminant::named(name.name()), Some(name));
        }
        assert!((bands.colour(&bands.light(&Illuminant::E.spectrum()))[1] - 1.0).abs() < 0.1);
    }

    #[test]
    fn channels_become_bands() {
        let bands = Bands::new(vec![450.0, 500.0, 550.0, 600.0, 650.0]).unwrap();
        assert_eq!(bands.resampling(&Channels::Spectral(vec![450.0, 500.0, 550.0, 600.0, 650.0])), None);
        let resampling = bands.resampling(&Channels::Spectral(vec![600.0, 400.0, 500.0])).expect("other wavelengths");
        let mut out = [0.0; 5];
        resampling.apply(&[3.0, 1.0, 2.0], &mut out);
        assert_eq!(out, [1.5, 2.0, 2.5, 3.0, 3.0]);
        let bands = Bands::uniform(16).unwrap();
        let rgb = bands.resampling(&Channels::Rgb).expect("colours");
        let mut out = [0.0; 16];
        rgb.apply(&[0.7; 3], &mut out);
        assert!(out.iter().all(|x| (x - 0.7).abs() < 1e-5), "{out:?}");
        let white = bands.emission([1.0; 3]);
        for colour in [[0.7, 0.2, 0.1], [0.0, 0.5, 0.05], [0.1, 0.1, 0.9]] {
            rgb.apply(&colour, &mut out);
            let seen: Vec<f32> = out.iter().zip(&white).map(|(share, light)| share * light).collect();
            assert!(near(bands.colour(&seen), colour, 1e-4), "{colour:?}: {:?}", bands.colour(&seen));
            assert!(out.iter().all(|share| *share > -0.05 && *share < 1.1), "{out:?}");
        }
        let mono = bands.resampling(&Channels::Mono).expect("grey");
        mono.apply(&[0.25], &mut out);
        assert!(out.iter().all(|x| (x - 0.25).abs() < 1e-5), "{out:?}");
    }

    #[test]
    fn invalid_bands_are_refused() {
        for (nm, expected) in [
            (vec![], "0 wavelengths"),
            (vec![500.0, 450.0], "wavelength 1"),
            (vec![1000.0, 1100.0], "some from 380"),
            ((0..33).map(|k| 400.0 + f64::from(k)).collect(), "33 wavelengths"),
        ] {
            let error = Bands::new(nm).expect_err(expected).to_string();
            assert!(error.contains(expected), "{error}");
        }
        assert!(Bands::uniform(1).is_err() && Bands::uniform(33).is_err());
    }
}
