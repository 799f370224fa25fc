//! The weight of each channel when directions are drawn.

use crate::reduction::{any_visible, of_wavelengths};
use crate::{Channels, LUMINANCE};

/// The weight of each channel in luminance: Y of XYZ, the weights of Rec. 709 for RGB, and Y of the spectrum that has
/// the value 1 at one wavelength, as [`Reduction`](crate::Reduction) interpolates it. The weights sum to 1.
///
/// Named bands have equal weights, because any of them may be requested, and so do wavelengths if none of them is
/// visible.
pub fn luminance(channels: &Channels) -> Vec<f32> {
    match channels {
        Channels::Mono => vec![1.0],
        Channels::Rgb => LUMINANCE.into(),
        Channels::Xyz => vec![0.0, 1.0, 0.0],
        Channels::Spectral(wavelengths) if any_visible(wavelengths) => {
            of_wavelengths(wavelengths).into_iter().map(|[_, y, _]| y as f32).collect()
        }
        Channels::Spectral(_) | Channels::Named(_) => vec![1.0 / channels.count() as f32; channels.count()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn green_weighs_most_and_invisible_channels_weigh_alike() {
        let weights = luminance(&Channels::Spectral((0..31).map(|i| 400.0 + 10.0 * f64::from(i)).collect()));
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        let brightest = (0..31).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap();
        assert!((14..=17).contains(&brightest), "{brightest}");
        assert_eq!(luminance(&Channels::Spectral(vec![1550.0, 3390.0])), [0.5, 0.5]);
        assert_eq!(luminance(&Channels::Spectral(vec![633.0])), [1.0]);
        assert_eq!(luminance(&Channels::Named(vec!["Solar".into(), "Visible".into()])), [0.5, 0.5]);
    }
}
