//! Channels of a measurement to linear sRGB.

use lobe_table::Channels;

/// How the channels of a material become red, green and blue: sums with weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// Per channel of the material its part in each channel of the picture; `None` where they are the same.
    weights: Option<Vec<[f32; 3]>>,
    channels: usize,
}

/// XYZ to linear sRGB: IEC 61966-2-1.
const XYZ_TO_RGB: [[f64; 3]; 3] = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];

impl Reduction {
    /// The reduction for these channels.
    ///
    /// Spectra are weighted with the colour matching functions of CIE 1931 and scaled so that what reflects all
    /// wavelengths equally is grey. Of named bands the visible one is taken, else the first.
    pub fn new(channels: &Channels) -> Self {
        let weights = match channels {
            Channels::Rgb => None,
            Channels::Mono => Some(vec![[1.0; 3]]),
            Channels::Xyz => Some((0..3).map(|k| XYZ_TO_RGB.map(|row| row[k] as f32)).collect()),
            Channels::Spectral(wavelengths) => Some(spectral(wavelengths)),
            Channels::Named(names) => {
                let visible = names.iter().position(|name| name.to_lowercase().contains("visible")).unwrap_or(0);
                Some((0..names.len()).map(|k| if k == visible { [1.0; 3] } else { [0.0; 3] }).collect())
            }
        };
        Reduction { weights, channels: channels.count() }
    }

    /// How many channels the material has.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Whether channels are red, green and blue already.
    pub fn is_identity(&self) -> bool {
        self.weights.is_none()
    }

    /// Reduces `values`, `[query][channel]`, to a colour a query. Colours outside of what sRGB can show are not cut.
    pub fn apply(&self, values: &[f32], out: &mut [[f32; 3]]) {
        for (texel, out) in values.chunks_exact(self.channels).zip(out) {
            *out = self.one(texel);
        }
    }

    fn one(&self, texel: &[f32]) -> [f32; 3] {
        let Some(weights) = &self.weights else { return [texel[0], texel[1], texel[2]] };
        let mut sum = [0.0; 3];
        for (value, weight) in texel.iter().zip(weights) {
            sum.iter_mut().zip(weight).for_each(|(sum, weight)| *sum += value * weight);
        }
        sum
    }
}

/// What each wavelength contributes to red, green and blue: the spectrum is linear between the wavelengths and constant
/// beyond them.
fn spectral(wavelengths: &[f64]) -> Vec<[f32; 3]> {
    let mut order: Vec<usize> = (0..wavelengths.len()).collect();
    order.sort_by(|&a, &b| wavelengths[a].total_cmp(&wavelengths[b]));
    let mut rgb = vec![[0.0f64; 3]; wavelengths.len()];
    for nm in 380..=780 {
        let nm = f64::from(nm);
        let xyz = matching(nm);
        let colour = XYZ_TO_RGB.map(|row| row.iter().zip(xyz).map(|(a, b)| a * b).sum::<f64>());
        let mut give = |at: usize, share: f64| {
            rgb[order[at]].iter_mut().zip(colour).for_each(|(sum, c)| *sum += share * c);
        };
        let after = order.partition_point(|&k| wavelengths[k] <= nm);
        match (after.checked_sub(1), order.get(after)) {
            (Some(before), Some(&next)) => {
                let from = wavelengths[order[before]];
                let t = (nm - from) / (wavelengths[next] - from);
                give(before, 1.0 - t);
                give(after, t);
            }
            (Some(last), None) => give(last, 1.0),
            (None, _) => give(0, 1.0),
        }
    }
    let white: [f64; 3] = std::array::from_fn(|c| rgb.iter().map(|weight| weight[c]).sum());
    rgb.into_iter().map(|weight| std::array::from_fn(|c| (weight[c] / white[c]) as f32)).collect()
}

/// The colour matching functions of the CIE 1931 observer: the sums of Gaussians of Wyman, Sloan and Shirley 2013,
/// "Simple Analytic Approximations to the CIE XYZ Color Matching Functions" (JCGT 2, 2), equation 4.
fn matching(nm: f64) -> [f64; 3] {
    let lobe = |height: f64, peak: f64, left: f64, right: f64| {
        let t = (nm - peak) * if nm < peak { left } else { right };
        height * libm::exp(-0.5 * t * t)
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_spectra_are_grey_and_long_waves_are_red() {
        let wavelengths: Vec<f64> = (0..31).map(|k| 700.0 - 10.0 * f64::from(k)).collect();
        let reduction = Reduction::new(&Channels::Spectral(wavelengths.clone()));
        let mut out = [[0.0; 3]];
        reduction.apply(&[0.3; 31], &mut out);
        assert!(out[0].iter().all(|x| (x - 0.3).abs() < 1e-6), "{out:?}");
        let red: Vec<f32> = wavelengths.iter().map(|&nm| if nm > 600.0 { 1.0 } else { 0.0 }).collect();
        reduction.apply(&red, &mut out);
        // Beyond 605 nm lie 0.332 of X and 0.147 of Y by the table of the CIE, and nothing of Z.
        let expected = (3.2406 * 0.332 - 1.5372 * 0.147) / (3.2406 - 1.5372 - 0.4986);
        assert!((out[0][0] - expected).abs() < 0.02 && out[0][1] < 0.0 && out[0][2] < 0.0, "{out:?}, not {expected}");
    }

    #[test]
    fn one_visible_band_among_others() {
        let reduction = Reduction::new(&Channels::Named(vec!["Solar".into(), "Visible".into()]));
        let mut out = [[0.0; 3]];
        reduction.apply(&[0.1, 0.7], &mut out);
        assert_eq!(out, [[0.7; 3]]);
    }
}
