//! Materials that can only be evaluated: a coarse table is measured of them, and directions are drawn by that.
//!
//! The table is only what directions are drawn by, so that what is seen is the material itself.

use std::fmt::Debug;
use std::sync::Arc;

use lobe_model::Model;
use lobe_table::coords::angles_to_directions;
use lobe_table::{Channels, Edges, Given, Sampler, SamplerError, Samples, Scatter, Table};

use super::table::{Build, Density, Draw, firsts};
use super::{Backend, Evaluated, Sampled, Scratch, Shader, albedo_of, times_cosine};

/// What has a value for a pair of directions.
pub trait Evaluate: Debug + Send + Sync {
    /// `f` in 1/sr without the cosine of many pairs, in linear sRGB.
    fn values(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [[f32; 3]]);
}

impl<M: Model + Debug + Send + Sync> Evaluate for M {
    fn values(&self, _: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [[f32; 3]]) {
        for ((wi, wo), out) in wi.iter().zip(wo).zip(out) {
            *out = self.f(wi.map(f64::from), wo.map(f64::from)).map(|x| x as f32);
        }
    }
}

/// A reflecting material and the table that directions are drawn by.
#[derive(Debug)]
pub struct Proxied<E> {
    material: E,
    sampler: Sampler,
    albedo: [f32; 3],
}

/// Knots of the table in degrees; theta is finest at the mirror direction.
const SIGMA: [f64; 10] = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 88.0];
const PSI: [f64; 8] = [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0];
const THETA: [f64; 15] = [0.0, 1.0, 2.0, 4.0, 6.0, 9.0, 13.0, 18.0, 25.0, 35.0, 50.0, 70.0, 100.0, 140.0, 180.0];
const PHI: [f64; 12] = [0.0, 30.0, 60.0, 90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 270.0, 300.0, 330.0];

impl<E: Evaluate> Proxied<E> {
    /// Measures the material.
    ///
    /// # Errors
    /// Where no sampler can be built of what it answers.
    pub fn new(material: E) -> Result<Self, SamplerError> {
        let table = Table::new(&measure(&material), &Edges::default()).expect("a small table");
        let sampler = Backend::best().strict().run(Build(Arc::new(table)))?;
        let mut shader = Proxied { material, sampler, albedo: [0.0; 3] };
        shader.albedo = albedo_of(&shader);
        Ok(shader)
    }
}

/// The mean of the channels over the grid, indexed by the viewer.
fn measure(material: &impl Evaluate) -> Samples {
    let (mut known, mut drawn) = (Vec::new(), Vec::new());
    for sigma in SIGMA {
        for psi in PSI {
            for theta in THETA {
                for phi in PHI {
                    let angles = [sigma, psi, theta, phi].map(f64::to_radians);
                    let (a, [x, y, z]) = angles_to_directions(angles, |sigma| sigma);
                    known.push(a.map(|c| c as f32));
                    // Below the horizon there is nothing to measure; the nearest above it stands for it.
                    let z = z.max(0.02);
                    let length = (x * x + y * y + z * z).sqrt();
                    drawn.push([x, y, z].map(|c| (c / length) as f32));
                }
            }
        }
    }
    let mut values = vec![[0.0; 3]; known.len()];
    material.values(Backend::best().strict(), &drawn, &known, &mut values);
    let grey = values.into_iter().map(|[r, g, b]| (r.max(0.0) + g.max(0.0) + b.max(0.0)) / 3.0);
    let grey: Vec<f32> = grey.map(|x| if x.is_finite() { x } else { 0.0 }).collect();
    let radians = |knots: &[f64]| knots.iter().map(|knot| knot.to_radians()).collect::<Vec<f64>>();
    let knots = [radians(&SIGMA), radians(&PSI), radians(&THETA), radians(&PHI)];
    Samples::new(Scatter::Reflection, knots, Channels::Mono, grey).expect("rising knots and finite values")
}

impl<E: Evaluate> Shader<3> for Proxied<E> {
    fn albedo(&self) -> [f32; 3] {
        self.albedo
    }

    fn eval(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, 3>, _: &mut Scratch) {
        self.material.values(backend, wi, wo, out.f);
        times_cosine(out.f, wi);
        // The table's "light" is the viewer.
        backend.run(Density { sampler: &self.sampler, given: Given::Light, wi: wo, wo: wi, pdf: out.pdf });
    }

    fn sample(&self, backend: Backend, wo: &[[f32; 3]], u: &[[f32; 3]], out: Sampled<'_, 3>, scratch: &mut Scratch) {
        let Scratch { values, pairs } = scratch;
        values.resize(wo.len(), 0.0);
        let sampled = lobe_table::Sampled { directions: &mut *out.wi, weights: values, pdfs: &mut *out.pdf };
        backend.run(Draw { sampler: &self.sampler, given: Given::Light, wo, u: firsts(u, pairs), sampled });
        self.material.values(backend, out.wi, wo, out.weight);
        times_cosine(out.weight, out.wi);
        for (weight, &pdf) in out.weight.iter_mut().zip(&*out.pdf) {
            *weight = if pdf > 0.0 { weight.map(|w| w / pdf) } else { [0.0; 3] };
        }
    }
}
