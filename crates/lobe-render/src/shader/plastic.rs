//! Plastic: a rough coat on a base, with its polarisation, and with a thin film if there is one.

use std::f64::consts::PI;
use std::sync::Arc;

use lobe::{Bsdf, Directions};
use lobe_model::{Elements, Ggx, base_under, fresnel};
use lobe_table::Channels as Named;

use super::Backend;
use super::film::{FilmElements, FilmTable};
use super::models::{turned, turns};
use super::pairs::each_pair;
use crate::channels::Channels;

/// Rough facets on a base that scatters evenly and depolarises: [`lobe_model::RoughCoat`] in the channels of a picture.
#[derive(Debug)]
pub(crate) struct RoughPlastic<S> {
    pub ggx: Ggx,
    pub surface: Surface<S>,
    pub albedo: S,
    pub channels: Named,
}

/// The surface of the coat.
#[derive(Debug)]
pub(crate) enum Surface<S> {
    /// A dielectric of this refractive index.
    Bare(f64),
    /// A film on such a dielectric.
    Film(Arc<FilmTable<S>>),
}

impl<S: Channels> Surface<S> {
    /// The elements of mirrored and of passed light at this cosine to the normal.
    fn at(&self, cos: f64) -> [FilmElements<S>; 2] {
        match self {
            Surface::Film(table) => table.at(true, cos as f32),
            Surface::Bare(eta) => {
                let (mirrored, passed) = fresnel(cos, *eta, 0.0);
                [mirrored, passed].map(|Elements { a, b, c, s }| FilmElements {
                    of: [a, b, c, s].map(|element| S::ONE.map(|_| element as f32)),
                })
            }
        }
    }
}

/// The parts of the light between two directions.
struct Parts<S> {
    /// What perfect mirrors would reflect, in 1/sr.
    mirrors: f64,
    mirrored: FilmElements<S>,
    entering: FilmElements<S>,
    leaving: FilmElements<S>,
}

impl<S: Channels> FilmElements<S> {
    fn channel(&self, k: usize) -> Elements {
        let [a, b, c, s] = self.of.map(|element| f64::from(element.as_ref()[k]));
        Elements { a, b, c, s }
    }
}

impl<S: Channels> RoughPlastic<S> {
    /// `None` below the surface.
    fn parts(&self, wi: [f64; 3], wo: [f64; 3]) -> Option<Parts<S>> {
        if wi[2] <= 0.0 || wo[2] <= 0.0 {
            return None;
        }
        let cos = 0.5 * (1.0 + wi.iter().zip(wo).map(|(a, b)| a * b).sum::<f64>());
        let [mirrored, _] = self.surface.at(cos.clamp(0.0, 1.0).sqrt());
        let [[_, entering], [_, leaving]] = [self.surface.at(wi[2]), self.surface.at(wo[2])];
        Some(Parts { mirrors: self.ggx.mirrors(wi, wo), mirrored, entering, leaving })
    }
}

impl<S: Channels> Bsdf for RoughPlastic<S> {
    fn channels(&self) -> &Named {
        &self.channels
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        each_pair(wi, wo, self.channels.count(), out, |wi, wo, texel| {
            let Some(Parts { mirrors, mirrored, entering, leaving }) = self.parts(wi, wo) else {
                texel.fill(0.0);
                return;
            };
            for (k, out) in texel.iter_mut().enumerate() {
                let base = entering.channel(k).a * leaving.channel(k).a * f64::from(self.albedo.as_ref()[k]) / PI;
                *out = (mirrors * mirrored.channel(k).a + base) as f32;
            }
        });
    }

    fn is_polarised(&self) -> bool {
        true
    }

