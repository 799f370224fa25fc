//! How much each channel counts when directions are drawn.

use crate::Channels;

/// The weight of each channel in luminance: Y of XYZ, the weights of Rec. 709 for RGB, CIE 1931 Y over the wavelengths of
/// a spectrum, and the mean of what has names only. Wavelengths that cannot be seen count alike.
pub fn luminance(channels: &Channels) -> Vec<f32> {
    match channels {
        Channels::Mono => vec![1.0],
        // Rec. ITU-R BT.709, item 3.2.
        Channels::Rgb => vec![0.2126, 0.7152, 0.0722],
        Channels::Xyz => vec![0.0, 1.0, 0.0],
        Channels::Spectral(wavelengths) => spectral(wavelengths),
        Channels::Named(_) => mean(channels.count()),
    }
}

fn mean(count: usize) -> Vec<f32> {
    vec![1.0 / count as f32; count]
}

/// The share of each wavelength in Y under equal energy: its sensitivity times half the way between its neighbours.
fn spectral(wavelengths: &[f64]) -> Vec<f32> {
    let last = wavelengths.len() - 1;
    let share = |i: usize| {
        let width = (wavelengths[(i + 1).min(last)] - wavelengths[i.saturating_sub(1)]).abs();
        sensitivity(wavelengths[i]) * if last == 0 { 1.0 } else { width }
    };
    let shares: Vec<f64> = (0..=last).map(share).collect();
    let total: f64 = shares.iter().sum();
    if total < 1e-3 {
        return mean(wavelengths.len());
    }
    shares.iter().map(|share| (share / total) as f32).collect()
}

/// The luminous efficiency of the CIE 1931 observer at a wavelength in nm, within 0.01: the fit of two pieced Gaussians
/// of Wyman, Sloan and Shirley 2013, *Simple analytic approximations to the CIE XYZ color matching functions*, section
/// 2.2.
fn sensitivity(nm: f64) -> f64 {
    let lobe = |center: f64, [below, above]: [f64; 2]| {
        let t = (nm - center) * if nm < center { below } else { above };
        (-0.5 * t * t).exp()
    };
    0.821 * lobe(568.8, [0.0213, 0.0247]) + 0.286 * lobe(530.9, [0.0613, 0.0322])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn green_counts_most_and_what_cannot_be_seen_counts_alike() {
        let weights = luminance(&Channels::Spectral((0..31).map(|i| 400.0 + 10.0 * f64::from(i)).collect()));
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        let brightest = (0..31).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap();
        assert!((14..=17).contains(&brightest), "{brightest}");
        assert_eq!(luminance(&Channels::Spectral(vec![1550.0, 3390.0])), [0.5, 0.5]);
        assert_eq!(luminance(&Channels::Spectral(vec![633.0])), [1.0]);
        // CIE 1931: 0.3230 at 500 nm and 0.9950 at 555 nm.
        assert!((sensitivity(500.0) - 0.323).abs() < 0.02 && (sensitivity(555.0) - 0.995).abs() < 0.02);
    }
}
