//! Transports: the kinds of light that travel along a path, and the direction in which it is followed.

mod bands;
mod components;
mod mueller;
mod rgb;
mod rows;
mod stokes;

use std::fmt::Debug;

use lobe_spectrum::Spectrum;

pub use bands::{BandConversion, Bands};
pub use components::Components;
pub use mueller::Mueller;
pub use rgb::Rgb;
pub use rows::Rows;
pub use stokes::{Energy16, EnergyRgb, Polarisation, Stokes, Stokes16, StokesConversion, StokesRgb};

use crate::channels::Channels;
use crate::light::LightPolarisation;
use crate::vec3::Vec3;

/// Which of two adjoint quantities a path carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// The path begins at the camera; its throughput multiplies radiance. The known direction of a material leads to
    /// the viewer, and radiance that enters a denser medium is divided by eta^2.
    Radiance,
    /// The path begins at a light; its throughput multiplies importance. The known direction of a material leads to the
    /// light, and shading normals need a correction (Veach 1997, section 5.3).
    Importance,
}

/// A surface that scatters light, with the directions of both parts of its path.
#[derive(Clone, Copy, Debug)]
pub struct Bounce {
    /// The axes of the frame of the surface, in the world.
    pub frame: [Vec3; 3],
    /// Toward the light, in the frame of the surface.
    pub wi: Vec3,
    /// Toward the viewer, in the frame of the surface.
    pub wo: Vec3,
}

/// A kind of light that travels along a path: the types of radiance and throughput, and how scattering by a material is
/// applied.
///
/// A renderer is generic in its transport. Lights emit a [`Spectrum`](Transport::Spectrum); a path has a
/// [`Throughput`](Transport::Throughput), to which the [`Scattering`](Transport::Scattering) of each surface is
/// applied; their product is the [`Radiance`](Transport::Radiance) that the film adds, and that becomes a colour only
/// at the film.
pub trait Transport: Copy + Debug + Default + PartialEq + Eq + Send + Sync + 'static {
    /// Describes the channels of a picture, if their type does not: the wavelengths.
    type Basis: Clone + Debug + Send + Sync + 'static;
    /// Emission of lights and tints: one unpolarised value per channel.
    type Spectrum: Channels;
    /// The light that the film adds.
    type Radiance: Channels;
    /// The throughput of a path.
    type Throughput: Copy + Debug + Send + Sync;
    /// The scattering of a material for a pair of directions: `f` times the cosine, or the same over a density.
    type Scattering: Copy + Debug + Send + Sync;
    /// How the channels of a measurement become a [`Scattering`](Transport::Scattering).
    type Conversion: Conversion<Self>;

    /// `true` if light is polarised, so that the frames of surfaces matter.
    const POLARISED: bool = false;
    /// `true` if films have the polarisation of light.
    const SHOWS_POLARISATION: bool = false;
    /// The throughput at the beginning of a path.
    const START: Self::Throughput;
    /// The scattering of a material that absorbs everything.
    const ABSORBED: Self::Scattering;

    /// The scattering of a material that scales each channel.
    fn scattering(spectrum: Self::Spectrum) -> Self::Scattering;

    /// Scattering times a number.
    fn scale(scattering: Self::Scattering, factor: f32) -> Self::Scattering;

    /// Scattering over a density.
    fn over(scattering: Self::Scattering, pdf: f32) -> Self::Scattering;

    /// The throughput after a surface.
    fn apply(throughput: Self::Throughput, scattering: Self::Scattering) -> Self::Throughput;

    /// A throughput times a number.
    fn weigh(throughput: Self::Throughput, factor: f32) -> Self::Throughput;

    /// The throughput of a path that has continued with this probability.
    fn survive(throughput: Self::Throughput, chance: f32) -> Self::Throughput;

    /// The largest magnitude of a throughput, which decides whether the path continues. NaN counts as 0.
    fn magnitude(throughput: &Self::Throughput) -> f32;

    /// Emitted light after a throughput.
    fn radiance(throughput: Self::Throughput, emitted: Self::Spectrum) -> Self::Radiance;

    /// Like [`radiance`](Self::radiance), for light that may be polarised and comes from a unit direction of the world.
    #[inline]
    fn radiance_from(
        throughput: Self::Throughput,
        emitted: Self::Spectrum,
        polarisation: Option<&LightPolarisation>,
        toward: Vec3,
    ) -> Self::Radiance {
        let _ = (polarisation, toward);
        Self::radiance(throughput, emitted)
    }

    /// Like [`radiance_from`](Self::radiance_from), for light that a surface scatters into a path.
    #[inline]
    fn scattered_radiance(
        throughput: &Self::Throughput,
        scattering: &Self::Scattering,
        bounce: &Bounce,
        emitted: Self::Spectrum,
        polarisation: Option<&LightPolarisation>,
        toward: Vec3,
    ) -> Self::Radiance {
        let _ = (bounce, polarisation, toward);
        Self::radiance(Self::apply(*throughput, *scattering), emitted)
    }

    /// Radiance of which no channel is above a limit. NaN stays NaN, to be counted.
    #[inline]
    fn limited(radiance: Self::Radiance, limit: f32) -> Self::Radiance {
        radiance.map(|value| if value > limit { limit } else { value })
    }

    /// Radiance with this colour in linear sRGB.
    fn from_colour(basis: &Self::Basis, colour: [f32; 3]) -> Self::Radiance;

    /// The colour of radiance in linear sRGB. Components outside the range of sRGB are not clamped.
    fn colour(basis: &Self::Basis, radiance: Self::Radiance) -> [f32; 3];

    /// The names of the channels of radiance in files; empty if they are just red, green and blue.
    fn names(basis: &Self::Basis) -> Vec<String>;

    /// The spectrum of a material that reflects or transmits this colour, in `[0, 1]`.
    fn reflectance(basis: &Self::Basis, colour: [f32; 3]) -> Self::Spectrum;

    /// The spectrum of light of this colour.
    fn emission(basis: &Self::Basis, colour: [f32; 3]) -> Self::Spectrum;

    /// The spectrum of a material that reflects or transmits these shares.
    fn reflectance_of(basis: &Self::Basis, spectrum: &Spectrum) -> Self::Spectrum;

    /// A spectrum of refractive indices.
    fn sampled(basis: &Self::Basis, spectrum: &Spectrum) -> Self::Spectrum;

    /// A spectrum of light, scaled to the luminance if one is given.
    fn light(basis: &Self::Basis, spectrum: &Spectrum, luminance: Option<f64>) -> Self::Spectrum;

    /// Measured shares, `[query][channel]`, as spectra.
    fn measured(basis: &Self::Basis, channels: &lobe::Channels, values: &[f32]) -> Vec<Self::Spectrum>;

    /// The colour under white light of a material that reflects or transmits these shares.
    fn colour_of(basis: &Self::Basis, shares: Self::Spectrum) -> [f32; 3] {
        let white = Self::emission(basis, [1.0; 3]);
        Self::colour(basis, Self::radiance(Self::apply(Self::START, Self::scattering(shares)), white))
    }

    /// The wavelengths of the channels in nm, if they are wavelengths.
    fn wavelengths(basis: &Self::Basis) -> Option<&[f64]>;

    /// The degree of linear polarisation, from 0 to 1, and the angle of linear polarisation from the right of the
    /// picture, in radians from 0 to pi, of the luminance; `None` if light is not polarised.
    fn linear_polarisation(basis: &Self::Basis, radiance: Self::Radiance) -> Option<[f32; 2]> {
        let _ = (basis, radiance);
        None
    }

    /// Chooses one of the channels that a path still carries by a number in `[0, 1)`, and returns its weight for all of
    /// them.
    fn lone(throughput: &Self::Throughput, u: f32) -> (usize, f32);

    /// The throughput after a surface that scatters light. Only polarised light depends on its frame.
    #[inline]
    fn bounce(throughput: &Self::Throughput, scattering: &Self::Scattering, bounce: &Bounce) -> Self::Throughput {
        let _ = bounce;
        Self::apply(*throughput, *scattering)
    }

    /// The throughput after a mirror, glass or another surface with exact directions.
    #[inline]
    fn bounce_exactly(
        throughput: Self::Throughput,
        weight: Self::Spectrum,
        polarisation: Option<&Polarisation<Self::Spectrum>>,
        bounce: &Bounce,
    ) -> Self::Throughput {
        let _ = (polarisation, bounce);
        Self::apply(throughput, Self::scattering(weight))
    }

    /// The throughput of a path that begins along a ray at the camera; `top` leads to the top of the picture.
    fn at_camera(basis: &Self::Basis, top: Vec3, direction: Vec3) -> Self::Throughput {
        let _ = (basis, top, direction);
        Self::START
    }
}

