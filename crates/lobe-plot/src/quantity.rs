//! From channels to the single number that curves and maps show.

use lobe_colour::{Channels, NamedBands, luminance};

/// The number that curves and maps show: a weighted sum of the channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Its description, for people.
    pub name: String,
    weights: Vec<f32>,
}

impl Quantity {
    /// One channel, unchanged.
    ///
    /// # Panics
    /// If there is no channel `index`.
    pub fn channel(channels: &Channels, index: usize) -> Self {
        let mut weights = vec![0.0; channels.count()];
        weights[index] = 1.0;
        Quantity { name: format!("channel {}", channels.names()[index]), weights }
    }

    /// The luminance of colours and spectra; the visible one of named bands, or the first if none is visible; the
    /// wavelength nearest to 555 nm if none is visible.
    pub fn of(channels: &Channels) -> Self {
        let sum = |name: &str| Quantity { name: name.into(), weights: luminance(channels) };
        match channels {
            Channels::Mono => sum(""),
            Channels::Rgb | Channels::Xyz => sum("luminance"),
            Channels::Spectral(nm) if nm.len() > 1 && nm.iter().any(|nm| (380.0..=780.0).contains(nm)) => {
                sum("luminance")
            }
            Channels::Spectral(nm) => Quantity::channel(channels, nearest(nm, 555.0)),
            Channels::Named(names) => Quantity::channel(channels, NamedBands::new(names).visible.unwrap_or(0)),
        }
    }

    /// The number of a value.
    pub fn reduce(&self, texel: &[f32]) -> f32 {
        self.weights.iter().zip(texel).map(|(weight, value)| weight * value).sum()
    }

    /// The number of a value in `f64`.
    pub(crate) fn exact(&self, texel: &[f64]) -> f64 {
        self.weights.iter().zip(texel).map(|(&weight, value)| f64::from(weight) * value).sum()
    }
}

fn nearest(nm: &[f64], to: f64) -> usize {
    let distance = |at: &usize| (nm[*at] - to).abs();
    (0..nm.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectra_show_their_luminance_or_one_wavelength() {
        let spectrum = Quantity::of(&Channels::Spectral(vec![450.0, 550.0, 650.0]));
        assert_eq!(spectrum.name, "luminance");
        assert!((spectrum.reduce(&[0.5; 3]) - 0.5).abs() < 1e-6);
        assert_eq!(Quantity::of(&Channels::Spectral(vec![532.0])).name, "channel 532nm");
        assert_eq!(Quantity::of(&Channels::Spectral(vec![1064.0, 1550.0])).name, "channel 1064nm");
    }

    #[test]
    fn the_visible_band_represents_bands() {
        let channels = Channels::Named(vec!["Solar".into(), "VISIBLE".into()]);
        assert_eq!(Quantity::of(&channels).reduce(&[1.0, 0.25]), 0.25);
        assert_eq!(Quantity::channel(&channels, 0).reduce(&[1.0, 0.25]), 1.0);
        assert_eq!(Quantity::of(&Channels::Named(vec!["Solar".into(), "NIR".into()])).reduce(&[1.0, 0.25]), 1.0);
    }
}
