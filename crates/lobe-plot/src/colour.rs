//! From channels to what can be drawn: one number for curves and maps, linear sRGB for pictures.

use lobe::Channels;

/// Fewer wavelengths than this do not make a spectrum: the nearest to red, green and blue stand for them.
const SPECTRUM_FROM: usize = 8;
/// Wavelengths in nm near the primaries of sRGB.
const PRIMARIES: [f64; 3] = [611.0, 549.0, 465.0];
/// What the eye can see, in nm.
const VISIBLE: std::ops::RangeInclusive<f64> = 380.0..=780.0;
/// Luminance of linear sRGB, IEC 61966-2-1.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];
/// Linear sRGB of CIE XYZ under D65, IEC 61966-2-1.
const RGB_OF_XYZ: [[f64; 3]; 3] = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];

/// The number that curves and maps show: a weighted sum of the channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// What it is, for people.
    pub name: String,
    weights: Vec<f32>,
}

impl Quantity {
    /// One channel as it is.
    pub fn channel(channels: &Channels, index: usize) -> Self {
        let mut weights = vec![0.0; channels.count()];
        weights[index] = 1.0;
        Quantity { name: format!("channel {}", channels.names()[index]), weights }
    }

    /// What the eye is most sensitive to: the luminance of colours, the visible band of named bands, the mean of a
    /// spectrum weighted with the CIE 1931 luminosity, or the wavelength nearest to 555 nm where there are few.
    pub fn of(channels: &Channels) -> Self {
        let sum = |name: &str, weights: &[f64]| Quantity {
            name: name.into(),
            weights: weights.iter().map(|&weight| weight as f32).collect(),
        };
        match channels {
            Channels::Mono => sum("", &[1.0]),
            Channels::Rgb => sum("luminance", &LUMINANCE),
            Channels::Xyz => sum("luminance", &[0.0, 1.0, 0.0]),
            Channels::Spectral(nm) if is_spectrum(nm) => {
                let weights: Vec<f64> = nm.iter().zip(widths(nm)).map(|(&nm, width)| width * cie_1931(nm)[1]).collect();
                let total: f64 = weights.iter().sum();
                sum("luminance", &weights.iter().map(|weight| weight / total).collect::<Vec<_>>())
            }
            Channels::Spectral(nm) => Quantity::channel(channels, nearest(nm, 555.0)),
            Channels::Named(names) => {
                let visible = names.iter().position(|name| name.eq_ignore_ascii_case("visible"));
                Quantity::channel(channels, visible.unwrap_or(0))
            }
        }
    }

    /// The number of a value.
    pub fn reduce(&self, texel: &[f32]) -> f32 {
        self.weights.iter().zip(texel).map(|(weight, value)| weight * value).sum()
    }
}

/// The linear sRGB of a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Colour {
    weights: Vec<[f32; 3]>,
}

impl Colour {
    /// The colours of a material under light that a flat spectrum reflects as white.
    ///
    /// Spectra are integrated with the CIE 1931 functions and scaled in each primary so that a flat one is white. Named
    /// bands, single channels and single wavelengths are grey.
    pub fn of(channels: &Channels) -> Self {
        let axis = |index: usize| std::array::from_fn(|k| if k == index { 1.0 } else { 0.0 });
        let weights: Vec<[f64; 3]> = match channels {
            Channels::Rgb => (0..3).map(axis).collect(),
            Channels::Xyz => (0..3).map(|c| RGB_OF_XYZ.map(|row| row[c])).collect(),
            Channels::Spectral(nm) if is_spectrum(nm) => spectrum(nm),
            Channels::Spectral(nm) => {
                let chosen = PRIMARIES.map(|primary| nearest(nm, primary));
                (0..nm.len()).map(|at| chosen.map(|chosen| if chosen == at { 1.0 } else { 0.0 })).collect()
            }
            Channels::Mono | Channels::Named(_) => {
                Quantity::of(channels).weights.iter().map(|&weight| [f64::from(weight); 3]).collect()
            }
        };
        Colour { weights: weights.into_iter().map(|rgb| rgb.map(|weight| weight as f32)).collect() }
    }

    /// One channel as grey.
    pub fn grey(quantity: &Quantity) -> Self {
        Colour { weights: quantity.weights.iter().map(|&weight| [weight; 3]).collect() }
    }

    /// Whether red, green and blue are always equal.
    pub fn is_grey(&self) -> bool {
        self.weights.iter().all(|[r, g, b]| r == g && g == b)
    }

