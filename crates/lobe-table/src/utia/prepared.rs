//! The grid of the UTIA database, ready to be evaluated.

use lobe_backend::Backend;

use super::{Data, Table};
use crate::bsdf::Bsdf;
use crate::data::PrepareError;
use crate::{Channels, Directions};

/// Lays the data out.
pub(super) fn prepare(data: &Data, options: &crate::data::Options) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(Box::new(Table::new(data, options.decode)?))
}

impl Bsdf for Table {
    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn bytes(&self) -> usize {
        Table::bytes(self)
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        Table::eval_batch(self, backend, wi, wo, out);
    }
}
