//! Scattered samples, ready to be evaluated: in lanes, or in `f64` without them.

use lobe_backend::Backend;

use super::Data;
#[cfg(feature = "scattered")]
use super::Table;
use crate::bsdf::{Bsdf, pair_by_pair};
use crate::data::PrepareError;
use crate::{Aspect, Channels, Directions, Scatter, Side};

/// Lays the samples out, unless lanes cannot look them up; then they are evaluated in `f64`.
#[cfg(feature = "scattered")]
pub(super) fn prepare(data: &Data) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(match Table::new(data) {
        Ok(table) => Box::new(Prepared { table }),
        Err(_) => Box::new(data.clone()),
    })
}

#[cfg(not(feature = "scattered"))]
pub(super) fn prepare(data: &Data) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(Box::new(data.clone()))
}

/// Evaluated pair by pair.
impl Bsdf for Data {
    fn channels(&self) -> &Channels {
        Data::channels(self)
    }

    /// Transmission accepts light from either side.
    fn holds(&self, aspect: Aspect) -> bool {
        self.scatter == aspect.scatter && (aspect.light == Side::Front || aspect.scatter == Scatter::Transmission)
    }

    fn is_isotropic(&self) -> bool {
        Data::is_isotropic(self)
    }

    fn bytes(&self) -> usize {
        Data::samples(self).map(|(angles, values)| size_of_val(&angles) + size_of_val(values)).sum()
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        let channels = Data::channels(self);
        let mut sum = vec![0.0; channels.count()];
        pair_by_pair(channels, wi, wo, out, |wi, wo, texel| self.eval_into(wi, wo, &mut sum, texel));
    }
}

#[cfg(feature = "scattered")]
#[derive(Debug)]
struct Prepared {
    table: Table,
}

#[cfg(feature = "scattered")]
impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        self.table.data().channels()
    }

    fn holds(&self, aspect: Aspect) -> bool {
        Bsdf::holds(self.table.data(), aspect)
    }

    fn is_isotropic(&self) -> bool {
        self.table.data().is_isotropic()
    }

    fn bytes(&self) -> usize {
        Bsdf::bytes(self.table.data()) + self.table.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.table.eval_batch(backend, wi, wo, out);
    }
}
