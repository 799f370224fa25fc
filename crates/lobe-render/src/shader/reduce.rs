//! Channels of a measurement to linear sRGB.

use lobe::Channels;
use lobe_ops::colour::{Target, ToColour};

/// How the channels of a material become red, green and blue: sums with weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// Per channel of the material its part in each channel of the picture; `None` where they are the same.
    weights: Option<Vec<[f32; 3]>>,
    channels: usize,
}

impl Reduction {
    /// The reduction for these channels: that of [`ToColour`]. Of named bands the visible one is taken, else the first.
    pub fn new(channels: &Channels) -> Self {
        let grey = |visible: usize| -> Vec<[f32; 3]> {
            (0..channels.count()).map(|k| if k == visible { [1.0; 3] } else { [0.0; 3] }).collect()
        };
        let weights = match channels {
            Channels::Rgb => None,
            Channels::Mono => Some(grey(0)),
            Channels::Named(names) => {
                let visible = names.iter().position(|name| name.to_lowercase().contains("visible"));
                Some(grey(visible.unwrap_or(0)))
            }
            Channels::Xyz | Channels::Spectral(_) => {
                let map = ToColour::new(channels, Target::Rgb).expect("wavelengths have colours");
                Some(map.weights().iter().map(|weights| weights.map(|w| w as f32)).collect())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_spectra_are_grey_and_long_waves_are_red() {
        let wavelengths: Vec<f64> = (0..31).map(|k| 700.0 - 10.0 * f64::from(k)).collect();
        let reduction = Reduction::new(&Channels::Spectral(wavelengths.clone()));
        let mut out = [[0.0; 3]];
        reduction.apply(&[0.3; 31], &mut out);
        assert!(out[0].iter().all(|x| (x - 0.3).abs() < 1e-3), "{out:?}");
        let red: Vec<f32> = wavelengths.iter().map(|&nm| if nm > 600.0 { 1.0 } else { 0.0 }).collect();
        reduction.apply(&red, &mut out);
        assert!(out[0][0] > 0.5 && out[0][1] < 0.05 && out[0][2] < 0.05, "{out:?}");
    }

    #[test]
    fn one_band_among_others() {
        let mut out = [[0.0; 3]];
        for (names, expected) in [(["Solar", "Visible"], 0.7), (["Solar", "Infrared"], 0.1)] {
            let names = names.map(String::from).into();
            Reduction::new(&Channels::Named(names)).apply(&[0.1, 0.7], &mut out);
            assert!(out[0].iter().all(|x| (x - expected).abs() < 1e-6), "{out:?}, not {expected}");
        }
    }
}
