//! The trait for anything that a goniometer can measure.

use std::f64::consts::TAU;
use std::fmt::Debug;

use lobe_backend::Backend;
use lobe_table::bsdf::OnBackend;
use lobe_table::{Bsdf, Channels, Directions};

use crate::Model;
use crate::vec3::spherical;

/// Anything that has values for pairs of directions: a model, a material from a file.
///
/// Directions are unit vectors that point away from the surface, normal on +z; `wi` toward the light. Values are `f` in
/// 1/sr, without the cosine.
pub trait Surface: Sync {
    /// The meaning of the channels.
    fn channels(&self) -> &Channels;

    /// The values for light from `wi` to each of the viewers: `out[viewer * channels + channel]`, with exactly this
    /// length.
    fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]);
}

/// A [`Model`] as a [`Surface`] and as a [`Bsdf`] with three channels, red, green and blue.
#[derive(Clone, Copy, Debug)]
pub struct Rgb<M>(pub M);

impl<M: Model + Sync> Surface for Rgb<M> {
    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn f(&self, wi: [f64; 3], viewers: &[[f64; 3]], out: &mut [f64]) {
        out.copy_from_slice(self.0.f_many(wi, viewers).as_flattened());
    }
}

/// A model is evaluated in `f64`, pair by pair, on every backend.
impl<M: Model + Debug + Send + Sync> Bsdf for Rgb<M> {
    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        assert_eq!(wi.count(), wo.count(), "as many wi as wo");
        assert_eq!(out.len(), 3 * wi.count(), "three values per query");
        let (texels, _) = out.as_chunks_mut();
        let value = |wi: [f32; 3], wo: [f32; 3]| self.0.f(wi.map(f64::from), wo.map(f64::from)).map(|x| x as f32);
        if let (Directions::Vectors(wi), Directions::Vectors(wo)) = (wi, wo) {
            texels.iter_mut().zip(wi).zip(wo).for_each(|((out, &wi), &wo)| *out = value(wi, wo));
        } else {
            texels.iter_mut().enumerate().for_each(|(query, out)| *out = value(wi.get(query), wo.get(query)));
        }
    }
}

impl<'a, M: Model + Debug + Send + Sync> From<&'a Rgb<M>> for OnBackend<'a> {
    fn from(model: &'a Rgb<M>) -> Self {
        OnBackend::new(model, Backend::best())
    }
}

impl<M: Model + ?Sized> Model for &M {
    fn f(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        (**self).f(wi, wo)
    }

    fn f_many(&self, wi: [f64; 3], viewers: &[[f64; 3]]) -> Vec<[f64; 3]> {
        (**self).f_many(wi, viewers)
    }
}

/// `true` if the values do not depend on the rotation of the surface about its normal.
///
/// 400 pairs of directions are compared before and after a rotation; 1 % of them may differ by more than a thousandth
/// of the value, because in a table that is constant on bins, rounding may select the next bin.
pub fn is_isotropic(surface: &dyn Surface) -> bool {
    let channels = surface.channels().count();
    let (mut before, mut after) = (vec![0.0; channels], vec![0.0; channels]);
    let (mut differ, mut lit) = (0, 0);
    for query in 0..400 {
        let [a, b, c, turn] = crate::halton(query + 1);
        // Polar angles up to 80 degrees, also on the lower half of the sphere, for transmission.
        let (theta_i, theta_o) = (1.4 * a, 1.4 * b);
        let pair = |turn: f64| {
            let [x, y, z] = spherical(theta_o, TAU * c + turn);
            (spherical(theta_i, turn), [x, y, if query.is_multiple_of(2) { z } else { -z }])
        };
        let ((wi, wo), (wi2, wo2)) = (pair(0.3), pair(0.3 + TAU * turn));
        surface.f(wi, &[wo], &mut before);
        surface.f(wi2, &[wo2], &mut after);
        let apart = before.iter().zip(&after).any(|(x, y)| (x - y).abs() > 1e-3 * x.abs().max(y.abs()));
        differ += usize::from(apart);
        lit += usize::from(before.iter().chain(&after).any(|x| *x != 0.0));
    }
    differ * 100 <= lit
}
