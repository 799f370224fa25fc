//! The colours of wavelengths, of any number.

use lobe_colour::{Channels, Reduction, Space, xyz_to_rgb};

use crate::{Illuminant, SpectrumError, spectrum::ascending};

/// Linear sRGB of radiance 1 at each of these wavelengths in nm, by the CIE observer of 1931. Spectra are linear between
/// them, and constant beyond the first and the last; equal energy has luminance 1. All are 0 if none is visible.
///
/// For the [`Bands`](crate::Bands) of a picture, [`Bands::weights`](crate::Bands::weights) are nearly the same; those
/// give colours under D65 exactly.
///
/// # Errors
/// If there are none, or they do not ascend.
pub fn colours(wavelengths: &[f64]) -> Result<Vec<[f64; 3]>, SpectrumError> {
    ascending(wavelengths)?;
    let mut xyz = vec![[0.0; 3]; wavelengths.len()];
    let fine: Vec<f64> = (380..=780).map(f64::from).collect();
    if !wavelengths.iter().any(|nm| (380.0..=780.0).contains(nm)) {
        return Ok(xyz);
    }
    let (daylight, last) = (Illuminant::D65.spectrum(), wavelengths.len() - 1);
    // Under D65, a reflectance has these; without it, a radiance has the same divided by D65.
    let seen = Reduction::new(&Channels::Spectral(fine.clone()), Space::Xyz)
        .map_or_else(|_| vec![[0.0; 3]; fine.len()], |reduction| reduction.weights().to_vec());
    let mut luminance = 0.0;
    for (nm, seen) in fine.into_iter().zip(seen) {
        let seen = seen.map(|c| c / daylight.at(nm));
        luminance += seen[1];
        let upper = wavelengths.partition_point(|other| *other < nm);
        let (a, b) = (upper.saturating_sub(1), upper.min(last));
        let width = wavelengths[b] - wavelengths[a];
        let t = if width > 0.0 { ((nm - wavelengths[a]) / width).clamp(0.0, 1.0) } else { 0.0 };
        for (index, share) in [(a, 1.0 - t), (b, t)] {
            xyz[index].iter_mut().zip(seen).for_each(|(sum, c)| *sum += share * c);
        }
    }
    Ok(xyz.into_iter().map(|xyz| xyz_to_rgb(xyz.map(|c| c / luminance))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Bands;

    #[test]
    fn colours_are_those_of_bands_and_of_equal_energy() {
        let fine: Vec<f64> = (76..=156).map(|k| 5.0 * f64::from(k)).collect();
        let sum =
            colours(&fine).expect("colours").into_iter().fold([0.0; 3], |sum, c| [0, 1, 2].map(|k| sum[k] + c[k]));
        // Illuminant E in linear sRGB (x = y = 1/3).
        for (found, expected) in sum.into_iter().zip([1.2048, 0.9483, 0.9087]) {
            assert!((found - expected).abs() < 2e-3, "{sum:?}");
        }
        let bands = Bands::uniform(32).expect("bands");
        for (found, expected) in colours(bands.wavelengths()).expect("colours").iter().zip(bands.weights()) {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 4e-3), "{found:?}, not {expected:?}");
        }
        assert_eq!(colours(&[900.0, 1000.0]).expect("colours"), [[0.0; 3]; 2]);
        assert!(colours(&[]).is_err() && colours(&[500.0, 400.0]).is_err());
    }
}
