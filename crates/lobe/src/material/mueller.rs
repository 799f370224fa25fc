//! Mueller matrices. The value of a pair of directions is that of unpolarised light, in SIMD lanes; whole matrices are
//! computed one at a time in `f64`.

use lobe_table::mueller::{self, Matrix};
use lobe_table::{Channels, Invalid, Scatter};

use super::evaluator::{Evaluator, unit};
use crate::{Backend, Kind};

#[derive(Debug)]
pub(super) struct Polarised {
    data: mueller::Data,
    table: mueller::Table,
    channels: Channels,
}

impl Polarised {
    pub(super) fn new(data: mueller::Data) -> Result<Self, Invalid> {
        let channels = Channels::Spectral(data.knots()[3].iter().map(|nm| f64::from(*nm)).collect());
        Ok(Polarised { table: mueller::Table::new(&data)?, data, channels })
    }
}

impl Evaluator for Polarised {
    fn kind(&self) -> Kind {
        Kind::Mueller
    }

    fn channels(&self) -> &Channels {
        &self.channels
    }

    fn bytes(&self) -> usize {
        size_of_val(self.data.values()) + self.table.bytes()
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        front && scatter == Scatter::Reflection
    }

    fn eval_batch(&self, backend: Backend, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        self.table.eval_batch(backend, wi.into(), wo.into(), out);
    }

    fn mueller(&self, wi: [f32; 3], wo: [f32; 3], nm: f64) -> Option<Matrix> {
        Some(unit(wi).zip(unit(wo)).map_or([[0.0; 4]; 4], |(wi, wo)| self.data.eval(wi, wo, nm)))
    }
}
