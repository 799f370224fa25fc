//! Materials with two sides: what reflects and lets through, or lets through only.

use std::f32::consts::PI;

use super::{Backend, Evaluate, Evaluated, Sampled, Scratch, Shader, albedo_of, times_cosine};
use crate::vec3::cosine_hemisphere;

/// A material with two sides; directions are drawn in proportion to the cosine, on the one side or the other.
#[derive(Debug)]
pub struct Sided<E> {
    material: E,
    /// The chance of drawing a direction on the viewer's side.
    reflect: f32,
    albedo: [f32; 3],
}

impl<E: Evaluate> Sided<E> {
    /// Finds out how much goes where.
    pub fn new(material: E) -> Self {
        let mut shader = Sided { material, reflect: 0.5, albedo: [0.0; 3] };
        let [back, through] = shader.shares();
        // A side that answers nothing is not drawn; both others often enough that no weight is large.
        shader.reflect = match (back > 0.0, through > 0.0) {
            (true, false) => 1.0,
            (false, true) => 0.0,
            _ => (back / (back + through)).clamp(0.2, 0.8),
        };
        if !shader.reflect.is_finite() {
            shader.reflect = 0.5;
        }
        shader.albedo = albedo_of(&shader);
        shader
    }

    /// Shares of light that come back and go through, for a few viewers on both sides.
    fn shares(&self) -> [f32; 2] {
        const SIDE: usize = 12;
        let (mut wi, mut wo) = (Vec::new(), Vec::new());
        for i in 0..SIDE * SIDE {
            let u = [(i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5].map(|x| x / SIDE as f32);
            let [x, y, z] = cosine_hemisphere(u);
            for viewer in [[0.1, 0.2, 0.97], [0.6, -0.3, 0.74], [0.1, 0.2, -0.97], [0.6, -0.3, -0.74f32]] {
                let length = viewer.iter().map(|c| c * c).sum::<f32>().sqrt();
                wo.extend([viewer.map(|c| c / length); 2]);
                wi.extend([[x, y, z], [x, y, -z]]);
            }
        }
        let mut f = vec![[0.0; 3]; wi.len()];
        self.material.values(Backend::best().strict(), &wi, &wo, &mut f);
        let mut shares = [0.0; 2];
        for ((f, wi), wo) in f.iter().zip(&wi).zip(&wo) {
            let value = f.iter().map(|x| x.max(0.0)).sum::<f32>();
            shares[usize::from((wi[2] > 0.0) != (wo[2] > 0.0))] += if value.is_finite() { value } else { 0.0 };
        }
        shares
    }

    fn density(&self, wi: [f32; 3], wo: [f32; 3]) -> f32 {
        let chance = if (wi[2] > 0.0) == (wo[2] > 0.0) { self.reflect } else { 1.0 - self.reflect };
        chance * wi[2].abs() / PI
    }
}

impl<E: Evaluate> Shader<3> for Sided<E> {
    fn transmits(&self) -> bool {
        true
    }

    fn albedo(&self) -> [f32; 3] {
        self.albedo
    }

    fn eval(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, 3>, _: &mut Scratch) {
        self.material.values(backend, wi, wo, out.f);
        times_cosine(out.f, wi);
        for ((pdf, &wi), &wo) in out.pdf.iter_mut().zip(wi).zip(wo) {
            *pdf = self.density(wi, wo);
        }
    }

    fn sample(&self, backend: Backend, wo: &[[f32; 3]], u: &[[f32; 3]], out: Sampled<'_, 3>, _: &mut Scratch) {
        for (i, (&wo, &[u, v, w])) in wo.iter().zip(u).enumerate() {
            let [x, y, z] = cosine_hemisphere([u, v]);
            let up = (wo[2] > 0.0) == (w < self.reflect);
            out.wi[i] = [x, y, if up { z } else { -z }];
            out.pdf[i] = self.density(out.wi[i], wo);
        }
        self.material.values(backend, out.wi, wo, out.weight);
        times_cosine(out.weight, out.wi);
        for (weight, &pdf) in out.weight.iter_mut().zip(&*out.pdf) {
            *weight = if pdf > 0.0 { weight.map(|w| w / pdf) } else { [0.0; 3] };
        }
    }
}
