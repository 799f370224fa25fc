//! Cosine series, ready to be evaluated.

use lobe_backend::Backend;

use super::{Data, Table};
use crate::bsdf::Bsdf;
use crate::data::PrepareError;
use crate::{Aspect, Channels, Directions};

/// Stores the data, and their aspects.
pub(super) fn prepare(data: &Data) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(Box::new(Prepared { table: Table::new(data), aspects: data.measured() }))
}

#[derive(Debug)]
struct Prepared {
    table: Table,
    aspects: Vec<Aspect>,
}

impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        &self.table.data().parts().channels
    }

    fn holds(&self, aspect: Aspect) -> bool {
        self.aspects.contains(&aspect)
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn bytes(&self) -> usize {
        self.table.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.table.eval_batch(backend, wi, wo, out);
    }
}
