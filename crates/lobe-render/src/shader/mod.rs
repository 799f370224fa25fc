//! Materials as a renderer needs them: batches of values with densities, and batches of sampled directions.
//!
//! Directions are unit vectors in the frame of the surface, normal on +z; `wo` is known (for a path from the camera it
//! leads to the viewer), `wi` is sampled. A batch belongs to one material and is as long as possible, so that all lanes
//! are in use. Materials run on the backend that they were made with.

mod bsdf;
mod delta;
mod film;
mod lambert;
mod models;
mod open;
mod pairs;
mod plastic;

use std::fmt::Debug;

pub use bsdf::BsdfShader;
pub use delta::{Behind, Choice, Delta, DeltaSample, DeltaSamples, DeltaShader};
pub(crate) use film::RoughFilm;
pub use film::{FilmElements, FilmTable};
pub use lambert::Lambert;
pub use lobe::Backend;
pub(crate) use models::{RoughConductor, RoughMetal, Together};
pub use open::{
    MaterialError, Prepared, from_document, from_document_in, open, open_sheet, open_sheet_in,
    open_sheet_with_progress, open_with,
};
pub(crate) use plastic::{RoughPlastic, Surface};

use crate::transport::{Rgb, Transport, TransportMode};

/// Output for values, one entry per pair of directions.
#[derive(Debug)]
pub struct Evaluated<'a, T: Transport> {
    /// `f` times `|cos theta_i|` in 1/sr.
    pub f: &'a mut [T::Scattering],
    /// The density with which [`Shader::sample`] samples this `wi` for this `wo`, 1/sr.
    pub pdf: &'a mut [f32],
}

/// Output for sampled directions, one entry per `wo`.
#[derive(Debug)]
pub struct Sampled<'a, T: Transport> {
    /// The directions.
    pub wi: &'a mut [[f32; 3]],
    /// `f` times `|cos theta_i|` over the density; 0 if nothing was sampled.
    pub weight: &'a mut [T::Scattering],
    /// The densities, 1/sr; 0 if nothing was sampled, infinite for the direction of a delta lobe.
    pub pdf: &'a mut [f32],
}

/// The kinds of lobes of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lobes {
    /// It has values for pairs of directions, from [`Shader::eval`] and [`Shader::sample`].
    pub values: bool,
    /// It sends light into exact directions: [`Shader::delta`], or samples of infinite density.
    pub delta: bool,
    /// Light may pass through, so that the two sides of a surface differ. Other materials look the same from both
    /// sides.
    pub transmits: bool,
}

impl Lobes {
    /// A material that reflects, with values for all pairs of directions.
    pub const REFLECTION: Self = Lobes { values: true, delta: false, transmits: false };
}

/// Memory for the conversion of channels, kept from batch to batch.
#[derive(Debug, Default)]
pub struct Scratch {
    values: Vec<f32>,
}

impl Scratch {
    /// Room for `n` values, all 0.
    fn values(&mut self, n: usize) -> &mut [f32] {
        self.values.clear();
        self.values.resize(n, 0.0);
        &mut self.values
    }
}

/// A material for a renderer of the transport `T`.
///
/// In [`TransportMode::Importance`] the path comes from a light: the known direction `wo` leads to the light, and `wi`
/// is where it continues. Values belong to the pair that light takes, times the cosine of `wi` in either mode.
pub trait Shader<T: Transport = Rgb>: Debug + Send + Sync {
    /// The kinds of lobes of the material.
    fn lobes(&self) -> Lobes {
        Lobes::REFLECTION
    }

    /// The exact directions of mirrors and glass, which have no value for a pair of directions.
    fn delta(&self) -> Option<&Delta<T::Spectrum>> {
        None
    }

    /// The approximate share of reflected light, in linear sRGB, for the albedo image.
    fn albedo(&self) -> [f32; 3];

    /// Values and densities of pairs of directions. All slices are equally long. Not called without
    /// [values](Lobes::values).
    fn eval(&self, mode: TransportMode, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, T>, scratch: &mut Scratch);

    /// The densities alone, 1/sr. All slices are equally long. Not called without [values](Lobes::values).
    fn pdf(&self, mode: TransportMode, wi: &[[f32; 3]], wo: &[[f32; 3]], pdf: &mut [f32], scratch: &mut Scratch) {
        let mut f = vec![T::ABSORBED; pdf.len()];
        self.eval(mode, wi, wo, Evaluated { f: &mut f, pdf }, scratch);
    }

    /// Samples a `wi` for each `wo` from two numbers in `[0, 1)`. All slices are equally long. Not called without
    /// [values](Lobes::values).
    fn sample(&self, mode: TransportMode, wo: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_, T>, scratch: &mut Scratch);
}

/// The mean weight of the directions that a shader samples for a viewer 30 degrees from the normal: its albedo for this
/// viewer.
fn albedo_of<T: Transport>(shader: &impl Shader<T>, basis: &T::Basis) -> [f32; 3] {
    const SIDE: usize = 24;
    let n = SIDE * SIDE;
    let at = |i: usize| (i as f32 + 0.5) / SIDE as f32;
    let u: Vec<[f32; 2]> = (0..n).map(|i| [at(i % SIDE), at(i / SIDE)]).collect();
    let wo = vec![[0.5, 0.0, 0.75f32.sqrt()]; n];
    let (mut wi, mut weight, mut pdf) = (vec![[0.0; 3]; n], vec![T::ABSORBED; n], vec![0.0; n]);
    let out = Sampled { wi: &mut wi, weight: &mut weight, pdf: &mut pdf };
    shader.sample(TransportMode::Radiance, &wo, &u, out, &mut Scratch::default());
    let white = T::emission(basis, [1.0; 3]);
    let colours: Vec<[f32; 3]> =
        weight.into_iter().map(|weight| T::colour(basis, T::radiance(T::apply(T::START, weight), white))).collect();
    std::array::from_fn(|k| (colours.iter().map(|c| f64::from(c[k])).sum::<f64>() / n as f64).clamp(0.0, 1.0) as f32)
}

/// Values times the cosine. Negative values are kept: they come from colours that the channels cannot represent, or
/// from noise, and without them the sums of many values would be too bright.
fn times_cosine<T: Transport>(f: &mut [T::Scattering], wi: &[[f32; 3]]) {
    for (f, wi) in f.iter_mut().zip(wi) {
        *f = T::scale(*f, wi[2].abs());
    }
}
