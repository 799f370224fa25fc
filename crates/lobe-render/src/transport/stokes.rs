//! Polarised light: four Stokes components of each channel.
//!
//! A Stokes vector refers to an x axis across the direction in which light travels, which for directions of the world
//! and of materials is [`stokes_basis`] of that direction; at the film it is the right of the camera. S1 is light along
//! the x axis minus light across it, S2 light along the diagonal from the x to the y axis minus light across that, and
//! S3 measures circular light, with the signs of [`fresnel`](lobe_model::fresnel).

use std::fmt::Debug;
use std::marker::PhantomData;

use lobe_lane::Lanes;
use lobe_spectrum::Spectrum;

use super::{Bands, Conversion, Mueller, Rgb, Transport};
use crate::channels::Channels;
use crate::columns::{Column, ZEROS};
use crate::light::LightPolarisation;
use crate::vec3::{Vec3, add, cross, dot, neg, scale, sub, unit};

/// Polarised light over the `N` channels of another transport.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stokes<T, const N: usize>(PhantomData<T>);

/// Polarised light in linear sRGB.
pub type StokesRgb = Stokes<Rgb, 3>;
/// Polarised light of up to 16 wavelengths.
pub type Stokes16 = Stokes<Bands<16>, 16>;

/// Values of the four Stokes components, `[component][channel]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Components<V, const N: usize>(pub [[V; N]; 4]);

impl<V, const N: usize> AsRef<[V]> for Components<V, N> {
    fn as_ref(&self) -> &[V] {
        self.0.as_flattened()
    }
}

impl<V, const N: usize> AsMut<[V]> for Components<V, N> {
    fn as_mut(&mut self) -> &mut [V] {
        self.0.as_flattened_mut()
    }
}

impl<const N: usize> Channels for Components<f32, N> {
    const COUNT: usize = 4 * N;
    const ZERO: Self = Components([[0.0; N]; 4]);
    const ONE: Self = Components([[1.0; N]; 4]);
    type InLanes<L: Lanes> = Components<L::F, N>;
    type Columns = Components<Column, N>;
    type Sums = Components<i128, N>;
    const ZERO_COLUMNS: Self::Columns = Components([[ZEROS; N]; 4]);
    const ZERO_SUMS: Self::Sums = Components([[0; N]; 4]);

    #[inline(always)]
    fn map(self, mut f: impl FnMut(f32) -> f32) -> Self {
        Components(self.0.map(|row| row.map(&mut f)))
    }

    #[inline(always)]
    fn in_lanes<L: Lanes>(self, lanes: L) -> Self::InLanes<L> {
        let mut values = [[lanes.splat(0.0); N]; 4];
        let mut row = 0;
        while row < 4 {
            let mut k = 0;
            while k < N {
                values[row][k] = lanes.splat(self.0[row][k]);
                k += 1;
            }
            row += 1;
        }
        Components(values)
    }
}

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

/// The x axis of light that travels along a unit direction: the first tangent of Duff et al. 2017, as
/// [`lobe_table::mueller::stokes_basis`].
pub(crate) fn stokes_basis([x, y, z]: Vec3) -> Vec3 {
    let sign = 1.0f32.copysign(z);
    let a = -1.0 / (sign + z);
    [1.0 + sign * x * x * a, sign * x * y * a, -sign * x]
}

/// Cosine and sine of twice the angle from one x axis to another, about the direction in which light travels.
fn doubled(forward: Vec3, from: Vec3, to: Vec3) -> [f32; 2] {
    let (cos, sin) = (dot(from, to), dot(forward, cross(from, to)));
    let size = cos * cos + sin * sin;
    if size > 0.0 { [(cos * cos - sin * sin) / size, 2.0 * cos * sin / size] } else { [1.0, 0.0] }
}

fn in_world(frame: &[Vec3; 3], local: Vec3) -> Vec3 {
    add(add(scale(frame[0], local[0]), scale(frame[1], local[1])), scale(frame[2], local[2]))
}

