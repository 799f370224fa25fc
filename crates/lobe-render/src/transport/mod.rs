//! What travels along a path, and in which direction.

mod bands;
mod mueller;
mod rgb;
mod stokes;

use std::fmt::Debug;

use lobe_spectrum::Spectrum;

pub use bands::{BandConversion, Bands};
pub use mueller::Mueller;
pub use rgb::Rgb;
pub use stokes::{Components, Polarisation, Stokes, Stokes16, StokesConversion, StokesRgb};

use crate::channels::Channels;
use crate::vec3::Vec3;

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
    /// What the channels of a picture are, if that is not known by their type: the wavelengths.
    type Basis: Clone + Debug + Send + Sync + 'static;
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

    /// Whether light is polarised, so that the frames of surfaces count.
    const POLARISED: bool = false;
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
    fn from_colour(basis: &Self::Basis, colour: [f32; 3]) -> Self::Radiance;

    /// The colour of radiance in linear sRGB. Components outside of what sRGB can show are not clamped.
    fn colour(basis: &Self::Basis, radiance: Self::Radiance) -> [f32; 3];

    /// What the channels of radiance are called in files; empty if they are nothing but red, green and blue.
    fn names(basis: &Self::Basis) -> Vec<String>;

    /// What reflects or lets through light of this colour, in `[0, 1]`.
    fn reflectance(basis: &Self::Basis, colour: [f32; 3]) -> Self::Spectrum;

    /// Light of this colour.
    fn emission(basis: &Self::Basis, colour: [f32; 3]) -> Self::Spectrum;

    /// What reflects or lets through the shares of a spectrum.
    fn reflectance_of(basis: &Self::Basis, spectrum: &Spectrum) -> Self::Spectrum;

    /// A spectrum of indices.
    fn sampled(basis: &Self::Basis, spectrum: &Spectrum) -> Self::Spectrum;

    /// A spectrum of light: scaled to the luminance, if one is given.
    fn light(basis: &Self::Basis, spectrum: &Spectrum, luminance: Option<f64>) -> Self::Spectrum;

    /// Measured shares, `[query][channel]`, as spectra.
    fn measured(basis: &Self::Basis, channels: &lobe::Channels, values: &[f32]) -> Vec<Self::Spectrum>;

    /// The colour of what reflects or lets through these shares, under white light.
    fn colour_of(basis: &Self::Basis, shares: Self::Spectrum) -> [f32; 3] {
        let white = Self::emission(basis, [1.0; 3]);
        Self::colour(basis, Self::radiance(Self::apply(Self::START, Self::scattering(shares)), white))
    }

    /// The wavelengths of the channels in nm, if they are wavelengths.
    fn wavelengths(basis: &Self::Basis) -> Option<&[f64]>;

    /// The degree of linear polarisation, from 0 to 1, and the angle of linear polarisation from the right of the picture, in
    /// radians from 0 to pi, of the luminance; `None` if light is not polarised.
    fn linear_polarisation(basis: &Self::Basis, radiance: Self::Radiance) -> Option<[f32; 2]> {
        let _ = (basis, radiance);
        None
    }

    /// One of the channels that a path still carries, by a number in `[0, 1)`, and by what it counts for all of them.
    fn lone(throughput: &Self::Throughput, u: f32) -> (usize, f32);

    /// The answer of a mirror, of glass or of another surface with exact directions, for a ray back along `wo`.
    fn delta(
        weight: Self::Spectrum,
        polarisation: Option<&Polarisation<Self::Spectrum>>,
        wi: Vec3,
        wo: Vec3,
    ) -> Self::Scattering {
        let _ = (polarisation, wi, wo);
        Self::scattering(weight)
    }

    /// What a path carries that begins at the camera, whose right is given, along a ray.
    fn at_camera(basis: &Self::Basis, right: Vec3, direction: Vec3) -> Self::Throughput {
        let _ = (basis, right, direction);
        Self::START
    }

    /// The answer of a material for directions in its frame, as one for directions in the world.
    fn in_world(scattering: Self::Scattering, frame: &[Vec3; 3], wi: Vec3, wo: Vec3) -> Self::Scattering {
        let _ = (frame, wi, wo);
        scattering
    }
}

/// How the channels of a measurement become what a transport applies.
pub trait Conversion<T: Transport>: Debug + Send + Sync + Sized {
    /// The conversion from these channels.
    fn of(channels: &lobe::Channels, basis: &T::Basis) -> Self;

    /// How many channels the material has.
    fn count(&self) -> usize;

    /// The floats of `out`, if the values of the material can be written there as they are.
    fn in_place<'a>(&self, out: &'a mut [T::Scattering]) -> Option<&'a mut [f32]>;

    /// Converts `values`, `[query][channel]`.
    fn convert(&self, values: &[f32], out: &mut [T::Scattering]);

    /// Converts Mueller matrices, `[query][channel][row][column]`. Only called if light is polarised.
    fn convert_matrices(&self, matrices: &[f32], out: &mut [T::Scattering]) {
        let _ = matrices;
        out.fill(T::ABSORBED);
    }
}

/// The exact sums of radiance.
#[doc(hidden)]
pub type RadianceSums<T> = <<T as Transport>::Radiance as Channels>::Sums;

/// One of the channels that are not 0, each with the same chance, and how many they are.
fn lone(channels: &[f32], u: f32) -> (usize, f32) {
    let count = channels.iter().filter(|x| **x != 0.0).count();
    let chosen = ((u * count as f32) as usize).min(count.saturating_sub(1));
    let channel = channels.iter().enumerate().filter(|(_, x)| **x != 0.0).nth(chosen);
    (channel.map_or(0, |(channel, _)| channel), count.max(1) as f32)
}
