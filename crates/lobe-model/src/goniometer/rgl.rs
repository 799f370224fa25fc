//! Surfaces in the adaptive parameterisation of the EPFL database.
//!
//! J. Dupuy and W. Jakob, *An adaptive parameterization for efficient material acquisition and rendering* (ACM TOG
//! 37(6), 2018). The surface is treated as a collection of small mirrors whose normals are found from the
//! retroreflected light; the distribution of the normals visible from each light warps the unit square, so that equal
//! steps on it lead to viewers that receive about equal shares of the light. The images are then smooth.

use std::f64::consts::{PI, TAU};

use lobe_table::rgl::{self, Blend, Images, Parts, Warp};
use lobe_table::{Channels, Invalid};
use rayon::prelude::*;

use super::lift;
use crate::Surface;
use crate::vec3::{Vec3, add, dot, normalize, reflect, spherical};

/// The resolution of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution {
    /// Zenith angles of the light, at least 2: evenly from 0 to 89 degrees.
    pub theta_i: usize,
    /// Azimuths of the light: 1 for an isotropic surface, otherwise at least 3, evenly over a full turn with both ends.
    pub phi_i: usize,
    /// Columns of the distribution of microfacets, and rows for anisotropic surfaces, at least 2. Values follow it
    /// exactly only at its texels.
    pub ndf: usize,
    /// Rows and columns of the other images of microfacets, at least 2. They only determine where values are stored.
    pub microfacets: usize,
    /// Rows and columns of the images of values, at least 2.
    pub spectra: usize,
}

impl Resolution {
    /// Keeps most values of a smooth isotropic surface within a thousandth, in 6 megabytes.
    pub const ISOTROPIC: Resolution = Resolution { theta_i: 48, phi_i: 1, ndf: 512, microfacets: 128, spectra: 64 };
    /// A compromise between accuracy and the 18 megabytes of the file for other surfaces.
    pub const ANISOTROPIC: Resolution = Resolution { theta_i: 20, phi_i: 25, ndf: 192, microfacets: 48, spectra: 40 };

    /// The number of progress reports of [`measure`].
    pub fn steps(&self) -> usize {
        self.theta_i * self.phi_i + if self.phi_i == 1 { 1 } else { self.ndf }
    }
}

/// The last zenith angle of the light: at 90 degrees, no light falls on the surface.
const LAST_THETA: f64 = 89.0 * PI / 180.0;
/// Iterations for the distribution of normals; four leave an error below that of the images.
const ITERATIONS: usize = 8;
/// The share of microfacets that are assumed to be oriented at random, so that every direction has some: small, because
/// values are smooth only if they are divided by the microfacets that they come from.
const RANDOM: f64 = 1e-4;
/// The share of a warp that is uniform over the square of zenith and azimuth. The microfacets alone would leave a
/// single row of texels for the few directions around the normal.
const EVEN: f64 = 0.5;

/// Measures a surface into a material that reproduces it at every node: at the knots of the light and the texels of its
/// images. Values are those of [`rgl::Data`]: `f cos(theta_o)` over `ndf / (4 sigma)`.
///
/// Texels whose viewer is below the surface are 0. Directions of the light are divided among the threads of rayon;
/// `progress` is called after each of them, and for each row of the microfacets.
///
/// # Errors
/// [`Invalid`] if the channels are neither RGB nor ascending wavelengths, the resolution is too low, or a value is not
/// finite.
pub fn measure(
    surface: &dyn Surface,
    resolution: Resolution,
    progress: impl Fn() + Sync,
) -> Result<rgl::Data, Invalid> {
    let Resolution { theta_i, phi_i, ndf, microfacets, spectra } = resolution;
    if theta_i < 2 || phi_i == 0 || phi_i == 2 || ndf < 2 || microfacets < 2 || spectra < 2 {
        return Err(Invalid {
            part: "resolution",
            found: format!("{resolution:?}"),
            expected: "1 or 3 phi_i, and at least 2 of the others".into(),
        });
    }
    let zeniths: Vec<f32> = (0..theta_i).map(|t| (LAST_THETA * t as f64 / (theta_i - 1) as f64) as f32).collect();
    let azimuths: Vec<f32> = match phi_i {
        1 => vec![0.0],
        n => (0..n).map(|p| (TAU * p as f64 / (n - 1) as f64 - PI) as f32).collect(),
    };
    let facets = Microfacets::new(surface, phi_i == 1, [ndf, microfacets], &progress)?;
    let lights: Vec<Vec3> = azimuths
        .iter()
        .flat_map(|&phi| zeniths.iter().map(move |&theta| spherical(f64::from(theta), f64::from(phi))))
        .collect();
    let visible: Vec<Vec<f32>> = lights.par_iter().map(|&wi| facets.visible(wi, microfacets)).collect();
    let vndf = Images::new("vndf", [lights.len(), microfacets, microfacets], visible.concat())?;
    let warp = Warp::new(&vndf);
    let slices: Vec<(Vec<f32>, Vec<f32>)> = lights
        .par_iter()
        .enumerate()
        .map(|(slice, &wi)| {
            let images = facets.values(surface, wi, &warp, slice, spectra);
            progress();
            images
        })
        .collect();
    let (values, luminance): (Vec<_>, Vec<_>) = slices.into_iter().unzip();
    let channels = surface.channels().count();
    let name = if *surface.channels() == Channels::Rgb { "rgb" } else { "spectra" };
    rgl::Data::new(Parts {
        description: format!("Resampled by lobe {}", env!("CARGO_PKG_VERSION")),
        phi_i: azimuths,
        theta_i: zeniths,
        vndf,
        luminance: Images::new("luminance", [lights.len(), spectra, spectra], luminance.concat())?,
        spectra: Images::new(name, [lights.len() * channels, spectra, spectra], values.concat())?,
        ndf: facets.ndf,
        sigma: facets.sigma,
        channels: surface.channels().clone(),
        jacobian: true,
        valid: None,
    })
}

