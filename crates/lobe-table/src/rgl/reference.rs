//! Evaluation of [`Data`] one query at a time in `f64`: the reference for the lanes.

use super::data::{Data, LEAST_AREA};
use super::images::bilinear;
use super::marginal::{Blend, Warp};
use crate::Channels;
use crate::direction::{Vector, add, dot, normalize, phi, scale, spherical, sub, theta};
use crate::grid::neighbours::Neighbours;
use std::f64::consts::{PI, TAU};

/// The order in which [`Reference::sample`] uses the two uniform numbers. The distribution is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UniformOrder {
    /// The first number chooses the row (azimuth), as in the loader of the database and in Mitsuba.
    #[default]
    Powitacq,
    /// The first number chooses the column (zenith angle), as in pbrt.
    Pbrt,
}

/// The result of [`Reference::sample`].
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// The direction.
    pub wo: [f64; 3],
    /// Its probability density over solid angle, 1/sr.
    pub pdf: f64,
    /// `f cos(theta_o) / pdf` in every channel.
    pub weight: Vec<f64>,
}

/// Evaluates [`Data`] in `f64` over its `f32` data.
#[derive(Clone, Debug)]
pub struct Reference {
    rgl: Data,
    vndf: Warp,
    luminance: Warp,
    clamp_negative: bool,
}

/// The place of a pair of directions in the tables.
struct Footprint {
    blend: Blend,
    /// Position in the spectra and the luminance.
    s: [f64; 2],
    /// The density of the visible normals.
    p_v: f64,
    /// The factor of every channel: `ndf / (4 sigma)`, or 1.
    factor: f64,
    /// The inverse of `d(u_m) / d(wo)`.
    jacobian: f64,
}

impl Reference {
    /// Prepares the cumulative distributions. They take 16 bytes per texel of `vndf` and `luminance`.
    pub fn new(rgl: &Data) -> Self {
        let parts = rgl.parts();
        let (vndf, luminance) = (Warp::new(&parts.vndf), Warp::new(&parts.luminance));
        Reference { rgl: rgl.clone(), vndf, luminance, clamp_negative: false }
    }

    /// `true` if negative values, which the measurements contain, become zero. The default is `false`.
    pub fn clamp_negative(mut self, clamp: bool) -> Self {
        self.clamp_negative = clamp;
        self
    }

