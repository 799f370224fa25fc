//! Grids of half and difference angles, ready to be evaluated.

use lobe_backend::Backend;

use super::{Lookup, Table};
use crate::bsdf::Bsdf;
use crate::{Channels, Directions};

/// A table, and how it is looked up.
#[derive(Debug)]
pub(crate) struct Prepared {
    pub(crate) table: Table,
    pub(crate) lookup: Lookup,
}

impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.table.eval_batch(backend, self.lookup, wi, wo, out);
    }
}