/// The small mirrors that represent the surface.
struct Microfacets {
    /// Their distribution over the normals, in 1/sr; the integral weighted with the cosine is 1.
    ndf: Images,
    /// Their area seen from a direction, per area of the surface.
    sigma: Images,
}

impl Microfacets {
    /// Finds the microfacets from the retroreflected light. If all of them are mirrors of equal reflectance, `f(m, m) =
    /// c ndf(m) / (4 cos(m) sigma(m))`, and sigma is the integral of ndf: so ndf is an eigenvector, which power
    /// iteration finds (Dupuy et al., *Extracting microfacet-based BRDF parameters from arbitrary materials with power
    /// iterations*, EGSR 2015).
    fn new(
        surface: &dyn Surface,
        is_isotropic: bool,
        [fine, side]: [usize; 2],
        progress: &(impl Fn() + Sync),
    ) -> Result<Self, Invalid> {
        // An isotropic surface looks the same from all azimuths, so two rows are enough for its images.
        let image = |part, side: usize, row_or_all: Vec<f64>| {
            let kept = if is_isotropic { 2 } else { side };
            Images::new(part, [1, kept, side], row_or_all.iter().cycle().take(kept * side).map(|&x| x as f32).collect())
        };
        let rows = |side: usize| if is_isotropic { 1 } else { side };
        let channels = surface.channels().count();
        let back = |u: [f64; 2]| {
            let w = spherical(theta(u[0]), phi(u[1]));
            let (at, mut f) = (lift(w), vec![0.0; channels]);
            surface.f(at, &[at], &mut f);
            (f.iter().sum::<f64>() * w[2]).max(0.0)
        };
        let squares = |side: usize| positions(side).take(rows(side) * side).collect::<Vec<_>>();

        let normals: Vec<Vec3> = positions(side).map(|u| spherical(theta(u[0]), phi(u[1]))).collect();
        // Area of the sphere that each node represents, by the trapezoidal rule.
        let step = 1.0 / (side - 1) as f64;
        let halved = |i: usize| if i == 0 || i == side - 1 { 0.5 * step } else { step };
        let areas: Vec<f64> =
            positions(side).enumerate().map(|(i, u)| stretch(u) * halved(i % side) * halved(i / side)).collect();
        let area_seen = |ndf: &[f64]| -> Vec<f64> {
            let weighted: Vec<f64> = areas.iter().zip(ndf.iter().cycle()).map(|(area, d)| area * d).collect();
            let area = |w: &Vec3| normals.iter().zip(&weighted).map(|(m, d)| d * dot(*w, *m).max(0.0)).sum();
            normals[..rows(side) * side].par_iter().map(area).collect()
        };
        let returned: Vec<f64> = squares(side).into_par_iter().map(back).collect();
        let (mut ndf, mut total) = (vec![1.0 / PI; returned.len()], 0.0);
        for _ in 0..ITERATIONS {
            let next: Vec<f64> = area_seen(&ndf).iter().zip(&returned).map(|(sigma, back)| sigma * back).collect();
            total = areas.iter().zip(&normals).zip(next.iter().cycle()).map(|((area, m), d)| area * m[2] * d).sum();
            // A surface without retroreflection says nothing about its facets.
            if total <= 0.0 {
                break;
            }
            ndf = next.iter().map(|d| (1.0 - RANDOM) * d / total + RANDOM / PI).collect();
        }
        let sigma = image("sigma", side, area_seen(&ndf))?;
        let density = |(index, u): (usize, [f64; 2])| {
            if index.is_multiple_of(fine) {
                progress();
            }
            let found = if total > 0.0 { sigma.bilinear(0, u) * back(u) / total } else { 1.0 / PI };
            (1.0 - RANDOM) * found + RANDOM / PI
        };
        let ndf = image("ndf", fine, squares(fine).into_par_iter().enumerate().map(density).collect())?;
        Ok(Microfacets { ndf, sigma })
    }

