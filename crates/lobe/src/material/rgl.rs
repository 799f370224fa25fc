//! The EPFL database, in SIMD lanes.

use lobe_table::rgl::{RglTable, Wanted};
use lobe_table::{Channels, Scatter};

use super::evaluator::{Evaluator, Native};
use crate::{Backend, Kind};

/// Values are indexed by the light, as they were measured.
#[derive(Debug)]
pub(super) struct Parametrised {
    pub(super) table: RglTable,
}

impl Evaluator for Parametrised {
    fn kind(&self) -> Kind {
        Kind::Rgl
    }

    fn channels(&self) -> &Channels {
        self.table.channels()
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn is_isotropic(&self) -> bool {
        self.table.is_isotropic()
    }

    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        front && scatter == Scatter::Reflection
    }

    fn native(&self) -> Native<'_> {
        Native::Rgl(&self.table)
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        backend.run(self.table.batch(wi, wo, Wanted::Values(out)));
    }
}
