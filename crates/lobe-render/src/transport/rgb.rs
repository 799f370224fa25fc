//! Pictures in linear sRGB.

use lobe_colour::Reduction;

use super::{Conversion, Transport};

/// Linear sRGB: three independent channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rgb;

impl Transport for Rgb {
    type Spectrum = [f32; 3];
    type Radiance = [f32; 3];
    type Throughput = [f32; 3];
    type Scattering = [f32; 3];
    type Conversion = Reduction;

    const START: [f32; 3] = [1.0; 3];
    const ABSORBED: [f32; 3] = [0.0; 3];

    #[inline]
    fn scattering(spectrum: [f32; 3]) -> [f32; 3] {
        spectrum
    }

    #[inline]
    fn scale(scattering: [f32; 3], factor: f32) -> [f32; 3] {
        scattering.map(|x| x * factor)
    }

    #[inline]
    fn over(scattering: [f32; 3], pdf: f32) -> [f32; 3] {
        scattering.map(|x| x / pdf)
    }

    #[inline]
    fn apply(throughput: [f32; 3], scattering: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|k| throughput[k] * scattering[k])
    }

    #[inline]
    fn weigh(throughput: [f32; 3], factor: f32) -> [f32; 3] {
        throughput.map(|t| t * factor)
    }

    #[inline]
    fn survive(throughput: [f32; 3], chance: f32) -> [f32; 3] {
        throughput.map(|t| t / chance)
    }

    #[inline]
    fn magnitude(throughput: &[f32; 3]) -> f32 {
        throughput.iter().fold(0.0f32, |most, t| most.max(t.abs()))
    }

    #[inline]
    fn radiance(throughput: [f32; 3], emitted: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|k| throughput[k] * emitted[k])
    }

    #[inline]
    fn from_colour(colour: [f32; 3]) -> [f32; 3] {
        colour
    }

    #[inline]
    fn colour(radiance: [f32; 3]) -> [f32; 3] {
        radiance
    }
}

/// To linear sRGB, as everything that is displayed.
impl Conversion<Rgb> for Reduction {
    fn of(channels: &lobe::Channels) -> Self {
        Reduction::for_display(channels)
    }

    fn count(&self) -> usize {
        self.channels()
    }

    fn in_place<'a>(&self, out: &'a mut [[f32; 3]]) -> Option<&'a mut [f32]> {
        self.is_identity().then_some(out.as_flattened_mut())
    }

    fn convert(&self, values: &[f32], out: &mut [[f32; 3]]) {
        self.apply_batch(values, out);
    }
}
