//! What travels along a path, and in which direction.

use std::fmt::Debug;

use lobe_colour::Reduction;

use crate::channels::Channels;
use crate::shader::Conversion;

/// Which of two adjoint quantities a path carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// The path begins at the camera; what it carries multiplies radiance. The known direction of a material leads to
    /// the viewer, and radiance that enters a denser medium is divided by eta^2.
    Radiance,
    /// The path begins at a light; what it carries multiplies importance. The known direction of a material leads to the
    /// light, and shading normals need a correction (Veach 1997, section 5.3).
    Importance,
}

/// What travels along a path: the types of radiance and of throughput, and how a material's answer is applied.
///
/// A renderer is generic in its transport. Lights emit a [`Spectrum`](Transport::Spectrum); a path has a
/// [`Throughput`](Transport::Throughput), to which the [`Scattering`](Transport::Scattering) of each surface is applied;
/// their product is the [`Radiance`](Transport::Radiance) that the film adds, and that becomes a colour at the film only.
pub trait Transport: Copy + Debug + Default + PartialEq + Eq + Send + Sync + 'static {
    /// What lights emit and what tints are: one unpolarised value per channel.
    type Spectrum: Channels;
    /// What the film adds.
    type Radiance: Channels;
    /// What a path carries.
    type Throughput: Copy + Debug + Send + Sync;
    /// A material's answer for a pair of directions: `f` times the cosine, or that over a density.
    type Scattering: Copy + Debug + Send + Sync;
    /// How the channels of a measurement become a [`Scattering`](Transport::Scattering).
    type Conversion: Conversion<Self>;

    /// What a path carries where it begins.
    const START: Self::Throughput;
    /// The answer of a material that absorbs everything.
    const ABSORBED: Self::Scattering;

    /// The answer of a material that scales each channel.
    fn scattering(spectrum: Self::Spectrum) -> Self::Scattering;

    /// A material's answer times a number.
    fn scale(scattering: Self::Scattering, factor: f32) -> Self::Scattering;

    /// A material's answer over a density.
    fn over(scattering: Self::Scattering, pdf: f32) -> Self::Scattering;

    /// What a path carries after a surface.
    fn apply(throughput: Self::Throughput, scattering: Self::Scattering) -> Self::Throughput;

    /// What a path carries times a number.
    fn weigh(throughput: Self::Throughput, factor: f32) -> Self::Throughput;

    /// What a path carries that has gone on by this chance.
    fn survive(throughput: Self::Throughput, chance: f32) -> Self::Throughput;

    /// The largest magnitude of what a path carries, which decides whether it continues. NaN counts as 0.
    fn magnitude(throughput: &Self::Throughput) -> f32;

    /// What arrives of emitted light.
    fn radiance(throughput: Self::Throughput, emitted: Self::Spectrum) -> Self::Radiance;

    /// Radiance that has this colour in linear sRGB.
    fn from_colour(colour: [f32; 3]) -> Self::Radiance;

    /// The colour of radiance in linear sRGB. Components outside of what sRGB can show are not clamped.
    fn colour(radiance: Self::Radiance) -> [f32; 3];
}

/// The exact sums of radiance.
#[doc(hidden)]
pub type RadianceSums<T> = <<T as Transport>::Radiance as Channels>::Sums;

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
