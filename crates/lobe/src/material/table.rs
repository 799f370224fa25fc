//! Specular tables, in SIMD lanes.

use lobe_table::{Channels, Table};

use super::evaluator::Evaluator;
use crate::{Backend, Kind};

impl Evaluator for Table {
    fn kind(&self) -> Kind {
        Kind::SpecularTable
    }

    fn channels(&self) -> &Channels {
        Table::channels(self)
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }
}