impl<T, const N: usize> Transport for Stokes<T, N>
where
    T: Transport<Spectrum = [f32; N], Radiance = [f32; N], Throughput = [f32; N], Scattering = [f32; N]>,
{
    type Basis = T::Basis;
    type Spectrum = [f32; N];
    type Radiance = Components<f32, N>;
    type Throughput = Mueller<N>;
    type Scattering = Mueller<N>;
    type Conversion = StokesConversion<T::Conversion>;

    const POLARISED: bool = true;
    const START: Mueller<N> = Mueller::IDENTITY;
    const ABSORBED: Mueller<N> = Mueller { elements: [[[0.0; N]; 4]; 4], depolarises: true };

    fn scattering(spectrum: [f32; N]) -> Mueller<N> {
        Mueller::depolarising(spectrum)
    }

    fn scale(scattering: Mueller<N>, factor: f32) -> Mueller<N> {
        scattering.scaled(factor)
    }

    fn over(scattering: Mueller<N>, pdf: f32) -> Mueller<N> {
        scattering.scaled(1.0 / pdf)
    }

    fn apply(throughput: Mueller<N>, scattering: Mueller<N>) -> Mueller<N> {
        throughput.after(&scattering)
    }

    fn weigh(throughput: Mueller<N>, factor: f32) -> Mueller<N> {
        throughput.scaled(factor)
    }

    fn survive(throughput: Mueller<N>, chance: f32) -> Mueller<N> {
        throughput.scaled(1.0 / chance)
    }

    fn magnitude(throughput: &Mueller<N>) -> f32 {
        // The first element bounds the others.
        throughput.elements[0][0].iter().fold(0.0f32, |most, t| most.max(t.abs()))
    }

    fn radiance(throughput: Mueller<N>, emitted: [f32; N]) -> Components<f32, N> {
        let mut radiance = Components([[0.0; N]; 4]);
        for (row, out) in throughput.elements.iter().zip(&mut radiance.0) {
            for ((out, factor), emitted) in out.iter_mut().zip(&row[0]).zip(&emitted) {
                *out = factor * emitted;
            }
        }
        radiance
    }

    fn radiance_from(
        throughput: Mueller<N>,
        emitted: [f32; N],
        polarisation: Option<&LightPolarisation>,
        wi: Vec3,
    ) -> Components<f32, N> {
        let Some(polarisation) = polarisation else { return Self::radiance(throughput, emitted) };
        let direction = neg(wi);
        let [s1, s2, s3] = polarisation.along(direction, stokes_basis(direction));
        let mut radiance = Components([[0.0; N]; 4]);
        for (row, out) in throughput.elements.iter().zip(&mut radiance.0) {
            for (k, out) in out.iter_mut().enumerate() {
                *out = (row[0][k] + s1 * row[1][k] + s2 * row[2][k] + s3 * row[3][k]) * emitted[k];
            }
        }
        radiance
    }

    fn from_colour(basis: &T::Basis, colour: [f32; 3]) -> Components<f32, N> {
        let zero = [0.0; N];
        Components([T::from_colour(basis, colour), zero, zero, zero])
    }

    fn colour(basis: &T::Basis, radiance: Components<f32, N>) -> [f32; 3] {
        T::colour(basis, radiance.0[0])
    }

    fn names(basis: &T::Basis) -> Vec<String> {
        let mut names = T::names(basis);
        if names.is_empty() {
            names = ["R", "G", "B"].map(|name| format!("S0.{name}")).into();
        }
        let one = |k: usize, name: &String| format!("S{k}{}", &name[2..]);
        let padding = N - names.len();
        let rows = (0..4).flat_map(|k| {
            let row: Vec<String> = names.iter().map(|name| one(k, name)).collect();
            row.into_iter().chain((0..padding).map(|_| String::new())).collect::<Vec<String>>()
        });
        rows.collect()
    }

    fn linear_polarisation(basis: &T::Basis, radiance: Components<f32, N>) -> Option<[f32; 2]> {
        let [s0, s1, s2, _] = radiance.0.map(|component| {
            let colour = T::colour(basis, component);
            colour.iter().zip(lobe_colour::LUMINANCE).map(|(c, weight)| c * weight).sum::<f32>()
        });
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

    fn lone(throughput: &Mueller<N>, u: f32) -> (usize, f32) {
        T::lone(&throughput.elements[0][0], u)
    }

    fn delta(weights: [f32; N], polarisation: Option<&Polarisation<[f32; N]>>, wi: Vec3, wo: Vec3) -> Mueller<N> {
        let Some(polarisation) = polarisation else { return Mueller::depolarising(weights) };
        let mut elements = [[[0.0; N]; 4]; 4];
        for k in 0..N {
            let weight = weights[k];
            let (b, c, s) = (weight * polarisation.b[k], weight * polarisation.c[k], weight * polarisation.s[k]);
            (elements[0][0][k], elements[0][1][k], elements[1][0][k], elements[1][1][k]) = (weight, b, b, weight);
            (elements[2][2][k], elements[2][3][k], elements[3][2][k], elements[3][3][k]) = (c, s, -s, c);
        }
        let (axis, toward) = (polarisation.axis, neg(wi));
        Mueller { elements, depolarises: false }
            .turned_before(doubled(toward, stokes_basis(toward), axis))
            .turned_after(doubled(wo, axis, stokes_basis(wo)))
    }

    fn at_camera(basis: &T::Basis, right: Vec3, direction: Vec3) -> Mueller<N> {
        let forward = neg(direction);
        let across = sub(right, scale(forward, dot(right, forward)));
        let target = unit(across).unwrap_or_else(|| stokes_basis(forward));
        let open = T::at_camera(basis, right, direction);
        let mut start = Mueller::IDENTITY.turned_after(doubled(forward, stokes_basis(forward), target));
        for element in start.elements.as_flattened_mut() {
            element.iter_mut().zip(&open).for_each(|(x, open)| *x *= open);
        }
        start
    }

    fn in_world(scattering: Mueller<N>, frame: &[Vec3; 3], wi: Vec3, wo: Vec3) -> Mueller<N> {
        if scattering.depolarises {
            return scattering;
        }
        let is_left_handed = dot(cross(frame[0], frame[1]), frame[2]) < 0.0;
        let matrix = if is_left_handed { scattering.mirrored() } else { scattering };
        let toward = neg(wi);
        let (toward_world, wo_world) = (in_world(frame, toward), in_world(frame, wo));
        let before = doubled(toward_world, stokes_basis(toward_world), in_world(frame, stokes_basis(toward)));
        let after = doubled(wo_world, in_world(frame, stokes_basis(wo)), stokes_basis(wo_world));
        matrix.turned_before(before).turned_after(after)
    }
}

/// Conversion for polarised light, by the conversion of the underlying transport.
#[derive(Clone, Debug)]
pub struct StokesConversion<C>(C);

impl<T, const N: usize> Conversion<Stokes<T, N>> for StokesConversion<T::Conversion>
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
        let (mut texel, mut spectrum) = (vec![0.0; count], [[0.0; N]]);
        for (matrices, out) in matrices.chunks_exact(16 * count).zip(out) {
            let mut elements = [[[0.0; N]; 4]; 4];
            for (at, element) in elements.as_flattened_mut().iter_mut().enumerate() {
                texel.iter_mut().zip(matrices.chunks_exact(16)).for_each(|(value, matrix)| *value = matrix[at]);
                self.0.convert(&texel, &mut spectrum);
                *element = spectrum[0];
            }
            *out = Mueller { elements, depolarises: false };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stokes(matrix: &Mueller<1>, light: [f32; 4]) -> [f32; 4] {
        matrix.elements.map(|row| row.iter().zip(light).map(|(m, s)| m[0] * s).sum())
    }

    /// `lobe_table` is the reference for rotations of frames.
    #[test]
    fn frames_of_the_world_do_not_change_what_happens() {
        let mut elements = [[[0.0f32; 1]; 4]; 4];
        elements.as_flattened_mut().iter_mut().enumerate().for_each(|(k, x)| x[0] = ((k * 7 + 3) % 11) as f32 / 11.0);
        let matrix = Mueller { elements, depolarises: false };
        let (wi, wo) = ([0.48, 0.36, 0.8], [-0.6, 0.0, 0.8]);
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let same = <Stokes<Bands<1>, 1> as Transport>::in_world(matrix, &identity, wi, wo);
        for (a, b) in same.elements.as_flattened().iter().zip(matrix.elements.as_flattened()) {
            assert!((a[0] - b[0]).abs() < 1e-6);
        }
        // Energy, and how much light is circular, do not depend on the frame.
        let turned = [[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]];
        let other = <Stokes<Bands<1>, 1> as Transport>::in_world(matrix, &turned, wi, wo);
        for (i, j) in [(0, 0), (0, 3), (3, 0), (3, 3)] {
            assert!((other.elements[i][j][0] - matrix.elements[i][j][0]).abs() < 1e-6, "{i} {j}");
        }
        let linear = |m: &Mueller<1>| {
            let s = stokes(m, [1.0, 0.0, 0.0, 0.0]);
            s[1].hypot(s[2])
        };
        assert!((linear(&other) - linear(&matrix)).abs() < 1e-6);
    }

    #[test]
    fn opposite_rotations_cancel() {
        let (forward, from) = ([0.0, 0.6, 0.8], stokes_basis([0.0, 0.6, 0.8]));
        let to = add(scale(from, 0.8), scale(cross(forward, from), 0.6));
        let turned = Mueller::<1>::IDENTITY.turned_after(doubled(forward, from, to));
        let back = turned.turned_after(doubled(forward, to, from));
        for (a, b) in back.elements.as_flattened().iter().zip(Mueller::<1>::IDENTITY.elements.as_flattened()) {
            assert!((a[0] - b[0]).abs() < 1e-6);
        }
        let before = Mueller::<1>::IDENTITY.turned_before(doubled(forward, from, to));
        assert!(
            before
                .elements
                .as_flattened()
                .iter()
                .zip(turned.elements.as_flattened())
                .all(|(a, b)| (a[0] - b[0]).abs() < 1e-6)
        );
    }
}
