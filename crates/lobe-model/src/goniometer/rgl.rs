//! Surfaces in the adaptive parameterisation of the EPFL database.
//!
//! J. Dupuy and W. Jakob, *An adaptive parameterization for efficient material acquisition and rendering*, ACM TOG 37(6),
//! 2018. The surface is taken for a crowd of small mirrors whose normals are found from the light that comes straight back
//! (section 5.1 there); the distribution of the normals that each light sees warps the unit square, so that equal steps on
//! it lead to viewers who receive about equal shares of the light. What is left in the images is smooth.

use std::f64::consts::{PI, TAU};

use lobe_table::rgl::{Blend, Images, Parts, Rgl, Warp};
use lobe_table::{Channels, Invalid};
use rayon::prelude::*;

use super::lift;
use crate::Surface;
use crate::vec3::{Vec3, dot, reflect, spherical};

/// How finely a surface is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution {
    /// Zenith angles of the light, at least 2: evenly from 0 to 89 degrees.
    pub theta_i: usize,
    /// Azimuths of the light: 1 for an isotropic surface, else at least 3, evenly over the whole turn with both its ends.
    pub phi_i: usize,
    /// Rows and columns of the images of microfacets, at least 2. Their interpolation costs no accuracy: they only say
    /// where values are kept.
    pub microfacets: usize,
    /// Rows and columns of the images of values, at least 2.
    pub spectra: usize,
}

impl Resolution {
    /// What keeps a smooth isotropic surface within a thousandth of its values.
    pub const ISOTROPIC: Resolution = Resolution { theta_i: 32, phi_i: 1, microfacets: 128, spectra: 64 };
    /// A compromise between accuracy and the size of the file for other surfaces.
    pub const ANISOTROPIC: Resolution = Resolution { theta_i: 16, phi_i: 25, microfacets: 64, spectra: 32 };

    /// How often [`measure`] reports progress.
    pub fn steps(&self) -> usize {
        self.theta_i * self.phi_i
    }
}

/// The last zenith angle of the light: at 90 degrees none falls on the surface.
const LAST_THETA: f64 = 89.0 * PI / 180.0;
/// Iterations for the distribution of normals; four leave an error below that of the images.
const ITERATIONS: usize = 8;
/// How much of the microfacets is taken for oriented at random, so that no direction is without: little, as values are
/// smooth only where they are divided by the microfacets that they come from.
const RANDOM: f64 = 1e-4;
/// How much of a warp is even over the square of zenith and azimuth. The microfacets alone would leave the directions
/// about the normal, of which there are few, to a single row of texels.
const EVEN: f64 = 0.3;

