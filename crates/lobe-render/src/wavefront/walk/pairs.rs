//! Pairs of directions at surfaces, evaluated material by material.

use crate::shader::{Evaluated, Scratch, Shader};
use crate::stats::Shading;
use crate::transport::{Transport, TransportMode};
use crate::vec3::Vec3;
use std::ops::Range;
use std::sync::Arc;

/// Columns of pairs of directions, both in the frame of the material: `wo` is the direction from which a path has come,
/// `wi` the one in which it may continue.
#[derive(Debug)]
pub(super) struct Pairs<T: Transport> {
    pub wi: Vec<Vec3>,
    pub wo: Vec<Vec3>,
    /// `f` times the cosine of `wi`.
    pub f: Vec<T::Scattering>,
    /// The density of `wi`, 1/sr.
    pub forward: Vec<f32>,
    /// The density of `wo` for the reverse path, 1/sr.
    pub reverse: Vec<f32>,
    /// The pairs of each material.
    pub groups: Vec<(usize, Range<usize>)>,
}

impl<T: Transport> Default for Pairs<T> {
    fn default() -> Self {
        Pairs {
            wi: Vec::new(),
            wo: Vec::new(),
            f: Vec::new(),
            forward: Vec::new(),
            reverse: Vec::new(),
            groups: Vec::new(),
        }
    }
}

impl<T: Transport> Pairs<T> {
    pub fn clear(&mut self) {
        self.wi.clear();
        self.wo.clear();
        self.groups.clear();
    }

    pub fn len(&self) -> usize {
        self.wi.len()
    }

    pub fn push(&mut self, wi: Vec3, wo: Vec3) {
        self.wi.push(wi);
        self.wo.push(wo);
    }

    /// Assigns all pairs since the last call to a material.
    pub fn end_group(&mut self, material: usize) {
        let begin = self.groups.last().map_or(0, |(_, pairs)| pairs.end);
        if begin < self.len() {
            self.groups.push((material, begin..self.len()));
        }
    }

    /// Evaluates all pairs, and if requested the densities both ways.
    pub fn evaluate(
        &mut self,
        materials: &[Arc<dyn Shader<T>>],
        mode: TransportMode,
        densities: bool,
        lanes: usize,
        scratch: &mut Scratch,
        shading: &mut Shading,
    ) {
        let begun = crate::clock::Instant::now();
        let n = self.len();
        let Pairs { wi, wo, f, forward, reverse, groups } = self;
        f.resize(n, T::ABSORBED);
        forward.resize(n, 0.0);
        reverse.resize(n, 0.0);
        for (material, pairs) in &*groups {
            let shader = &materials[*material];
            let (wi, wo) = (&wi[pairs.clone()], &wo[pairs.clone()]);
            let out = Evaluated { f: &mut f[pairs.clone()], pdf: &mut forward[pairs.clone()] };
            shader.eval(mode, wi, wo, out, scratch);
            if densities {
                shader.pdf(super::reversed(mode), wo, wi, &mut reverse[pairs.clone()], scratch);
            }
            shading.count(pairs.len(), lanes);
        }
        shading.time += begun.elapsed();
    }
}
