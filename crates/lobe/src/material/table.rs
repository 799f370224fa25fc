//! Specular tables, in SIMD lanes.

use lobe_table::Channels;

use super::evaluator::Evaluator;
use crate::{Backend, Brdf, Kind};

impl Evaluator for Brdf {
    fn kind(&self) -> Kind {
        Kind::SpecularTable
    }

    fn channels(&self) -> &Channels {
        self.table().channels()
    }

    fn set_backend(&mut self, backend: Backend) {
        self.backend = backend;
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        Brdf::eval_batch(self, wi, wo, out);
    }
}