/// Converts the channels of a measurement to the scattering of a transport.
pub trait Conversion<T: Transport>: Debug + Send + Sync + Sized {
    /// The conversion from these channels.
    fn of(channels: &lobe::Channels, basis: &T::Basis) -> Self;

    /// Number of channels of the material.
    fn count(&self) -> usize;

    /// The floats of `out`, if the values of the material can be written there directly.
    fn in_place<'a>(&self, out: &'a mut [T::Scattering]) -> Option<&'a mut [f32]>;

    /// Converts `values`, `[query][channel]`.
    fn convert(&self, values: &[f32], out: &mut [T::Scattering]);

    /// Converts Mueller matrices, `[query][channel][row][column]`. Called only if light is polarised.
    fn convert_matrices(&self, matrices: &[f32], out: &mut [T::Scattering]) {
        let _ = matrices;
        out.fill(T::ABSORBED);
    }
}

/// The exact sums of radiance.
#[doc(hidden)]
pub type RadianceSums<T> = <<T as Transport>::Radiance as Channels>::Sums;

/// One of the channels that are not 0, each with the same probability, and their number.
fn lone(channels: &[f32], u: f32) -> (usize, f32) {
    let count = channels.iter().filter(|x| **x != 0.0).count();
    let chosen = ((u * count as f32) as usize).min(count.saturating_sub(1));
    let channel = channels.iter().enumerate().filter(|(_, x)| **x != 0.0).nth(chosen);
    (channel.map_or(0, |(channel, _)| channel), count.max(1) as f32)
}
