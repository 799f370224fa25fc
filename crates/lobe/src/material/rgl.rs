//! The EPFL database, in SIMD lanes.

use lobe_table::rgl;
use lobe_table::{Channels, Given, Scatter};

use super::evaluator::{Evaluator, Native};
use crate::{Backend, Kind};

/// A table, and which direction it is indexed by.
#[derive(Debug)]
pub(crate) struct Parametrised {
    pub(crate) table: rgl::Table,
    pub(crate) indexed_by: Given,
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
        Native::Rgl(self)
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        let (index, other) = if self.indexed_by == Given::Light { (wi, wo) } else { (wo, wi) };
        self.table.eval_batch(backend, index.into(), other.into(), out);
    }
}
