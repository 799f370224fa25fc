//! Polarised light: four Stokes components of each channel.
//!
//! A Stokes vector refers to an x axis across the direction in which light travels, which for directions of the world
//! and of materials is [`stokes_basis`] of that direction; at the film it is the direction to the right that is across
//! the ray and across the upward direction of the camera, as in Mitsuba 3. S1 is light along the x axis minus light
//! across it, S2 light along the diagonal from the x to the y axis minus light across that, and S3 right circular light,
//! whose field turns clockwise as seen by the receiver, minus left circular light.

use std::fmt::Debug;
use std::marker::PhantomData;

use lobe_spectrum::Spectrum;

use super::components::Components;
use super::rows::{Rows, doubled, stokes_basis};
use super::{Bands, Bounce, Conversion, Mueller, Rgb, Transport};
use crate::light::LightPolarisation;
use crate::vec3::{Vec3, cross, neg, unit};

/// Polarised light over the `N` channels of another transport, of which the film sums the first `R` Stokes components:
/// all four, or the energy alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stokes<T, const R: usize, const N: usize>(PhantomData<T>);

/// Polarised light in linear sRGB.
pub type StokesRgb = Stokes<Rgb, 4, 3>;
/// Polarised light of up to 16 wavelengths.
pub type Stokes16 = Stokes<Bands<16>, 4, 16>;
/// Polarised light in linear sRGB for a sensor that counts energy.
pub type EnergyRgb = Stokes<Rgb, 1, 3>;
/// Polarised light of up to 16 wavelengths for a sensor that counts energy.
pub type Energy16 = Stokes<Bands<16>, 1, 16>;

/// The effect of a smooth surface on polarised light: the Mueller matrix `[[1, b, 0, 0], [b, 1, 0, 0], [0, 0, c, s],
/// [0, 0, -s, c]]` times the weight of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polarisation<S> {
    /// The x axes of the Stokes frames of incoming and outgoing light, in the frame of the surface.
    pub axis: [f32; 3],
    /// Light along the axis minus light across it, for unpolarised light.
    pub b: S,
    /// The share of diagonal and of circular light that is left.
    pub c: S,
    /// The share of one of these that is converted into the other.
    pub s: S,
}

/// S1, S2 and S3 over S0 of light that comes from a unit direction.
fn arriving(polarisation: Option<&LightPolarisation>, toward: Vec3) -> Option<[f32; 3]> {
    let direction = neg(toward);
    polarisation.map(|polarisation| polarisation.along(direction, stokes_basis(direction)))
}

