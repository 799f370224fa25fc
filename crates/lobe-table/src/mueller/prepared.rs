//! Mueller matrices, ready to be evaluated: the value of a pair of directions is that of unpolarised light, in SIMD lanes;
//! whole matrices are computed one at a time in `f64`.

use lobe_backend::Backend;

use super::{Data, Matrix, Table};
use crate::bsdf::{Bsdf, unit};
use crate::data::PrepareError;
use crate::{Channels, Directions, Representation};

/// Lays the data out.
pub(super) fn prepare(data: &Data, _: &crate::data::Options) -> Result<Box<dyn Bsdf>, PrepareError> {
    Ok(Box::new(Prepared { data: data.clone(), table: Table::new(data)?, channels: data.channels() }))
}

/// The matrices, and what unpolarised light sees of them.
#[derive(Debug)]
pub(crate) struct Prepared {
    pub(crate) data: Data,
    pub(crate) table: Table,
    pub(crate) channels: Channels,
}

impl Bsdf for Prepared {
    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn bytes(&self) -> usize {
        size_of_val(self.data.values()) + self.table.bytes()
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        self.table.eval_batch(backend, wi, wo, out);
    }

    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        Some(unit(wi).zip(unit(wo)).map_or([[0.0; 4]; 4], |(wi, wo)| self.data.eval(wi, wo, nm)))
    }
}
