//! The grid of the UTIA database, by its `f64` reference.

use lobe_table::utia::{Decode, Utia};
use lobe_table::{Channels, Scatter};

use super::evaluator::{Evaluator, pair_by_pair, round};
use crate::Kind;

#[derive(Debug)]
pub(super) struct UtiaGrid {
    pub(super) data: Utia,
    pub(super) decode: Decode,
}

impl Evaluator for UtiaGrid {
    fn kind(&self) -> Kind {
        Kind::Utia
    }

    fn channels(&self) -> &Channels {
        &Channels::Rgb
    }

    fn bytes(&self) -> usize {
        size_of_val(self.data.values())
    }

    fn is_isotropic(&self) -> bool {
        false
    }

    fn holds(&self, front: bool, scatter: Scatter) -> bool {
        front && scatter == Scatter::Reflection
    }

    fn eval_batch(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: &mut [f32]) {
        pair_by_pair(wi, wo, out, |wi, wo, texel| round(texel, &self.data.eval(wi, wo, self.decode)));
    }
}