impl<T, const R: usize, const N: usize> Transport for Stokes<T, R, N>
where
    T: Transport<Spectrum = [f32; N], Radiance = [f32; N], Throughput = [f32; N], Scattering = [f32; N]>,
{
    type Basis = T::Basis;
    type Spectrum = [f32; N];
    type Radiance = Components<f32, R, N>;
    type Throughput = Rows<R, N>;
    type Scattering = Mueller<N>;
    type Conversion = StokesConversion<T::Conversion>;

    const POLARISED: bool = true;
    const SHOWS_POLARISATION: bool = R == 4;
    const START: Rows<R, N> = Rows::IDENTITY;
    const ABSORBED: Mueller<N> = Mueller { elements: [[[0.0; N]; 4]; 4], depolarises: true };

    #[inline]
    fn scattering(spectrum: [f32; N]) -> Mueller<N> {
        Mueller::depolarising(spectrum)
    }

    #[inline]
    fn scale(scattering: Mueller<N>, factor: f32) -> Mueller<N> {
        scattering.scaled(factor)
    }

    #[inline]
    fn over(scattering: Mueller<N>, pdf: f32) -> Mueller<N> {
        scattering.scaled(1.0 / pdf)
    }

    fn apply(throughput: Rows<R, N>, scattering: Mueller<N>) -> Rows<R, N> {
        throughput.after(&scattering)
    }

    #[inline]
    fn weigh(throughput: Rows<R, N>, factor: f32) -> Rows<R, N> {
        throughput.scaled(factor)
    }

    #[inline]
    fn survive(throughput: Rows<R, N>, chance: f32) -> Rows<R, N> {
        throughput.scaled(1.0 / chance)
    }

    #[inline]
    fn magnitude(throughput: &Rows<R, N>) -> f32 {
        // The first element bounds the others.
        throughput.elements[0][0].iter().fold(0.0f32, |most, t| most.max(t.abs()))
    }

    fn radiance(throughput: Rows<R, N>, emitted: [f32; N]) -> Components<f32, R, N> {
        Components(throughput.of_light(&emitted, None))
    }

    fn radiance_from(
        throughput: Rows<R, N>,
        emitted: [f32; N],
        polarisation: Option<&LightPolarisation>,
        toward: Vec3,
    ) -> Components<f32, R, N> {
        Components(throughput.of_light(&emitted, arriving(polarisation, toward)))
    }

    fn scattered_radiance(
        throughput: &Rows<R, N>,
        scattering: &Mueller<N>,
        bounce: &Bounce,
        emitted: [f32; N],
        polarisation: Option<&LightPolarisation>,
        toward: Vec3,
    ) -> Components<f32, R, N> {
        Components(throughput.of_scattered_light(scattering, bounce, &emitted, arriving(polarisation, toward)))
    }

    /// All components of a channel together, so that no light is more polarised than it is bright.
    fn limited(radiance: Components<f32, R, N>, limit: f32) -> Components<f32, R, N> {
        let mut out = radiance.0;
        for k in 0..N {
            let energy = out[0][k];
            if energy > limit {
                out[0][k] = limit;
                out[1..].iter_mut().for_each(|component| component[k] *= limit / energy);
            }
        }
        Components(out)
    }

    fn from_colour(basis: &T::Basis, colour: [f32; 3]) -> Components<f32, R, N> {
        let mut components = [[0.0; N]; R];
        components[0] = T::from_colour(basis, colour);
        Components(components)
    }

    fn colour(basis: &T::Basis, radiance: Components<f32, R, N>) -> [f32; 3] {
        T::colour(basis, radiance.0[0])
    }

    fn names(basis: &T::Basis) -> Vec<String> {
        let mut names = T::names(basis);
        if R == 1 {
            return names;
        }
        if names.is_empty() {
            names = ["R", "G", "B"].map(|name| format!("S0.{name}")).into();
        }
        let one = |k: usize, name: &String| format!("S{k}{}", &name[2..]);
        let padding = N - names.len();
        let rows = (0..R).flat_map(|k| {
            let row: Vec<String> = names.iter().map(|name| one(k, name)).collect();
            row.into_iter().chain((0..padding).map(|_| String::new())).collect::<Vec<String>>()
        });
        rows.collect()
    }

    fn linear_polarisation(basis: &T::Basis, radiance: Components<f32, R, N>) -> Option<[f32; 2]> {
        let luminance = |component: [f32; N]| {
            let colour = T::colour(basis, component);
            colour.iter().zip(lobe_colour::LUMINANCE).map(|(c, weight)| c * weight).sum::<f32>()
        };
        let [s0, s1, s2, _] = radiance.0[..] else { return None };
        let [s0, s1, s2] = [s0, s1, s2].map(luminance);
        let degree = if s0 > 0.0 { libm::hypotf(s1, s2) / s0 } else { 0.0 };
        let angle = 0.5 * libm::atan2f(s2, s1);
        Some([degree, if angle < 0.0 { angle + std::f32::consts::PI } else { angle }])
    }

    fn reflectance(basis: &T::Basis, colour: [f32; 3]) -> [f32; N] {
        T::reflectance(basis, colour)
    }

    fn reflectance_of(basis: &T::Basis, spectrum: &Spectrum) -> [f32; N] {
        T::reflectance_of(basis, spectrum)
    }

    fn emission(basis: &T::Basis, colour: [f32; 3]) -> [f32; N] {
        T::emission(basis, colour)
    }

    fn sampled(basis: &T::Basis, spectrum: &Spectrum) -> [f32; N] {
        T::sampled(basis, spectrum)
    }

    fn light(basis: &T::Basis, spectrum: &Spectrum, luminance: Option<f64>) -> [f32; N] {
        T::light(basis, spectrum, luminance)
    }

    fn measured(basis: &T::Basis, channels: &lobe::Channels, values: &[f32]) -> Vec<[f32; N]> {
        T::measured(basis, channels, values)
    }

    fn wavelengths(basis: &T::Basis) -> Option<&[f64]> {
        T::wavelengths(basis)
    }

    fn lone(throughput: &Rows<R, N>, u: f32) -> (usize, f32) {
        T::lone(&throughput.elements[0][0], u)
    }

    fn bounce(throughput: &Rows<R, N>, scattering: &Mueller<N>, bounce: &Bounce) -> Rows<R, N> {
        throughput.bounced(scattering, bounce)
    }

    fn bounce_exactly(
        throughput: Rows<R, N>,
        weight: [f32; N],
        polarisation: Option<&Polarisation<[f32; N]>>,
        bounce: &Bounce,
    ) -> Rows<R, N> {
        throughput.bounced_exactly(&weight, polarisation, bounce)
    }

    fn at_camera(basis: &T::Basis, top: Vec3, direction: Vec3) -> Rows<R, N> {
        let forward = neg(direction);
        let target = unit(cross(direction, top)).unwrap_or_else(|| stokes_basis(forward));
        let open = T::at_camera(basis, top, direction);
        let mut start = Rows::IDENTITY.turned_before(doubled(forward, stokes_basis(forward), target));
        for element in start.elements.as_flattened_mut() {
            element.iter_mut().zip(&open).for_each(|(x, open)| *x *= open);
        }
        start
    }
}

/// Conversion for polarised light, by the conversion of the underlying transport.
#[derive(Clone, Debug)]
pub struct StokesConversion<C>(C);

impl<T, const R: usize, const N: usize> Conversion<Stokes<T, R, N>> for StokesConversion<T::Conversion>
where
    T: Transport<Spectrum = [f32; N], Radiance = [f32; N], Throughput = [f32; N], Scattering = [f32; N]>,
{
    fn of(channels: &lobe::Channels, basis: &T::Basis) -> Self {
        StokesConversion(T::Conversion::of(channels, basis))
    }

    fn count(&self) -> usize {
        self.0.count()
    }

    fn in_place<'a>(&self, _: &'a mut [Mueller<N>]) -> Option<&'a mut [f32]> {
        None
    }

    fn convert(&self, values: &[f32], out: &mut [Mueller<N>]) {
        let mut spectrum = [[0.0; N]];
        for (texel, out) in values.chunks_exact(self.0.count()).zip(out) {
            self.0.convert(texel, &mut spectrum);
            *out = Mueller::depolarising(spectrum[0]);
        }
    }

    fn convert_matrices(&self, matrices: &[f32], out: &mut [Mueller<N>]) {
        let count = self.0.count();
        let mut texels = vec![0.0; 16 * count];
        for (matrices, out) in matrices.chunks_exact(16 * count).zip(out) {
            for (channel, matrix) in matrices.chunks_exact(16).enumerate() {
                texels[channel..].iter_mut().step_by(count).zip(matrix).for_each(|(value, element)| *value = *element);
            }
            out.depolarises = false;
            self.0.convert(&texels, out.elements.as_flattened_mut());
        }
    }
}
