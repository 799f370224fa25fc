//! Transport of one value per wavelength.

use std::sync::Arc;

use lobe_spectrum::Spectrum;

use super::{Conversion, Transport, lone};
use crate::channels::Channels;
use crate::vec3::Vec3;

/// A value for each of up to `N` wavelengths: independent channels, lanes along them. Those beyond the number of
/// wavelengths are 0 throughout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bands<const N: usize>;

impl<const N: usize> Transport for Bands<N> {
    type Basis = Arc<lobe_spectrum::Bands>;
    type Spectrum = [f32; N];
    type Radiance = [f32; N];
    type Throughput = [f32; N];
    type Scattering = [f32; N];
    type Conversion = BandConversion<N>;

    const START: [f32; N] = [1.0; N];
    const ABSORBED: [f32; N] = [0.0; N];

    #[inline]
    fn scattering(spectrum: [f32; N]) -> [f32; N] {
        spectrum
    }

    #[inline]
    fn scale(scattering: [f32; N], factor: f32) -> [f32; N] {
        Channels::map(scattering, |x| x * factor)
    }

    #[inline]
    fn over(scattering: [f32; N], pdf: f32) -> [f32; N] {
        Channels::map(scattering, |x| x / pdf)
    }

    #[inline]
    fn apply(mut throughput: [f32; N], scattering: [f32; N]) -> [f32; N] {
        throughput.iter_mut().zip(scattering).for_each(|(x, y)| *x *= y);
        throughput
    }

    #[inline]
    fn weigh(throughput: [f32; N], factor: f32) -> [f32; N] {
        Channels::map(throughput, |x| x * factor)
    }

    #[inline]
    fn survive(throughput: [f32; N], chance: f32) -> [f32; N] {
        let factor = 1.0 / chance;
        Channels::map(throughput, |x| x * factor)
    }

    #[inline]
    fn magnitude(throughput: &[f32; N]) -> f32 {
        throughput.iter().fold(0.0f32, |most, t| most.max(t.abs()))
    }

    #[inline]
    fn radiance(mut throughput: [f32; N], emitted: [f32; N]) -> [f32; N] {
        throughput.iter_mut().zip(emitted).for_each(|(x, y)| *x *= y);
        throughput
    }

    fn from_colour(basis: &Self::Basis, colour: [f32; 3]) -> [f32; N] {
        Self::emission(basis, colour)
    }

    fn colour(basis: &Self::Basis, radiance: [f32; N]) -> [f32; 3] {
        basis.colour(&radiance)
    }

    fn names(basis: &Self::Basis) -> Vec<String> {
        // A point would begin a layer.
        basis.wavelengths().iter().map(|nm| format!("S0.{}nm", nm.to_string().replace('.', ","))).collect()
    }

    fn reflectance(basis: &Self::Basis, colour: [f32; 3]) -> [f32; N] {
        padded(&basis.reflectance(colour))
    }

    fn emission(basis: &Self::Basis, colour: [f32; 3]) -> [f32; N] {
        let mut spectrum = [0.0; N];
        basis.emission_into(colour, &mut spectrum);
        spectrum
    }

    fn reflectance_of(basis: &Self::Basis, spectrum: &Spectrum) -> [f32; N] {
        Self::sampled(basis, spectrum)
    }

    fn sampled(basis: &Self::Basis, spectrum: &Spectrum) -> [f32; N] {
        padded(&basis.at(spectrum).into_iter().map(|x| x as f32).collect::<Vec<f32>>())
    }

    fn light(basis: &Self::Basis, spectrum: &Spectrum, luminance: Option<f64>) -> [f32; N] {
        padded(&luminance.map_or_else(|| basis.light(spectrum), |luminance| basis.light_of(spectrum, luminance)))
    }

    fn measured(basis: &Self::Basis, channels: &lobe::Channels, values: &[f32]) -> Vec<[f32; N]> {
        let conversion = <BandConversion<N> as Conversion<Self>>::of(channels, basis);
        values.chunks_exact(conversion.channels).map(|texel| conversion.one(texel)).collect()
    }

    fn wavelengths(basis: &Self::Basis) -> Option<&[f64]> {
        Some(basis.wavelengths())
    }

    fn lone(throughput: &[f32; N], u: f32) -> (usize, f32) {
        lone(throughput, u)
    }

    fn at_camera(basis: &Self::Basis, _: Vec3, _: Vec3) -> [f32; N] {
        let mut start = [0.0; N];
        start[..basis.count()].fill(1.0);
        start
    }
}

fn padded<const N: usize>(values: &[f32]) -> [f32; N] {
    let mut all = [0.0; N];
    all[..values.len()].copy_from_slice(values);
    all
}

/// Conversion to the wavelengths of a picture.
#[derive(Clone, Debug)]
pub struct BandConversion<const N: usize> {
    channels: usize,
    parts: Parts<N>,
}

/// How bands are computed.
#[derive(Clone, Debug)]
enum Parts<const N: usize> {
    /// The channels are the bands.
    Same,
    /// A spectrum for each channel.
    Colours(Vec<[f32; N]>),
    /// For each band, two channels and their weights.
    Between { from: [[usize; 2]; N], weights: [[f32; 2]; N] },
}

impl<const N: usize> BandConversion<N> {
    fn one(&self, texel: &[f32]) -> [f32; N] {
        let mut out = [0.0; N];
        match &self.parts {
            Parts::Same => out[..texel.len()].copy_from_slice(texel),
            Parts::Colours(spectra) => {
                for (value, spectrum) in texel.iter().zip(spectra) {
                    out.iter_mut().zip(spectrum).for_each(|(sum, share)| *sum += value * share);
                }
            }
            Parts::Between { from, weights } => {
                for ((out, [a, b]), [x, y]) in out.iter_mut().zip(from).zip(weights) {
                    *out = x * texel[*a] + y * texel[*b];
                }
            }
        }
        out
    }
}

impl<const N: usize> Conversion<Bands<N>> for BandConversion<N> {
    fn of(channels: &lobe::Channels, basis: &<Bands<N> as Transport>::Basis) -> Self {
        let Some(resampling) = basis.resampling(channels) else {
            return BandConversion { channels: basis.count(), parts: Parts::Same };
        };
        let parts = if matches!(channels, lobe::Channels::Spectral(_)) {
            let (mut from, mut weights) = ([[0; 2]; N], [[0.0; 2]; N]);
            for (band, parts) in resampling.parts().iter().enumerate() {
                if let [(a, x), (b, y)] = parts[..] {
                    (from[band], weights[band]) = ([a, b], [x, y]);
                }
            }
            Parts::Between { from, weights }
        } else {
            let mut spectra = vec![[0.0; N]; resampling.channels()];
            for (band, parts) in resampling.parts().iter().enumerate() {
                parts.iter().for_each(|(channel, weight)| spectra[*channel][band] = *weight);
            }
            Parts::Colours(spectra)
        };
        BandConversion { channels: resampling.channels(), parts }
    }

    fn count(&self) -> usize {
        self.channels
    }

    fn in_place<'a>(&self, out: &'a mut [[f32; N]]) -> Option<&'a mut [f32]> {
        (matches!(self.parts, Parts::Same) && self.channels == N).then_some(out.as_flattened_mut())
    }

    fn convert(&self, values: &[f32], out: &mut [[f32; N]]) {
        for (texel, out) in values.chunks_exact(self.channels).zip(out) {
            *out = self.one(texel);
        }
    }
}
