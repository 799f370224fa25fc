//! The grid of the UTIA database, in SIMD lanes.

use lobe_table::{Channels, Scatter, utia};

use super::evaluator::Evaluator;
use crate::{Backend, Kind};

#[derive(Debug)]
pub(super) struct UtiaGrid {
    pub(super) table: utia::Table,
}

impl Evaluator for UtiaGrid {
    fn kind(&self) -> Kind {
        Kind::Utia
    }

    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn is_isotropic(&self) -> bool {
        false
    }

    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        front && scatter == Scatter::Reflection
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        self.table.eval_batch(backend, wi.into(), wo.into(), out);
    }
}
