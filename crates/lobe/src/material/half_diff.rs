//! Grids of half and difference angles, in SIMD lanes.

use lobe_table::half_diff::{self, Lookup};
use lobe_table::{Channels, Scatter};

use super::evaluator::Evaluator;
use crate::{Backend, Kind};

#[derive(Debug)]
pub(super) struct HalfDifference {
    pub(super) table: half_diff::Table,
    pub(super) lookup: Lookup,
}

impl Evaluator for HalfDifference {
    fn kind(&self) -> Kind {
        Kind::HalfDiff
    }

    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        front && scatter == Scatter::Reflection
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        self.table.eval_batch(backend, self.lookup, wi.into(), wo.into(), out);
    }
}