/// Measures a surface into a material that reproduces it at every node: at the knots of the light and the texels of its
/// images. Values are those of [`Rgl`]: `f cos(theta_o)` over `ndf / (4 sigma)`.
///
/// Texels whose viewer is below the surface hold the continuation of `f cos(theta_o)` through zero at the horizon, a
/// negative number, so that the interpolation above it is right. Directions of the light are shared out over the threads of
/// rayon; `progress` is called after each of them.
///
/// # Errors
/// [`Invalid`] where the channels are neither RGB nor ascending wavelengths, the resolution is below its least, or a value
/// is not finite.
pub fn measure(surface: &dyn Surface, resolution: Resolution, progress: impl Fn() + Sync) -> Result<Rgl, Invalid> {
    let Resolution { theta_i, phi_i, microfacets, spectra } = resolution;
    if theta_i < 2 || phi_i == 0 || phi_i == 2 || microfacets < 2 || spectra < 2 {
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
    let facets = Microfacets::new(surface, phi_i == 1, microfacets)?;
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
    Rgl::new(Parts {
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

/// The small mirrors that the surface is taken for.
struct Microfacets {
    /// Their distribution over the normals, in 1/sr; the integral weighted with the cosine is 1.
    ndf: Images,
    /// Their area seen from a direction, for each area of the surface.
    sigma: Images,
}

impl Microfacets {
    /// Finds the microfacets from the light that comes straight back. With all of them mirrors of equal reflectance
    /// `f(m, m) = c ndf(m) / (4 cos(m) sigma(m))`, and sigma is the integral of ndf: so ndf is an eigenvector, which power
    /// iteration finds (Dupuy et al., *Extracting microfacet-based BRDF parameters from arbitrary materials with power
    /// iterations*, EGSR 2015).
    fn new(surface: &dyn Surface, is_isotropic: bool, side: usize) -> Result<Self, Invalid> {
        let channels = surface.channels().count();
        let normals: Vec<Vec3> = positions(side).map(|u| spherical(theta(u[0]), phi(u[1]))).collect();
        // Area of the sphere that each node stands for: trapezoids, d theta = pi u du and d phi = 2 pi du.
        let step = 1.0 / (side - 1) as f64;
        let halved = |i: usize| if i == 0 || i == side - 1 { 0.5 * step } else { step };
        let areas: Vec<f64> = positions(side)
            .enumerate()
            .map(|(i, u)| theta(u[0]).sin() * PI * u[0] * halved(i % side) * TAU * halved(i / side))
            .collect();
        // An isotropic surface looks alike from all azimuths.
        let rows = if is_isotropic { 1 } else { side };
        let seen: Vec<Vec3> = normals[..rows * side].to_vec();
        let back: Vec<f64> = seen
            .par_iter()
            .map(|&w| {
                let (at, mut f) = (lift(w), vec![0.0; channels]);
                surface.f(at, &[at], &mut f);
                (f.iter().sum::<f64>() * w[2]).max(0.0)
            })
            .collect();
        let all_rows = |row: &[f64]| -> Vec<f64> { row.iter().copied().cycle().take(side * side).collect() };
        let area_seen = |ndf: &[f64]| -> Vec<f64> {
            let area = |w: &Vec3| -> f64 {
                normals.iter().zip(&areas).zip(ndf).map(|((m, area), d)| area * d * dot(*w, *m).max(0.0)).sum()
            };
            seen.par_iter().map(area).collect()
        };
        let normalised = |ndf: Vec<f64>| -> Option<Vec<f64>> {
            let total: f64 = normals.iter().zip(&areas).zip(&ndf).map(|((m, area), d)| area * d * m[2]).sum();
            (total.is_finite() && total > 0.0).then(|| ndf.iter().map(|d| d / total).collect())
        };
        let random = vec![1.0 / PI; side * side];
        let mut ndf = random.clone();
        for _ in 0..ITERATIONS {
            let next: Vec<f64> = area_seen(&ndf).iter().zip(&back).map(|(sigma, back)| sigma * back).collect();
            // A surface that sends nothing back says nothing about its facets.
            ndf = normalised(all_rows(&next)).unwrap_or_else(|| random.clone());
        }
        ndf.iter_mut().for_each(|d| *d = (1.0 - RANDOM) * *d + RANDOM / PI);
        let sigma = all_rows(&area_seen(&ndf));
        // Two rows suffice for what does not depend on the azimuth.
        let kept = if is_isotropic { 2 } else { side };
        let image = |part, texels: &[f64]| {
            Images::new(part, [1, kept, side], texels[..kept * side].iter().map(|&x| x as f32).collect())
        };
        Ok(Microfacets { ndf: image("ndf", &ndf)?, sigma: image("sigma", &sigma)? })
    }

    /// The area seen from `wi`, as an evaluation finds it.
    fn area(&self, wi: Vec3) -> f64 {
        self.sigma.bilinear(0, [(wi[2].clamp(-1.0, 1.0).acos() * 2.0 / PI).sqrt(), (wi[1].atan2(wi[0]) + PI) / TAU])
    }

    /// The density of the normals that light from `wi` meets, on the unit square.
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
                // The sampler keeps a little away from the border, which is a node here.
                [0, 1].map(|axis| if s[axis] == 0.0 || s[axis] == 1.0 { s[axis] } else { u[axis] })
            })
            .collect();
        let viewers: Vec<Vec3> = normals.iter().map(|u| reflect(wi, spherical(theta(u[0]), phi(u[1])))).collect();
        let lit: Vec<usize> = (0..viewers.len()).filter(|&texel| viewers[texel][2] > 1e-6).collect();
        let above: Vec<Vec3> = lit.iter().map(|&texel| viewers[texel]).collect();
        let channels = surface.channels().count();
        let mut f = vec![0.0; above.len() * channels];
        surface.f(wi, &above, &mut f);

        let texels = side * side;
        let mut smooth: Vec<Option<Vec<f64>>> = vec![None; texels];
        for (&texel, f) in lit.iter().zip(f.chunks_exact(channels)) {
            let factor = 4.0 * self.area(wi) / self.ndf.bilinear(0, normals[texel]);
            smooth[texel] = Some(f.iter().map(|f| f * factor).collect());
        }
        continue_outwards(&mut smooth, side);
        let (mut values, mut luminance) = (vec![0.0; texels * channels], vec![0.0; texels]);
        for (texel, (smooth, wo)) in smooth.iter().zip(&viewers).enumerate() {
            let u = normals[texel];
            let m = spherical(theta(u[0]), phi(u[1]));
            let drawn =
                dot(wi, m).max(0.0) * stretch(u) * self.ndf.bilinear(0, u) / self.area(wi) / warp.density(u, &blend);
            for (channel, smooth) in smooth.iter().flatten().enumerate() {
                let value = smooth * wo[2];
                values[channel * texels + texel] = value as f32;
                luminance[texel] += (drawn * value.max(0.0) / channels as f64) as f32;
            }
        }
        (values, luminance)
    }
}

/// Gives texels that have none the mean of their neighbours, ring by ring from those that have a value.
fn continue_outwards(texels: &mut [Option<Vec<f64>>], side: usize) {
    let neighbours = |texel: usize| {
        let (row, column) = (texel / side, texel % side);
        let rows = row.saturating_sub(1)..=(row + 1).min(side - 1);
        rows.flat_map(move |r| (column.saturating_sub(1)..=(column + 1).min(side - 1)).map(move |c| r * side + c))
    };
    loop {
        let mut ring: Vec<(usize, Vec<f64>)> = Vec::new();
        for texel in (0..texels.len()).filter(|&texel| texels[texel].is_none()) {
            let known: Vec<&Vec<f64>> = neighbours(texel).filter_map(|at| texels[at].as_ref()).collect();
            if let Some(first) = known.first() {
                let mean = |channel: usize| known.iter().map(|v| v[channel]).sum::<f64>() / known.len() as f64;
                ring.push((texel, (0..first.len()).map(mean).collect()));
            }
        }
        if ring.is_empty() {
            return;
        }
        ring.into_iter().for_each(|(texel, value)| texels[texel] = Some(value));
    }
}

/// The positions of the nodes of an image of `side` rows and columns, row by row.
fn positions(side: usize) -> impl Iterator<Item = [f64; 2]> {
    let last = (side - 1) as f64;
    (0..side * side).map(move |i| [(i % side) as f64 / last, (i / side) as f64 / last])
}

/// Area of the sphere over that of the square.
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