    /// Linear sRGB, not clipped.
    pub fn rgb(&self, texel: &[f32]) -> [f32; 3] {
        let mut rgb = [0.0; 3];
        for (weights, value) in self.weights.iter().zip(texel) {
            rgb.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * value);
        }
        rgb
    }
}

fn spectrum(nm: &[f64]) -> Vec<[f64; 3]> {
    let mut weights: Vec<[f64; 3]> = Vec::with_capacity(nm.len());
    let mut total = [0.0; 3];
    for (&nm, width) in nm.iter().zip(widths(nm)) {
        let xyz = cie_1931(nm);
        let rgb = RGB_OF_XYZ.map(|row| width * (row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2]));
        total.iter_mut().zip(rgb).for_each(|(sum, weight)| *sum += weight);
        weights.push(rgb);
    }
    weights.iter().map(|rgb| std::array::from_fn(|k| rgb[k] / total[k])).collect()
}

/// Enough wavelengths, ascending, and spread over what the eye sees.
fn is_spectrum(nm: &[f64]) -> bool {
    let visible: Vec<f64> = nm.iter().copied().filter(|nm| VISIBLE.contains(nm)).collect();
    let spread =
        visible.first().is_some_and(|&first| first <= 470.0) && visible.last().is_some_and(|&last| last >= 620.0);
    visible.len() >= SPECTRUM_FROM && spread && nm.windows(2).all(|pair| pair[0] < pair[1])
}

/// The width in nm that each wavelength stands for.
fn widths(nm: &[f64]) -> Vec<f64> {
    let last = nm.len() - 1;
    (0..nm.len()).map(|at| 0.5 * (nm[(at + 1).min(last)] - nm[at.saturating_sub(1)])).collect()
}

fn nearest(nm: &[f64], to: f64) -> usize {
    let distance = |at: &usize| (nm[*at] - to).abs();
    (0..nm.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// The CIE 1931 colour matching functions at a wavelength in nm: the multi-lobe fit of Wyman, Sloan and Shirley, "Simple
/// Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013, equation 4.
fn cie_1931(nm: f64) -> [f64; 3] {
    let lobe = |centre: f64, below: f64, above: f64| {
        let t = (nm - centre) * if nm < centre { below } else { above };
        (-0.5 * t * t).exp()
    };
    [
        0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323) - 0.065 * lobe(501.1, 0.0490, 0.0382),
        0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322),
        1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_spectrum_is_white_and_a_red_one_is_red() {
        let nm: Vec<f64> = (0..41).map(|i| 380.0 + 10.0 * f64::from(i)).collect();
        let channels = Channels::Spectral(nm.clone());
        let white = Colour::of(&channels).rgb(&[0.5; 41]);
        assert!(white.iter().all(|c| (c - 0.5).abs() < 1e-5), "{white:?}");
        assert!((Quantity::of(&channels).reduce(&[0.5; 41]) - 0.5).abs() < 1e-5);
        let red: Vec<f32> = nm.iter().map(|&nm| if nm > 600.0 { 1.0 } else { 0.0 }).collect();
        let [r, g, b] = Colour::of(&channels).rgb(&red);
        // Without the orange below 605 nm it is not all of the red there is.
        assert!((0.6..0.9).contains(&r) && g.abs() < 0.1 && b.abs() < 0.05, "{r} {g} {b}");
    }

    #[test]
    fn few_wavelengths_are_taken_by_the_nearest() {
        let channels = Channels::Spectral(vec![450.0, 532.0, 633.0]);
        assert_eq!(Colour::of(&channels).rgb(&[0.1, 0.2, 0.3]), [0.3, 0.2, 0.1]);
        assert_eq!(Quantity::of(&channels).name, "channel 532nm");
        assert_eq!(Colour::of(&Channels::Spectral(vec![1064.0])).rgb(&[0.7]), [0.7; 3]);
    }

    #[test]
    fn the_visible_band_stands_for_bands() {
        let channels = Channels::Named(vec!["Solar".into(), "VISIBLE".into()]);
        assert_eq!(Quantity::of(&channels).reduce(&[1.0, 0.25]), 0.25);
        assert_eq!(Colour::of(&channels).rgb(&[1.0, 0.25]), [0.25; 3]);
        assert_eq!(Quantity::channel(&channels, 0).reduce(&[1.0, 0.25]), 1.0);
    }
}
