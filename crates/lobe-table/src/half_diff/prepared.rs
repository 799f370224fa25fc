//! Grids of half and difference angles, ready to be evaluated.

use lobe_backend::Backend;

use super::{Data, Lookup, Table};
use crate::bsdf::Bsdf;
use crate::data::PrepareError;
use crate::{Channels, Directions};

/// Lays the data out.
pub(super) fn prepare(data: &Data, options: &crate::data::Options) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(Box::new(Prepared { table: Table::new(data)?, lookup: options.lookup }))
}

/// A table, and its lookup.
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