    /// `f` in 1/sr, without the cosine, in every channel.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3], out: &mut [f64]) {
        self.eval_cos(wi, wo, out);
        if wo[2] > 0.0 {
            out.iter_mut().for_each(|value| *value /= wo[2]);
        }
    }

    /// `f cos(theta_o)`, as stored in the tables, in every channel; 0 if a direction is not above the surface.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    pub fn eval_cos(&self, wi: [f64; 3], wo: [f64; 3], out: &mut [f64]) {
        assert_eq!(out.len(), self.channels(), "one output per channel");
        match self.footprint(wi, wo) {
            Some(footprint) => self.channels_at(&footprint, out),
            None => out.fill(0.0),
        }
    }

    /// `f cos(theta_o)` at a wavelength in nm: linear between the stored ones, constant beyond them. `None` for RGB.
    pub fn eval_cos_at(&self, wi: [f64; 3], wo: [f64; 3], nm: f64) -> Option<f64> {
        let Channels::Spectral(wavelengths) = &self.rgl.parts().channels else { return None };
        let Some(footprint) = self.footprint(wi, wo) else { return Some(0.0) };
        // The wavelengths of a file are `f32`, so this loses nothing.
        let knots: Vec<f32> = wavelengths.iter().map(|nm| *nm as f32).collect();
        let Neighbours { nodes: [lower, upper], weights } = Neighbours::held(&knots, nm);
        let value = weights[0] * self.channel(&footprint, lower) + weights[1] * self.channel(&footprint, upper);
        Some(self.clamped(value * footprint.factor))
    }

    /// The density of [`sample`](Self::sample) over solid angle, 1/sr.
    pub fn pdf(&self, wi: [f64; 3], wo: [f64; 3]) -> f64 {
        self.footprint(wi, wo).map_or(0.0, |at| at.p_v * self.luminance.density(at.s, &at.blend) / at.jacobian)
    }

    /// Draws `wo` for a `wi` from two numbers in `[0, 1)`. `None` if the sample is below the surface.
    pub fn sample(&self, wi: [f64; 3], uniform: [f64; 2], order: UniformOrder) -> Option<Sample> {
        if wi[2] <= 0.0 {
            return None;
        }
        let signs = self.signs(wi);
        let wi = flip(wi, signs);
        let parts = self.rgl.parts();
        let blend = Blend::new(&parts.phi_i, &parts.theta_i, phi(wi), theta(wi));
        let uniform = match order {
            UniformOrder::Powitacq => [uniform[1], uniform[0]],
            UniformOrder::Pbrt => uniform,
        };
        let (s, p_l) = self.luminance.sample(uniform, &blend);
        let (u_m, p_v) = self.vndf.sample(s, &blend);
        let turn = if self.rgl.is_isotropic() { phi(wi) } else { 0.0 };
        let (theta_m, phi_m) = (u_m[0] * u_m[0] * PI / 2.0, (2.0 * u_m[1] - 1.0) * PI + turn);
        let m = spherical(theta_m, phi_m);
        let cos = dot(wi, m);
        let wo = sub(scale(m, 2.0 * cos), wi);
        if cos <= 0.0 || wo[2] <= 0.0 {
            return None;
        }
        let footprint = Footprint { blend, s, p_v, factor: self.factor(u_m, wi), jacobian: jacobian(cos, u_m[0], m) };
        let pdf = p_v * p_l / footprint.jacobian;
        if pdf <= 0.0 {
            return None;
        }
        let mut weight = vec![0.0; self.channels()];
        self.channels_at(&footprint, &mut weight);
        weight.iter_mut().for_each(|value| *value /= pdf);
        Some(Sample { wo: flip(wo, signs), pdf, weight })
    }

    /// The material that is evaluated.
    pub fn rgl(&self) -> &Data {
        &self.rgl
    }

    fn channels(&self) -> usize {
        self.rgl.parts().channels.count()
    }

    fn footprint(&self, wi: Vector, wo: Vector) -> Option<Footprint> {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return None;
        }
        let signs = self.signs(wi);
        let (wi, wo) = (flip(wi, signs), flip(wo, signs));
        let m = normalize(add(wi, wo));
        let parts = self.rgl.parts();
        let blend = Blend::new(&parts.phi_i, &parts.theta_i, phi(wi), theta(wi));
        let turn = if self.rgl.is_isotropic() { phi(wi) } else { 0.0 };
        let mut u_m = [theta_to_u(theta(m)), phi_to_u(phi(m) - turn)];
        u_m[1] -= u_m[1].floor();
        let (s, p_v) = self.vndf.invert(u_m, &blend);
        Some(Footprint { blend, s, p_v, factor: self.factor(u_m, wi), jacobian: jacobian(dot(wi, m), u_m[0], m) })
    }

    /// Which of x and y to negate, in both `wi` and `wo`, to reach the stored azimuths.
    fn signs(&self, wi: Vector) -> [f64; 2] {
        let sign = |negate| if negate { -1.0 } else { 1.0 };
        match self.rgl.reduction() {
            1 => [1.0, 1.0],
            2 => [sign(wi[1] >= 0.0); 2],
            _ => [sign(wi[0] >= 0.0), sign(wi[1] >= 0.0)],
        }
    }

    fn factor(&self, u_m: [f64; 2], wi: Vector) -> f64 {
        let parts = self.rgl.parts();
        if !parts.jacobian {
            return 1.0;
        }
        let u_i = [theta_to_u(theta(wi)), phi_to_u(phi(wi))];
        parts.ndf.bilinear(0, u_m) / (4.0 * parts.sigma.bilinear(0, u_i))
    }

    /// The stored value of one channel.
    fn channel(&self, at: &Footprint, channel: usize) -> f64 {
        let spectra = &self.rgl.parts().spectra;
        let slice = |incident: usize| spectra.slice(incident * self.channels() + channel);
        bilinear(spectra, at.s, |texel| at.blend.mix(|incident| f64::from(slice(incident)[texel])))
    }

    fn channels_at(&self, at: &Footprint, out: &mut [f64]) {
        for (channel, value) in out.iter_mut().enumerate() {
            *value = self.clamped(self.channel(at, channel) * at.factor);
        }
    }

    fn clamped(&self, value: f64) -> f64 {
        if self.clamp_negative { value.max(0.0) } else { value }
    }
}

fn flip(d: Vector, signs: [f64; 2]) -> Vector {
    [d[0] * signs[0], d[1] * signs[1], d[2]]
}

fn theta_to_u(theta: f64) -> f64 {
    (theta * (2.0 / PI)).sqrt()
}

fn phi_to_u(phi: f64) -> f64 {
    (phi + PI) / TAU
}

/// The factor from the density of the half vector on the unit square to that of `wo` over solid angle, with the lower
/// bound [`LEAST_AREA`] at the pole of the half vector.
fn jacobian(cos: f64, u_x: f64, m: Vector) -> f64 {
    let sin_theta_m = (m[0] * m[0] + m[1] * m[1]).sqrt();
    4.0 * cos * (2.0 * PI * PI * u_x * sin_theta_m).max(LEAST_AREA)
}
