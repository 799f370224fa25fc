//! Transport in linear sRGB.

use std::sync::OnceLock;

use lobe_colour::Reduction;
use lobe_spectrum::{Bands, Spectrum};

use super::{Conversion, Transport, lone};

/// Linear sRGB: three independent channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rgb;

impl Transport for Rgb {
    type Basis = ();
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

    fn from_colour((): &(), colour: [f32; 3]) -> [f32; 3] {
        colour
    }

    #[inline]
    fn colour((): &(), radiance: [f32; 3]) -> [f32; 3] {
        radiance
    }

    fn names((): &()) -> Vec<String> {
        Vec::new()
    }

    fn reflectance((): &(), colour: [f32; 3]) -> [f32; 3] {
        colour
    }

    fn emission((): &(), colour: [f32; 3]) -> [f32; 3] {
        colour
    }

    fn reflectance_of((): &(), spectrum: &Spectrum) -> [f32; 3] {
        reflectance(spectrum)
    }

    fn sampled((): &(), spectrum: &Spectrum) -> [f32; 3] {
        PLACES.map(|nm| spectrum.at(nm) as f32)
    }

    fn light((): &(), spectrum: &Spectrum, luminance: Option<f64>) -> [f32; 3] {
        light(spectrum, luminance)
    }

    fn measured((): &(), channels: &lobe::Channels, values: &[f32]) -> Vec<[f32; 3]> {
        let reduction = Reduction::for_display(channels);
        let mut colours = vec![[0.0; 3]; values.len() / reduction.channels()];
        reduction.apply_batch(values, &mut colours);
        colours
    }

    fn wavelengths((): &()) -> Option<&[f64]> {
        None
    }

    fn lone(throughput: &[f32; 3], u: f32) -> (usize, f32) {
        lone(throughput, u)
    }
}

/// Conversion to linear sRGB, as for everything that is displayed.
impl Conversion<Rgb> for Reduction {
    fn of(channels: &lobe::Channels, (): &()) -> Self {
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

/// The bands over which spectra are integrated.
fn fine() -> &'static Bands {
    static FINE: OnceLock<Bands> = OnceLock::new();
    FINE.get_or_init(|| Bands::uniform(31).expect("visible bands"))
}

/// Wavelengths at which the refractive index is taken for red, green and blue, in nm.
const PLACES: [f64; 3] = [610.0, 550.0, 465.0];

/// The colour of light.
fn light(spectrum: &Spectrum, luminance: Option<f64>) -> [f32; 3] {
    let bands = fine();
    let light = luminance.map_or_else(|| bands.light(spectrum), |luminance| bands.light_of(spectrum, luminance));
    bands.colour(&light).map(|c| c.max(0.0))
}

/// The colour of a reflectance under D65.
fn reflectance(spectrum: &Spectrum) -> [f32; 3] {
    let bands = fine();
    let white = bands.emission([1.0; 3]);
    let seen: Vec<f32> = bands.at(spectrum).iter().zip(white).map(|(share, light)| *share as f32 * light).collect();
    bands.colour(&seen).map(|c| c.clamp(0.0, 1.0))
}
