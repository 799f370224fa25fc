//! An expansion, ready to be evaluated.

use lobe_backend::Backend;

use super::{Data, Table};
use crate::bsdf::Bsdf;
use crate::data::PrepareError;
use crate::{Aspect, Channels, Directions};

pub(super) fn prepare(data: &Data) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(Box::new(Table::new(data)))
}

impl Bsdf for Table {
    fn channels(&self) -> &Channels {
        Table::channels(self)
    }

    fn holds(&self, aspect: Aspect) -> bool {
        aspect == Aspect::REFLECTION
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn bytes(&self) -> usize {
        Table::bytes(self)
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        Table::eval_batch(self, backend, wi, wo, out);
    }
}