    /// The area seen from `wi`, as an evaluation finds it.
    fn area(&self, wi: Vec3) -> f64 {
        self.sigma.bilinear(0, [(wi[2].clamp(-1.0, 1.0).acos() * 2.0 / PI).sqrt(), (wi[1].atan2(wi[0]) + PI) / TAU])
    }

    /// The density of the normals visible from `wi`, on the unit square.
    fn visible(&self, wi: Vec3, side: usize) -> Vec<f32> {
        let density = |u: [f64; 2]| {
            let m = spherical(theta(u[0]), phi(u[1]));
            let seen = self.ndf.bilinear(0, u) * dot(wi, m).max(0.0) / self.area(wi);
            (1.0 - EVEN) * seen * stretch(u) + EVEN
        };
        positions(side).map(|u| density(u) as f32).collect()
    }

    /// The images of values, `[channel][row][column]`, and of luminance for light from `wi`.
    fn values(&self, surface: &dyn Surface, wi: Vec3, warp: &Warp, slice: usize, side: usize) -> (Vec<f32>, Vec<f32>) {
        let blend = Blend { terms: [(slice, 1.0), (slice, 0.0), (slice, 0.0), (slice, 0.0)] };
        let normals: Vec<[f64; 2]> = positions(side)
            .map(|s| {
                let (u, _) = warp.sample(s, &blend);
                // The sampler stays slightly away from the border, which is a node here.
                [0, 1].map(|axis| if s[axis] == 0.0 || s[axis] == 1.0 { s[axis] } else { u[axis] })
            })
            .collect();
        let viewers: Vec<Vec3> = normals.iter().map(|u| reflect(wi, spherical(theta(u[0]), phi(u[1])))).collect();
        let lit: Vec<usize> = (0..viewers.len()).filter(|&texel| viewers[texel][2] > 0.0).collect();
        let above: Vec<Vec3> = lit.iter().map(|&texel| viewers[texel]).collect();
        let channels = surface.channels().count();
        let mut f = vec![0.0; above.len() * channels];
        surface.f(wi, &above, &mut f);

        let texels = side * side;
        let (mut values, mut luminance) = (vec![0.0; texels * channels], vec![0.0; texels]);
        for ((&texel, wo), f) in lit.iter().zip(&above).zip(f.chunks_exact(channels)) {
            let (u, m) = (normals[texel], normalize(add(wi, *wo)));
            let mirrors = self.ndf.bilinear(0, u) / (4.0 * self.area(wi));
            // Samples are drawn by the warp, which is not exactly that of the visible normals, and by luminance.
            let drawn = 4.0 * dot(wi, m) * stretch(u) / warp.density(u, &blend);
            for (channel, f) in f.iter().enumerate() {
                let shed = f * wo[2];
                values[channel * texels + texel] = (shed / mirrors) as f32;
                luminance[texel] += (drawn * shed.max(0.0) / channels as f64) as f32;
            }
        }
        (values, luminance)
    }
}

/// The positions of the nodes of an image of `side` rows and columns, row by row.
fn positions(side: usize) -> impl Iterator<Item = [f64; 2]> {
    let last = (side - 1) as f64;
    (0..side * side).map(move |i| [(i % side) as f64 / last, (i / side) as f64 / last])
}

/// Area of the sphere over that of the square: d theta = pi u.x du.x and d phi = 2 pi du.y.
fn stretch(u: [f64; 2]) -> f64 {
    2.0 * PI * PI * u[0] * theta(u[0]).sin()
}

/// The zenith angle at a column position.
fn theta(u: f64) -> f64 {
    u * u * PI / 2.0
}

/// The azimuth at a row position.
fn phi(u: f64) -> f64 {
    (2.0 * u - 1.0) * PI
}

#[cfg(test)]
mod tests;
