//! What every representation can do.

use std::fmt::Debug;

use lobe_table::mueller::Matrix;
use lobe_table::{Channels, Scatter};

use super::rgl::Parametrised;
use super::window::Patches;
use crate::{Backend, Brdf, Kind};

/// Representations that have a sampler of their own.
pub(crate) enum Native<'a> {
    Table(&'a Brdf),
    Rgl(&'a Parametrised),
    Klems(Patches<'a>),
    None,
}

/// Finds the values of pairs of directions in one representation: what [`Material`](crate::Material) is made of.
///
/// All directions are unit vectors that point away from the surface, normal on +z; `wi` to the light, `wo` to the viewer.
pub(super) trait Evaluator: Debug + Send + Sync {
    /// Which representation this is.
    fn kind(&self) -> Kind;

    /// What the channels of a value stand for.
    fn channels(&self) -> &Channels;

    /// Bytes of memory that the data take.
    fn bytes(&self) -> usize;

    /// `true` where values do not depend on the rotation of the sample.
    fn is_isotropic(&self) -> bool;

    /// Whether there are values for light from the side of z > 0 (`front`) or from the other that is scattered so.
    fn holds(&self, front: bool, scatter: Scatter) -> bool;

    /// What makes a sampler better than the values alone do.
    fn native(&self) -> Native<'_> {
        Native::None
    }

    /// `f` in 1/sr of every pair: `out[query * channels + channel]`. The slices fit together.
    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]);

    /// The Mueller matrix at a wavelength in nm, where the representation has polarisation.
    fn mueller(&self, _wi: [f32; 3], _wo: [f32; 3], _nm: f64) -> Option<Matrix> {
        None
    }
}

/// Evaluates pair by pair with an evaluator in `f64`, which finds unit vectors there to the last digit. Directions
/// that have no length or are not finite give 0.
pub(super) fn pair_by_pair(
    wi: &[[f32; 3]],
    wo: &[[f32; 3]],
    out: &mut [f32],
    mut eval: impl FnMut([f64; 3], [f64; 3], &mut [f32]),
) {
    let channels = out.len().checked_div(wi.len()).unwrap_or(1);
    for ((wi, wo), texel) in wi.iter().zip(wo).zip(out.chunks_exact_mut(channels)) {
        match unit(*wi).zip(unit(*wo)) {
            Some((wi, wo)) => eval(wi, wo, texel),
            None => texel.fill(0.0),
        }
    }
}

/// A direction in `f64`; `None` where it points nowhere.
pub(super) fn unit(direction: [f32; 3]) -> Option<[f64; 3]> {
    let v = direction.map(f64::from);
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    (length.is_finite() && length > 0.0).then(|| v.map(|c| c / length))
}
