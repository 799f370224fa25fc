//! Materials as a renderer needs them: batches of values with densities, and batches of drawn directions.
//!
//! Directions are unit vectors in the frame of the surface, normal on +z; `wo` leads to the viewer and is known, `wi` to
//! the light and is drawn. A batch is of one material and as long as can be, so that all lanes are in use. Materials run
//! on the backend that they were made with.

mod delta;
mod lambert;
mod measured;
mod model;

use std::fmt::Debug;

pub use delta::{Delta, DeltaSample, DeltaShader};
pub use lambert::Lambert;
pub use lobe::Backend;
pub use measured::{MaterialError, MeasuredShader, open, open_sheet};
pub use model::ModelShader;

/// Where values go, one entry a pair of directions.
#[derive(Debug)]
pub struct Evaluated<'a, const C: usize> {
    /// `f` times `|cos theta_i|` in 1/sr.
    pub f: &'a mut [[f32; C]],
    /// The density with which [`Shader::sample`] draws this `wi` for this `wo`, 1/sr.
    pub pdf: &'a mut [f32],
}

/// Where drawn directions go, one entry a `wo`.
#[derive(Debug)]
pub struct Sampled<'a, const C: usize> {
    /// The directions.
    pub wi: &'a mut [[f32; 3]],
    /// `f` times `|cos theta_i|` over the density; 0 where nothing was drawn.
    pub weight: &'a mut [[f32; C]],
    /// The densities, 1/sr; 0 where nothing was drawn, infinite where the direction could be no other.
    pub pdf: &'a mut [f32],
}

/// Memory for channels on their way to a picture, kept from batch to batch.
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

/// A material of `C` channels.
pub trait Shader<const C: usize>: Debug + Send + Sync {
    /// Whether light may pass through, so that the two sides of a surface differ. Other materials look the same from
    /// both sides.
    fn transmits(&self) -> bool {
        false
    }

    /// Mirrors and glass, which have no value for a pair of directions. [`eval`](Shader::eval) and
    /// [`sample`](Shader::sample) are not called for them.
    fn delta(&self) -> Option<&Delta<C>> {
        None
    }

    /// Roughly the share of light that comes back, for the albedo image.
    fn albedo(&self) -> [f32; C];

    /// Values and densities of pairs of directions. All slices are equally long.
    fn eval(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, C>, scratch: &mut Scratch);

    /// Draws a `wi` for each `wo` from two numbers in `[0, 1)`. All slices are equally long.
    fn sample(&self, wo: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_, C>, scratch: &mut Scratch);
}

/// The mean weight of directions that a shader draws for a viewer 30 degrees from the normal: its albedo there.
fn albedo_of<const C: usize>(shader: &impl Shader<C>) -> [f32; C] {
    const SIDE: usize = 24;
    let n = SIDE * SIDE;
    let place = |i: usize| (i as f32 + 0.5) / SIDE as f32;
    let u: Vec<[f32; 2]> = (0..n).map(|i| [place(i % SIDE), place(i / SIDE)]).collect();
    let wo = vec![[0.5, 0.0, 0.75f32.sqrt()]; n];
    let (mut wi, mut weight, mut pdf) = (vec![[0.0; 3]; n], vec![[0.0; C]; n], vec![0.0; n]);
    let out = Sampled { wi: &mut wi, weight: &mut weight, pdf: &mut pdf };
    shader.sample(&wo, &u, out, &mut Scratch::default());
    std::array::from_fn(|k| (weight.iter().map(|w| f64::from(w[k])).sum::<f64>() / n as f64).clamp(0.0, 1.0) as f32)
}

/// Values times the cosine. Those below 0 stay: they are of colours that the channels cannot show, or noise, and without
/// them the sums of many values would be too bright.
fn times_cosine<const C: usize>(f: &mut [[f32; C]], wi: &[[f32; 3]]) {
    for (f, wi) in f.iter_mut().zip(wi) {
        *f = f.map(|x| x * wi[2].abs());
    }
}
