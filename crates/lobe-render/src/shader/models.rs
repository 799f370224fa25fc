//! Analytic models in as many channels as a picture has.

use std::fmt::Debug;

use lobe::{Bsdf, Directions};
use lobe_model::{Ggx, Model, RoughMirrors, fresnel_conductor, half_angle_cosine};
use lobe_table::Channels;
use lobe_table::mueller::{Matrix, plane_normal, stokes_basis};

use super::Backend;
use super::pairs::each_pair;

/// Models of three channels each, one after another, for any number of channels.
#[derive(Debug)]
pub(crate) struct Together<M> {
    models: Vec<M>,
    channels: Channels,
}

impl<M> Together<M> {
    /// Models for these channels: `make` gets three channel numbers at a time, of which the last may be repeated.
    pub fn new(channels: Channels, make: impl Fn([usize; 3]) -> M) -> Self {
        let count = channels.count();
        let last = count - 1;
        let models = (0..count.div_ceil(3)).map(|k| make([3 * k, 3 * k + 1, 3 * k + 2].map(|k| k.min(last)))).collect();
        Together { models, channels }
    }
}

impl<M: Model + Debug + Send + Sync> Bsdf for Together<M> {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        each_pair(wi, wo, self.channels.count(), out, |wi, wo, texel| {
            for (out, model) in texel.chunks_mut(3).zip(&self.models) {
                out.iter_mut().zip(model.f(wi, wo)).for_each(|(out, value)| *out = value as f32);
            }
        });
    }
}

/// A rough metal, at each channel of a picture: what [`lobe_model::Conductor`] computes, but the facets are evaluated
/// once for all channels, and the compiler takes Fresnel's equations for several channels at a time.
#[derive(Debug)]
pub(crate) struct RoughConductor {
    pub ggx: Ggx,
    /// The real part of the refractive index.
    pub eta: Vec<f64>,
    /// Its imaginary part.
    pub k: Vec<f64>,
    pub channels: Channels,
}

impl Bsdf for RoughConductor {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        each_pair(wi, wo, self.channels.count(), out, |wi, wo, texel| {
            let mirrors = self.ggx.mirrors(wi, wo);
            if mirrors == 0.0 {
                return texel.fill(0.0);
            }
            let cos = half_angle_cosine(wi, wo);
            for ((out, eta), k) in texel.iter_mut().zip(&self.eta).zip(&self.k) {
                *out = (mirrors * fresnel_conductor(cos, *eta, *k)) as f32;
            }
        });
    }
}

/// A rough metal with its polarisation, at each channel of a picture.
#[derive(Debug)]
pub(crate) struct RoughMetal {
    pub mirrors: RoughMirrors,
    pub channels: Channels,
}

impl Bsdf for RoughMetal {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        each_pair(wi, wo, self.channels.count(), out, |wi, wo, texel| {
            for (channel, out) in texel.iter_mut().enumerate() {
                *out = self.mirrors.in_plane(wi, wo, channel)[0][0] as f32;
            }
        });
    }

    fn is_polarised(&self) -> bool {
        true
    }

    fn mueller_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        each_pair(wi, wo, 16 * self.channels.count(), out, |wi, wo, matrices| {
            let (before, after) = turns(wi, wo);
            for (channel, out) in matrices.chunks_exact_mut(16).enumerate() {
                let matrix = turned(self.mirrors.in_plane(wi, wo, channel), before, after);
                out.iter_mut().zip(matrix.as_flattened()).for_each(|(out, m)| *out = *m as f32);
            }
        });
        true
    }
}

/// Cosine and sine of twice the angle from the normal of the plane of incidence to the x axis of each direction.
pub(super) fn turns(wi: [f64; 3], wo: [f64; 3]) -> ([f64; 2], [f64; 2]) {
    let normal = plane_normal(wi, wo);
    let toward = wi.map(|x| -x);
    let doubled = |forward: [f64; 3], target: [f64; 3]| {
        let cross = [
            normal[1] * target[2] - normal[2] * target[1],
            normal[2] * target[0] - normal[0] * target[2],
            normal[0] * target[1] - normal[1] * target[0],
        ];
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (cos, sin) = (dot(normal, target), dot(forward, cross));
        let size = cos * cos + sin * sin;
        [(cos * cos - sin * sin) / size, 2.0 * cos * sin / size]
    };
    (doubled(toward, stokes_basis(toward)), doubled(wo, stokes_basis(wo)))
}

/// A matrix about the normal of the plane, in the frames of the directions.
pub(super) fn turned(plane: Matrix, [ci, si]: [f64; 2], [co, so]: [f64; 2]) -> Matrix {
    // First the columns by the transposed rotation of the incoming light, then the rows by the rotation of the outgoing
    // light.
    let mut columns = plane;
    for row in &mut columns {
        let (x, y) = (row[1], row[2]);
        (row[1], row[2]) = (ci * x + si * y, ci * y - si * x);
    }
    let mut matrix = columns;
    for k in 0..4 {
        let (x, y) = (columns[1][k], columns[2][k]);
        (matrix[1][k], matrix[2][k]) = (co * x + so * y, co * y - so * x);
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use lobe_model::Conductor;

    const UP: [f32; 3] = [0.0, 0.0, 1.0];

    #[test]
    fn a_rough_conductor_is_the_model_in_each_channel() {
        let ggx = Ggx { alpha: [0.2, 0.5] };
        let (eta, k) = (vec![0.2, 0.9, 1.5, 2.4, 1.1], vec![3.9, 2.4, 1.8, 3.3, 0.0]);
        let channels = Channels::Spectral(vec![400.0, 450.0, 500.0, 550.0, 600.0]);
        let metal = RoughConductor { ggx, eta: eta.clone(), k: k.clone(), channels };
        let [wi, wo] = [[UP, [0.6, 0.0, 0.8], [0.0, 0.6, -0.8]], [[0.0, -0.6, 0.8], [0.48, 0.36, 0.8], UP]];
        let mut found = [-1.0; 15];
        metal.eval_batch(Backend::best(), (&wi[..]).into(), (&wo[..]).into(), &mut found);
        for (pair, texel) in found.chunks_exact(5).enumerate() {
            let [wi, wo] = [wi[pair], wo[pair]].map(|w| w.map(f64::from));
            for (channel, found) in texel.iter().enumerate() {
                let model = Conductor { ggx, eta: [eta[channel]; 3], k: [k[channel]; 3] };
                assert_eq!(*found, model.f(wi, wo)[0] as f32, "pair {pair}, channel {channel}");
            }
        }
        assert!(found[..10].iter().all(|value| *value > 0.0) && found[10..] == [0.0; 5], "{found:?}");
    }
}
