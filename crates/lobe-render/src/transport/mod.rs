//! What travels along a path, and in which direction.

mod rgb;

use std::fmt::Debug;

pub use rgb::Rgb;

use crate::channels::Channels;

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

/// How the channels of a measurement become what a transport applies.
pub trait Conversion<T: Transport>: Debug + Send + Sync + Sized {
    /// The conversion from these channels.
    fn of(channels: &lobe::Channels) -> Self;

    /// How many channels the material has.
    fn count(&self) -> usize;

    /// The floats of `out`, if the values of the material can be written there as they are.
    fn in_place<'a>(&self, out: &'a mut [T::Scattering]) -> Option<&'a mut [f32]>;

    /// Converts `values`, `[query][channel]`.
    fn convert(&self, values: &[f32], out: &mut [T::Scattering]);
}

/// The exact sums of radiance.
#[doc(hidden)]
pub type RadianceSums<T> = <<T as Transport>::Radiance as Channels>::Sums;
