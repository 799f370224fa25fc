//! Grids in spherical coordinates, ready to be evaluated.

use lobe_backend::Backend;

use super::{Data, Table};
use crate::bsdf::Bsdf;
use crate::data::PrepareError;
use crate::{Aspect, Channels, Directions, Scatter, Side};

/// Lays the data out.
pub(super) fn prepare(data: &Data, _: &crate::data::Options) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(Box::new(Table::new(data)?))
}

impl Bsdf for Table {
    fn channels(&self) -> &Channels {
        Table::channels(self)
    }

    /// Transmission accepts light from either side.
    fn holds(&self, aspect: Aspect) -> bool {
        self.scatter() == aspect.scatter && (aspect.light == Side::Front || aspect.scatter == Scatter::Transmission)
    }

    fn is_isotropic(&self) -> bool {
        Table::is_isotropic(self)
    }

    fn bytes(&self) -> usize {
        Table::bytes(self)
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        Table::eval_batch(self, backend, wi, wo, out);
    }
}