    fn mueller_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        each_pair(wi, wo, 16 * self.channels.count(), out, |wi, wo, matrices| {
            let Some(Parts { mirrors, mirrored, entering, leaving }) = self.parts(wi, wo) else {
                matrices.fill(0.0);
                return;
            };
            let (before, after) = turns(wi, wo);
            for (k, out) in matrices.chunks_exact_mut(16).enumerate() {
                let mut matrix = mirrored.channel(k).matrix().map(|row| row.map(|element| mirrors * element));
                let base = base_under(wi, wo, entering.channel(k), leaving.channel(k));
                let albedo = f64::from(self.albedo.as_ref()[k]);
                for (element, base) in matrix.as_flattened_mut().iter_mut().zip(base.as_flattened()) {
                    *element += albedo * base;
                }
                let matrix = turned(matrix, before, after);
                out.iter_mut().zip(matrix.as_flattened()).for_each(|(out, m)| *out = *m as f32);
            }
        });
        true
    }
}

#[cfg(test)]
mod tests {
    use lobe_model::{Coated, Film, Lambert, Model, RoughCoat, RoughMirrors};
    use lobe_table::mueller::plane_normal;

    use super::*;
    use crate::transport::Rgb;

    const PAIRS: [([f32; 3], [f32; 3]); 3] = [
        ([0.48, 0.36, 0.8], [-0.6, 0.0, 0.8]),
        ([0.0, 0.0, 1.0], [0.6, 0.0, 0.8]),
        ([0.8, 0.0, 0.6], [0.0, 0.96, 0.28]),
    ];

    fn plastic(surface: Surface<[f32; 3]>) -> RoughPlastic<[f32; 3]> {
        RoughPlastic { ggx: Ggx { alpha: [0.3, 0.3] }, surface, albedo: [0.5, 0.2, 0.1], channels: Named::Rgb }
    }

    #[test]
    fn bare_coats_are_those_of_the_models() {
        let ggx = Ggx { alpha: [0.3, 0.3] };
        let model = Coated { base: Lambert { albedo: [0.5, 0.2, 0.1] }, ggx, eta: 1.5 };
        let coat = RoughCoat { mirrors: RoughMirrors { ggx, index: vec![[1.5, 0.0]; 3] }, albedo: vec![0.5, 0.2, 0.1] };
        let (wi, wo): (Vec<[f32; 3]>, Vec<[f32; 3]>) = PAIRS.into_iter().unzip();
        let (mut values, mut matrices) = (vec![0.0; 9], vec![0.0; 144]);
        let plastic = plastic(Surface::Bare(1.5));
        plastic.eval_batch(Backend::best(), (&wi).into(), (&wo).into(), &mut values);
        assert!(plastic.mueller_batch(Backend::best(), (&wi).into(), (&wo).into(), &mut matrices));
        for (query, (wi, wo)) in PAIRS.into_iter().enumerate() {
            let (wi, wo) = (wi.map(f64::from), wo.map(f64::from));
            for (k, expected) in model.f(wi, wo).into_iter().enumerate() {
                let found = values[3 * query + k];
                assert!((f64::from(found) - expected).abs() < 1e-6, "{found}, not {expected}");
                let matrix = &matrices[16 * (3 * query + k)..][..16];
                assert!((matrix[0] - found).abs() < 1e-6);
                // Rotations of the frames change neither energy nor how much of it is polarised.
                let in_plane = coat.in_plane(wi, wo, k);
                let [found, expected] = [matrix[4].hypot(matrix[8]), in_plane[1][0].hypot(in_plane[2][0]) as f32];
                assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
            }
        }
        assert!(plane_normal([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]).iter().all(|x| x.is_finite()));
    }

    #[test]
    fn films_that_are_not_there_change_nothing() {
        let film = |_| [Film { front: 1.0, film: 1.5, behind: [1.5, 0.0], thickness: 0.0 }; 2];
        let film = plastic(Surface::Film(Arc::new(FilmTable::new::<Rgb>(&(), film))));
        let bare = plastic(Surface::Bare(1.5));
        let (wi, wo): (Vec<[f32; 3]>, Vec<[f32; 3]>) = PAIRS.into_iter().unzip();
        let values = |plastic: &RoughPlastic<[f32; 3]>| {
            let mut values = vec![0.0; 144];
            assert!(plastic.mueller_batch(Backend::best(), (&wi).into(), (&wo).into(), &mut values));
            values
        };
        for (found, expected) in values(&film).into_iter().zip(values(&bare)) {
            assert!((found - expected).abs() < 1e-3, "{found}, not {expected}");
        }
    }
}
